// The legend above the plots: the drawn controllers, and the one whose settings and verdict are shown.
import type { Entry } from "../api/types.ts";
import { MAX_DRAWN } from "../charts/drawn.ts";
import type { Drawn } from "../charts/drawn.ts";
import { h } from "../dom.ts";
import { swatch } from "../plot/marks.ts";
import type { Store } from "../store.ts";

export interface Legend {
  element: HTMLElement;
  show(shown: LegendContent): void;
}

export interface LegendContent {
  entries: Entry[];
  /** Indices of the entries that have a place here. */
  listed: number[];
  names: string[];
  drawn: Drawn[];
  selected: number;
  /** For each of all entries, its index in the job's result. */
  origin?: number[];
  /** The proposal from which the selected entry was moved. */
  before?: Drawn | null;
}

export function createLegend(store: Store): Legend {
  const element = h("fieldset", { class: "legend" });
  let placeOf = (index: number): number => index;
  const controls = (): HTMLElement[] => [...element.querySelectorAll<HTMLElement>("input, button")];

  function drawBox(entry: Entry, index: number, name: string, indices: number[]): HTMLElement {
    const shown = indices.includes(index);
    const nothing = Boolean(entry.error) || !(entry.responses || entry.frequency);
    const box = h("input", {
      type: "checkbox",
      checked: shown,
      disabled: nothing || (!shown && indices.length >= MAX_DRAWN),
      "aria-label": `Draw ${name}`,
    });
    box.addEventListener("change", () => {
      const drawn = box.checked
        ? [...indices, index].sort((a, b) => a - b)
        : indices.filter((other) => other !== index);
      store.set((workspace) => ({ ...workspace, drawn: [...new Set(drawn.map(placeOf))] }));
    });
    return box;
  }

  function chooseButton(index: number, name: string, item: Drawn | undefined, selected: boolean): HTMLElement {
    const attributes = {
      type: "button",
      class: "quiet",
      "aria-pressed": String(selected),
      title: "Show its settings and verdict",
      onclick: () => store.set((workspace) => ({ ...workspace, selected: placeOf(index) })),
    };
    return h("button", attributes, item ? swatch(item.look) : null, name);
  }

  return {
    element,
    show({ entries, listed, names, drawn, selected, origin, before }) {
      placeOf = (index) => origin?.[index] ?? index;
      // The controls are created again; the focus is restored.
      const focused = controls().findIndex((control) => control === document.activeElement);
      const indices = drawn.map((item) => item.index);
      element.hidden = entries.length === 1 && !before;
      element.replaceChildren(
        h("legend", { class: "visually-hidden" }, "Which controllers to draw, and whose settings to show"),
        ...listed.map((index) =>
          h(
            "span",
            { class: index === selected ? "legend-item selected" : "legend-item" },
            drawBox(entries[index]!, index, names[index]!, indices),
            chooseButton(
              index,
              names[index]!,
              drawn.find((item) => item.index === index),
              index === selected,
            ),
          ),
        ),
        before ? h("span", { class: "legend-item", title: before.entry.title ?? null }, swatch(before.look), before.name) : "",
        listed.length > MAX_DRAWN ? h("span", { class: "hint" }, `At most ${MAX_DRAWN} are drawn.`) : "",
        entries.length > listed.length
          ? h("span", { class: "hint" }, `${entries.length - listed.length} more are in the comparison table.`)
          : "",
      );
      if (focused >= 0) controls()[focused]?.focus();
    },
  };
}
