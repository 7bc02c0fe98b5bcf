// Fields for equations: rows of states and parameters that can be added and removed, the input, the output.
import type { Plant } from "../api/types.ts";
import { h } from "../dom.ts";
import type { Child } from "../dom.ts";
import type { UnitNames } from "../words/numbers.ts";
import { areaField, textField } from "./controls.ts";
import type { Field } from "./controls.ts";
import type { Control, FormErrors } from "./errors.ts";
import { pointers, readEquations, SINGLE_FIELDS, writeEquations } from "./equations.ts";
import type { EquationTexts, ParameterTexts, SingleField, StateTexts } from "./equations.ts";
import { rowList } from "./row_list.ts";
import type { Row } from "./row_list.ts";

export interface EquationFields {
  element: HTMLElement;
  read: () => ReturnType<typeof readEquations>;
  /** False if these fields cannot show such a plant. */
  load(plant: Plant): boolean;
  show(texts: EquationTexts): void;
  texts(): EquationTexts;
  setUnits(units: UnitNames): void;
}

/** `active`: returns true if a request that is sent now is about these equations. */
export function equationFields(errors: FormErrors, active: () => boolean, onChange: () => void): EquationFields {
  const own = (pointer: () => string) => (): string | null => (active() ? pointer() : null);
  const single = singleFields(errors, own);
  const states = rowList<StateTexts>(
    "state",
    ["State", "Value near", "Its change over time"],
    onChange,
    nameOf,
    (texts, rows) => stateRow(texts, errors, own, (row) => rows().indexOf(row)),
  );
  const parameters = rowList<ParameterTexts>(
    "parameter",
    ["Parameter", "Number or expression"],
    onChange,
    nameOf,
    (texts, rows) => parameterRow(texts, errors, own, (row) => rows().indexOf(row)),
  );
  const element = h(
    "div",
    { class: "equations" },
    h("fieldset", { class: "equation-states" }, h("legend", {}, "States and equations"), states.element),
    h(
      "fieldset",
      { class: "equation-signals" },
      h("legend", {}, "Input and output"),
      h(
        "div",
        { class: "fields" },
        SINGLE_FIELDS.map((name) => single[name].element),
      ),
    ),
    h("fieldset", { class: "equation-parameters" }, h("legend", {}, "Parameters"), parameters.element),
  );
  element.addEventListener("change", onChange);

  function texts(): EquationTexts {
    return {
      states: states.texts(),
      parameters: parameters.texts(),
      single: Object.fromEntries(
        SINGLE_FIELDS.map((name) => [name, single[name].input.value]),
      ) as EquationTexts["single"],
    };
  }

  function show(next: EquationTexts): void {
    states.show(next.states.length > 0 ? next.states : [{ name: "", value: "", rate: "" }]);
    parameters.show(next.parameters);
    for (const name of SINGLE_FIELDS) single[name].input.value = next.single[name];
  }

  return {
    element,
    read: () => readEquations(texts()),
    load(plant) {
      const written = writeEquations(plant);
      if (written) show(written);
      return written !== null;
    },
    show,
    texts,
    setUnits(units) {
      for (const name of ["nominal", "min", "max"] as const) single[name].setUnit(units.u);
      single.output.setUnit(units.y);
      single.L.setUnit(units.time);
    },
  };
}

/** The name of a row in its button to remove it. */
const nameOf = ({ name }: { name: string }): string => name || "without a name";

type Own = (pointer: () => string) => () => string | null;

function singleFields(errors: FormErrors, own: Own): Record<SingleField, Field<Control["input"]>> {
  const field = (name: SingleField, label: string, hint: string, placeholder = ""): Field<HTMLInputElement> =>
    textField({ label, hint, placeholder, pointer: own(() => pointers.single[name]) }, errors);
  return {
    input: field("input", "Name of the input", "as in the equations", "u"),
    nominal: field("nominal", "Its value", "at the operating point"),
    min: field("min", "Lower limit", "absolute; empty: none", "none"),
    max: field("max", "Upper limit", "absolute; empty: none", "none"),
    output: field("output", "Output", "the measurement: a state or an expression"),
    L: field("L", "Dead time", "of the input; empty: 0", "0"),
  };
}

type Position<Texts> = (row: Row<Texts>) => number;

function rowOf<Texts>(
  kind: string,
  fields: Field<Control["input"]>[],
  children: Child[],
  errors: FormErrors,
  texts: () => Texts,
): Row<Texts> {
  return {
    element: h("div", { class: `row ${kind}`, role: "group" }, children),
    first: fields[0]!.input,
    texts,
    dispose() {
      for (const field of fields) errors.remove(field.control);
    },
  };
}

function stateRow(
  given: StateTexts | null,
  errors: FormErrors,
  own: Own,
  position: Position<StateTexts>,
): Row<StateTexts> {
  const typed = (): string => name.input.value.trim();
  const name = textField(
    {
      label: "Name of the state",
      bare: true,
      value: given?.name ?? "",
      pointer: own(() => pointers.stateName(position(row))),
    },
    errors,
  );
  const value = textField(
    { label: "", bare: true, value: given?.value ?? "", pointer: own(() => pointers.state(typed())) },
    errors,
  );
  const rate = areaField(
    { label: "", rows: 1, value: given?.rate ?? "", pointer: own(() => pointers.rate(typed())) },
    errors,
  );
  rate.element.classList.add("rate");
  const relabel = (): void => {
    value.setLabel(`Value of ${typed() || "the state"} near the operating point`);
    rate.setLabel(`d${typed() || "…"}/dt =`);
    row.element.setAttribute("aria-label", `State ${typed()}`);
  };
  const row = rowOf("state-row", [name, value, rate], [name.element, value.element, rate.element], errors, () => ({
    name: name.input.value,
    value: value.input.value,
    rate: rate.input.value,
  }));
  name.input.addEventListener("input", relabel);
  relabel();
  return row;
}

function parameterRow(
  given: ParameterTexts | null,
  errors: FormErrors,
  own: Own,
  position: Position<ParameterTexts>,
): Row<ParameterTexts> {
  const typed = (): string => name.input.value.trim();
  const name = textField(
    {
      label: "Name of the parameter",
      bare: true,
      value: given?.name ?? "",
      pointer: own(() => pointers.parameterName(position(row))),
    },
    errors,
  );
  const value = textField(
    { label: "", bare: true, value: given?.value ?? "", pointer: own(() => pointers.parameter(typed())) },
    errors,
  );
  const relabel = (): void => {
    value.setLabel(`Value of ${typed() || "the parameter"}`);
    row.element.setAttribute("aria-label", `Parameter ${typed()}`);
  };
  const row = rowOf("parameter-row", [name, value], [name.element, value.element], errors, () => ({
    name: name.input.value,
    value: value.input.value,
  }));
  name.input.addEventListener("input", relabel);
  relabel();
  return row;
}
