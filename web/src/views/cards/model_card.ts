// "A model": in one line or by its kind and parameters, with its formula during typing.
import type { Plant } from "../../api/types.ts";
import { h } from "../../dom.ts";
import type { FormErrors } from "../../form/errors.ts";
import type { PlantReading } from "../../form/plant.ts";
import { LINE, plantFields } from "../../form/plant_fields.ts";
import type { UnitNames } from "../../words/numbers.ts";

export interface ModelCard {
  element: HTMLFormElement;
  read(): PlantReading;
  settled(): Promise<void>;
  beginLoop(): void;
  isLine(input: EventTarget | null): boolean;
  /** False if this card cannot show such a plant. */
  load(plant: Plant): boolean;
  /** The form's id and the texts as typed, for the address. */
  typed(): { form: string; values: Record<string, string> };
  /** True if its model has changed. */
  loadTyped(form: string, values: Record<string, string>): boolean;
  setUnits(units: UnitNames): void;
}

export interface ModelCardEvents {
  onTune(): void;
  /** By every method. */
  onCompare(): void;
  /** The form's id and the texts as typed, for the address. */
  onChange(form: string, values: Record<string, string>): void;
  /** Simulates a relay test on this plant. */
  onRelay(form: string, values: Record<string, string>): void;
}

/** `active`: returns true if a request that is sent now is about this card's model. */
export function modelCard(errors: FormErrors, active: () => boolean, events: ModelCardEvents): ModelCard {
  const fields = plantFields(errors, active, () => {
    const { form, values } = fields.typed();
    events.onChange(form, values);
  });
  const relay = (): void => {
    const { form, values } = fields.typed();
    events.onRelay(form, values);
  };
  const element = h(
    "form",
    { class: "card", novalidate: true },
    h("h2", {}, "A model"),
    h(
      "p",
      { class: "hint" },
      "You know how the process responds: its gain, lag and dead time, or its transfer function.",
    ),
    fields.elements,
    h("div", { class: "actions" }, h("button", { type: "submit", class: "primary" }, "Tune this model")),
    h(
      "div",
      { class: "actions" },
      h("button", { type: "button", onclick: () => events.onCompare() }, "Compare all methods"),
      h("button", { type: "button", class: "quiet", onclick: relay }, "Simulate a relay test on it"),
    ),
  );
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    events.onTune();
  });
  return {
    element,
    read: fields.read,
    settled: fields.settled,
    beginLoop: fields.beginLoop,
    isLine: fields.isLine,
    load: fields.load,
    typed: fields.typed,
    loadTyped(form, values) {
      const before = fields.typed();
      const names = [LINE, ...Object.keys(before.values)];
      const isShown = form === before.form && names.every((name) => (values[name] ?? "") === (before.values[name] ?? ""));
      if (isShown) return false;
      fields.loadTyped(form, values);
      return JSON.stringify(fields.typed()) !== JSON.stringify(before);
    },
    setUnits: fields.setUnits,
  };
}
