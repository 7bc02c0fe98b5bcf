// Which part of a record counts: its start and its end, each a slider and a number.
import { h, uniqueId } from "../../dom.ts";
import type { FormErrors } from "../../form/errors.ts";
import { slider } from "../../form/slider.ts";
import { formatParameter } from "../../words/numbers.ts";

export interface Part {
  from: number;
  to: number;
}

export interface PartCard {
  element: HTMLElement;
  setUnit(unit: string): void;
  /** The record's whole extent; the first time it is also what is chosen. */
  setExtent(whole: Part): void;
  set(part: Part): void;
  /** Null: all of it. */
  read(): Part | null;
}

export function partCard(errors: FormErrors, onMove: () => void, onRelease: () => void): PartCard {
  let extent: Part | null = null;
  let unit = "s";
  const edge = (name: "from" | "to", label: string): ReturnType<typeof slider> =>
    slider(
      {
        label,
        unit,
        pointer: () => `/record/${name}`,
        spoken: (value) => `${label} ${formatParameter(value)} ${unit}`,
        onMove,
        onRelease,
      },
      errors,
    );
  const from = edge("from", "Use from");
  const to = edge("to", "Use up to");
  const all = h("button", { type: "button", class: "quiet", onclick: () => useAll() }, "Use all of it");
  const title = h("h2", { id: uniqueId("part"), class: "visually-hidden" }, "Which part counts");
  const element = h("section", { class: "part", "aria-labelledby": title.id }, title, from.element, to.element, all);

  function useAll(): void {
    if (!extent) return;
    from.set(extent.from);
    to.set(extent.to);
    onRelease();
  }

  return {
    element,
    setUnit(next) {
      unit = next;
      from.field.setUnit(unit);
      to.field.setUnit(unit);
    },
    setExtent(whole) {
      if (!extent) {
        from.set(whole.from);
        to.set(whole.to);
      }
      extent = whole;
      from.setLimits(whole.from, whole.to);
      to.setLimits(whole.from, whole.to);
    },
    set(part) {
      from.set(part.from);
      to.set(part.to);
    },
    read() {
      if (!extent || (from.value() <= extent.from && to.value() >= extent.to)) return null;
      return { from: from.value(), to: to.value() };
    },
  };
}
