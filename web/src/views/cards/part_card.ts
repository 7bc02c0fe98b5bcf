// The used part of a record: its start and its end, each with a slider and a number.
import { h, uniqueId } from "../../dom.ts";
import type { FieldError } from "../../api/types.ts";
import type { FormErrors } from "../../form/errors.ts";
import { slider } from "../../form/slider.ts";
import { formatParameter } from "../../words/numbers.ts";

export interface Part {
  from: number;
  to: number;
}

/** A move of u, and the part of the record with no other move. */
export interface Step extends Part {
  at: number;
}

export interface PartCard {
  element: HTMLElement;
  setUnit(unit: string): void;
  /** The record's whole extent. All of it is chosen until the user chooses a part. */
  setExtent(whole: Part): void;
  /** For another record, whose extent is not known yet. */
  clear(): void;
  set(part: Part): void;
  /** The record's steps, each with the part that shows it alone. */
  setSteps(steps: Step[]): void;
  /** The chosen part; null: the whole record. */
  read(): Part | null;
  /** Faults of fields that cannot be read: their sliders have other values. */
  faults(): FieldError[];
}

const MAX_STEPS = 100;

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
        onRelease() {
          showStep();
          onRelease();
        },
      },
      errors,
    );
  const from = edge("from", "Use from");
  const to = edge("to", "Use up to");
  const all = h("button", { type: "button", class: "quiet", onclick: () => useAll() }, "Use all of it");
  let list: Step[] = [];
  const choice = h("select", { id: uniqueId("step") });
  const steps = h("div", { class: "steps", hidden: true }, h("label", { for: choice.id }, "Use one step alone"), choice);
  choice.addEventListener("change", () => {
    const step = list[Number(choice.value)];
    if (choice.value !== "" && step) useStep(step);
  });
  const title = h("h2", { id: uniqueId("part"), class: "visually-hidden" }, "Part of the record to use");
  const element = h("section", { class: "part", "aria-labelledby": title.id }, title, from.element, to.element, all, steps);

  function useAll(): void {
    if (!extent) return;
    from.set(extent.from);
    to.set(extent.to);
    showStep();
    onRelease();
  }

  function useStep(step: Step): void {
    from.set(step.from);
    to.set(step.to);
    onRelease();
  }

  /** The step whose part is chosen, if it is that of one. */
  function showStep(): void {
    const at = list.findIndex((step) => step.from === from.value() && step.to === to.value());
    choice.value = at < 0 ? "" : String(at);
  }

  function read(): Part | null {
    if (!extent || (from.value() <= extent.from && to.value() >= extent.to)) return null;
    return { from: from.value(), to: to.value() };
  }

  return {
    element,
    setSteps(found) {
      list = found;
      // One step needs no choice, and very many steps are another kind of test.
      steps.hidden = list.length < 2 || list.length > MAX_STEPS;
      choice.replaceChildren(
        h("option", { value: "" }, `choose one of ${list.length}`),
        ...list.map((step, index) => h("option", { value: index }, `at ${formatParameter(step.at)} ${unit}`)),
      );
      showStep();
    },
    setUnit(next) {
      unit = next;
      from.field.setUnit(unit);
      to.field.setUnit(unit);
    },
    setExtent(whole) {
      if (read() === null) {
        from.set(whole.from);
        to.set(whole.to);
      }
      extent = whole;
      from.setLimits(whole.from, whole.to);
      to.setLimits(whole.from, whole.to);
    },
    clear() {
      extent = null;
    },
    set(part) {
      from.set(part.from);
      to.set(part.to);
    },
    read,
    faults: () =>
      [from, to].flatMap(({ field: { control } }) =>
        control.fault === undefined ? [] : [{ pointer: control.pointer() ?? "", detail: control.fault }],
      ),
  };
}
