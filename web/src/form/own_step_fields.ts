// The fields of the user's own step.
import { h } from "../dom.ts";
import { figureUnit } from "../words/figure_units.ts";
import type { UnitNames } from "../words/numbers.ts";
import { choiceField, textField } from "./controls.ts";
import type { Field } from "./controls.ts";
import type { FormErrors } from "./errors.ts";
import { pointerOf, STEP_LABELS } from "./own_step.ts";
import type { StepNumber, StepTexts, StepWord } from "./own_step.ts";

export interface OwnStepFields {
  element: HTMLElement;
  texts(): StepTexts;
  set(texts: StepTexts): void;
  setUnits(units: UnitNames): void;
}

/** What an empty field means. */
const EMPTY: Partial<Record<StepNumber, string>> = {
  y: "0",
  u: "0",
  ramp_rate: "at once",
  u_min: "no limit",
  u_max: "no limit",
  hold: "until y rests",
  "load.size": "none",
  length: "until y rests",
};

const PLACES = [["input", "plant input"], ["output", "plant output"]] as const;
const SHAPES = [["step", "step"], ["pulse", "pulse"], ["ramp", "ramp"]] as const;

/** `onChange`: a text was typed and left, or a choice was made. */
export function ownStepFields(errors: FormErrors, onChange: () => void): OwnStepFields {
  const numbers = new Map<StepNumber, Field<HTMLInputElement>>();
  const words = new Map<StepWord, Field<HTMLSelectElement>>();
  const number = (name: StepNumber): HTMLElement => {
    const field = textField({ label: STEP_LABELS[name], placeholder: EMPTY[name] ?? "", pointer: () => pointerOf(name) }, errors);
    numbers.set(name, field);
    return field.element;
  };
  const choice = (name: StepWord, label: string, choices: readonly (readonly [string, string])[]): HTMLElement => {
    const field = choiceField({ label, choices, pointer: () => pointerOf(name) }, errors);
    words.set(name, field);
    return field.element;
  };
  const group = (title: string, ...fields: HTMLElement[]): HTMLElement =>
    h("fieldset", {}, h("legend", {}, title), h("div", { class: "fields" }, fields));
  const element = h(
    "div",
    { class: "own-step-fields" },
    group("Before the step", number("y"), number("u")),
    group("Set point", number("target"), number("ramp_rate")),
    group("Limits of u", number("u_min"), number("u_max")),
    group(
      "Load",
      number("load.size"),
      choice("load.at", "Place of the load", PLACES),
      choice("load.shape", "Shape of the load", SHAPES),
      number("load.duration"),
      number("hold"),
      number("length"),
    ),
  );
  const value = (name: StepNumber | StepWord): string => (numbers.get(name as StepNumber) ?? words.get(name as StepWord))!.input.value;
  let units: UnitNames = { time: "", u: "", y: "" };

  /** Members of a load are there only with a load, a duration only if its shape has one. */
  function arrange(): void {
    const load = value("load.size").trim() !== "";
    for (const name of ["load.at", "load.shape"] as const) words.get(name)!.element.hidden = !load;
    numbers.get("load.duration")!.element.hidden = !load || value("load.shape") === "step";
    numbers.get("hold")!.element.hidden = !load;
    numbers.get("load.size")!.setUnit(value("load.at") === "output" ? units.y : units.u);
  }

  element.addEventListener("input", arrange);
  element.addEventListener("change", onChange);
  arrange();
  return {
    element,
    texts: () =>
      Object.fromEntries(
        [...numbers, ...words].flatMap(([name, field]) => {
          const text = field.input.value.trim();
          return text === "" || field.element.hidden ? [] : [[name, text]];
        }),
      ),
    set(texts) {
      for (const [name, { input, control }] of numbers) {
        input.value = texts[name] ?? "";
        errors.settle(control);
      }
      for (const [name, { input }] of words) {
        const known = [...input.options].some(({ value }) => value === texts[name]);
        input.value = known ? texts[name]! : input.options[0]!.value;
      }
      arrange();
    },
    setUnits(names) {
      units = names;
      for (const [name, field] of numbers)
        field.setUnit(name === "load.duration" ? figureUnit("OwnLoad", "duration", names) : figureUnit("OwnStep", name, names));
      arrange();
    },
  };
}
