// A plant to enter: its kind, its parameters, the formula as it is typed. On Start and on the relay test's screen.
import type { Plant } from "../api/types.ts";
import { h, mathElement } from "../dom.ts";
import { quotient } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { choiceField, textField } from "./controls.ts";
import type { Field } from "./controls.ts";
import type { FormErrors } from "./errors.ts";
import { plantFormula } from "./formula.ts";
import { formOf, PLANT_FORMS, readPlant } from "./plant.ts";
import type { PlantForm, PlantReading } from "./plant.ts";

export interface PlantFields {
  elements: HTMLElement[];
  read(): PlantReading;
  /** False where these fields cannot show such a plant. */
  load(plant: Plant): boolean;
  loadTyped(form: string, values: Record<string, string>): void;
  /** The form's id and the texts as typed: what an address keeps. */
  typed(): { form: string; values: Record<string, string> };
  setUnits(units: UnitNames): void;
}

/** `active`: whether a request that is sent now is about these fields' plant. */
export function plantFields(errors: FormErrors, active: () => boolean, onChange: () => void): PlantFields {
  let form: PlantForm = PLANT_FORMS[0]!;
  let units: UnitNames = { time: "s", u: "", y: "" };
  let fields: { name: string; unit: "gain" | "slope" | "time" | ""; field: Field<HTMLInputElement> }[] = [];
  const kind = choiceField(
    {
      label: "Kind of process",
      choices: PLANT_FORMS.map((candidate) => [candidate.id, candidate.title] as const),
      pointer: () => (active() ? "/plant/type" : null),
      wide: true,
    },
    errors,
  );
  const parameters = h("div", { class: "fields" });
  const formula = h("div", { class: "formula" });

  const typed = (name: string): string => fields.find((item) => item.name === name)?.field.input.value ?? "";
  const texts = (): Record<string, string> =>
    Object.fromEntries(fields.map((item) => [item.name, item.field.input.value]));
  const unitText = (unit: string): string => {
    const ratio = quotient(units.y, units.u);
    if (unit === "gain") return ratio;
    if (unit === "slope") return ratio ? `${ratio}/${units.time}` : `1/${units.time}`;
    return unit === "time" ? units.time : "";
  };

  function showFormula(): void {
    const reading = readPlant(form, typed);
    const tree = reading.errors.length === 0 ? plantFormula(reading.plant) : null;
    formula.replaceChildren(
      tree ? mathElement(tree) : h("span", { class: "hint" }, "The formula appears when the numbers are complete."),
    );
  }

  function choose(next: PlantForm, values: Record<string, string>): void {
    form = next;
    kind.input.value = form.id;
    for (const item of fields) errors.remove(item.field.control);
    fields = form.fields.map((item) => ({
      name: item.name,
      unit: item.unit,
      field: textField(
        {
          label: item.name,
          hint: item.hint,
          unit: unitText(item.unit),
          value: values[item.name] ?? "",
          pointer: () => (active() ? `/plant/${item.name}` : null),
          wide: item.example.includes(" ") || item.name === "num" || item.name === "uncertainty",
        },
        errors,
      ),
    }));
    parameters.replaceChildren(...fields.map((item) => item.field.element));
    showFormula();
  }

  const examples = (of: PlantForm): Record<string, string> =>
    Object.fromEntries(of.fields.map((field) => [field.name, field.example]));

  kind.input.addEventListener("change", () => {
    const next = PLANT_FORMS.find((candidate) => candidate.id === kind.input.value) ?? PLANT_FORMS[0]!;
    choose(next, examples(next));
    onChange();
  });
  parameters.addEventListener("input", showFormula);
  parameters.addEventListener("change", () => onChange());
  choose(form, examples(form));

  return {
    elements: [kind.element, parameters, formula],
    read: () => readPlant(form, typed),
    load(plant) {
      const match = formOf(plant);
      if (!match) return false;
      choose(match, Object.fromEntries(match.fields.map((field) => [field.name, field.write(plant[field.name])])));
      return true;
    },
    loadTyped(id, values) {
      const match = PLANT_FORMS.find((candidate) => candidate.id === id);
      if (match) choose(match, Object.keys(values).length > 0 ? values : examples(match));
    },
    typed: () => ({ form: form.id, values: texts() }),
    setUnits(next) {
      units = next;
      for (const item of fields) item.field.setUnit(unitText(item.unit));
    },
  };
}
