// "Equations": a nonlinear plant as its differential equations, filled from an example or by hand.
import type { Example, Plant } from "../../api/types.ts";
import { h } from "../../dom.ts";
import { choiceField } from "../../form/controls.ts";
import { equationFields } from "../../form/equation_fields.ts";
import { equationsAddress, equationsOfAddress } from "../../form/equations.ts";
import type { FormErrors } from "../../form/errors.ts";
import type { PlantReading } from "../../form/plant.ts";
import type { UnitNames } from "../../words/numbers.ts";

export interface EquationsCard {
  element: HTMLFormElement;
  read(): PlantReading;
  /** False if this card cannot show such a plant. */
  load(plant: Plant): boolean;
  /** The texts as typed, for the address. */
  typed(): Record<string, string>;
  /** True if its equations have changed. */
  loadTyped(values: Record<string, string>): boolean;
  setExamples(examples: Example[]): void;
  setUnits(units: UnitNames): void;
}

export interface EquationsCardEvents {
  onTune(): void;
  /** By every method. */
  onCompare(): void;
  /** The texts as typed, for the address. */
  onChange(values: Record<string, string>): void;
  /** A complete request: equations, units and methods. */
  onExample(example: Example): void;
}

/** A tank with an outflow of its own: the smallest example that uses every field. */
const FIRST: Plant = {
  type: "nonlinear",
  states: { h: 1 },
  parameters: { A: 2, k: 0.5 },
  equations: { h: "(q - k*sqrt(h))/A" },
  input: { name: "q", nominal: 0.5, min: 0 },
  output: "h",
};

export function equationsCard(errors: FormErrors, active: () => boolean, events: EquationsCardEvents): EquationsCard {
  let examples: Example[] = [];
  const fields = equationFields(errors, active, () => events.onChange(equationsAddress(fields.texts())));
  const choice = choiceField(
    { label: "Fill from an example", choices: [["", "choose one"]], pointer: () => null },
    errors,
  );
  const details = h(
    "details",
    { class: "equations-form" },
    h("summary", {}, "Write equations"),
    h(
      "p",
      { class: "hint" },
      "One row per state, in numbers, states, parameters and the input: + − * / ^, a < b ? c : d, exp log sqrt sin cos tan tanh abs min max. The values need only be near the operating point; the service finds the steady state.",
    ),
    fields.element,
    h(
      "div",
      { class: "actions" },
      h("button", { type: "submit", class: "primary" }, "Tune these equations"),
      h("button", { type: "button", onclick: () => events.onCompare() }, "Compare all methods on these equations"),
    ),
  );
  const element = h(
    "form",
    { class: "card equations-card", novalidate: true, "aria-labelledby": "equations-title" },
    h(
      "div",
      { class: "equations-head" },
      h("h2", { id: "equations-title" }, "Equations"),
      h(
        "p",
        { class: "hint" },
        "You know the nonlinear equations of the process: every controller is tuned on their linearisation and simulated on the equations. The method emulation is tuned on the equations too.",
      ),
      choice.element,
    ),
    details,
  );
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    events.onTune();
  });
  choice.input.addEventListener("change", () => {
    const example = examples.find((candidate) => candidate.id === choice.input.value);
    if (example) events.onExample(example);
  });
  fields.load(FIRST);

  return {
    element,
    read: fields.read,
    load(plant) {
      const shown = fields.load(plant);
      if (shown) details.open = true;
      return shown;
    },
    typed: () => equationsAddress(fields.texts()),
    loadTyped(values) {
      const before = JSON.stringify(fields.texts());
      if (Object.keys(values).length > 0) fields.show(equationsOfAddress(values));
      details.open = true;
      return JSON.stringify(fields.texts()) !== before;
    },
    setExamples(all) {
      examples = all.filter((example) => example.request.plant?.type === "nonlinear");
      choice.element.hidden = examples.length === 0;
      choice.input.replaceChildren(
        h("option", { value: "" }, "choose one"),
        ...examples.map((example) => h("option", { value: example.id }, example.title)),
      );
    },
    setUnits: fields.setUnits,
  };
}
