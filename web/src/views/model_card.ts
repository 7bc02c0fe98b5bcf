// "A model": the kind of plant, its parameters, the formula as it is typed.
import type { Plant } from "../api/types.ts";
import { h, mathElement } from "../dom.ts";
import { choiceField, textField } from "../form/controls.ts";
import type { Field } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
import { plantFormula } from "../form/formula.ts";
import { formOf, PLANT_FORMS, readPlant } from "../form/plant.ts";
import type { PlantForm, PlantReading } from "../form/plant.ts";
import { quotient } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";

export interface ModelCard {
  element: HTMLFormElement;
  read(): PlantReading;
  /** False where this card cannot show such a plant. */
  load(plant: Plant): boolean;
  loadTyped(form: string, values: Record<string, string>): void;
  setUnits(units: UnitNames): void;
}

export interface ModelCardEvents {
  onTune(): void;
  /** The form's id and the texts as typed: what the address keeps. */
  onChange(form: string, values: Record<string, string>): void;
}

export function modelCard(errors: FormErrors, events: ModelCardEvents): ModelCard {
  let form: PlantForm = PLANT_FORMS[0]!;
  let units: UnitNames = { time: "s", u: "", y: "" };
  let fields: { name: string; unit: "gain" | "slope" | "time" | ""; field: Field<HTMLInputElement> }[] = [];
  const kind = choiceField(
    {
      label: "Kind of process",
      choices: PLANT_FORMS.map((candidate) => [candidate.id, candidate.title] as const),
      pointer: () => "/plant/type",
      wide: true,
    },
    errors,
  );
  const parameters = h("div", { class: "fields" });
  const formula = h("div", { class: "formula" });
  const button = h("button", { type: "submit", class: "primary" }, "Tune this model");
  const element = h(
    "form",
    { class: "card", novalidate: true },
    h("h2", {}, "A model"),
    h(
      "p",
      { class: "hint" },
      "You know how the process answers: its gain, lag and dead time, or its transfer function.",
    ),
    kind.element,
    parameters,
    formula,
    h("div", { class: "actions" }, button),
  );

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
          pointer: () => `/plant/${item.name}`,
          wide: item.example.includes(" ") || item.name === "num",
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
    events.onChange(form.id, texts());
  });
  parameters.addEventListener("input", showFormula);
  parameters.addEventListener("change", () => events.onChange(form.id, texts()));
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    events.onTune();
  });
  choose(form, examples(form));

  return {
    element,
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
    setUnits(next) {
      units = next;
      for (const item of fields) item.field.setUnit(unitText(item.unit));
    },
  };
}
