// A plant given by equations: conversions between the texts of its rows, the plant, and the address. No DOM.
import type { FieldError, Plant } from "../api/types.ts";
import { parseNumber } from "./number.ts";
import { exactText } from "../words/numbers.ts";

export interface StateTexts {
  name: string;
  /** Near the operating point. */
  value: string;
  /** d/dt of the state. */
  rate: string;
}

export interface ParameterTexts {
  name: string;
  /** A number, or an expression in numbers and other parameters. */
  value: string;
}

/** Fields that occur once. */
export const SINGLE_FIELDS = ["input", "nominal", "min", "max", "output", "L"] as const;
export type SingleField = (typeof SINGLE_FIELDS)[number];

export interface EquationTexts {
  states: StateTexts[];
  parameters: ParameterTexts[];
  single: Record<SingleField, string>;
}

/** A name as one part of a JSON Pointer. */
const part = (name: string): string => name.replaceAll("~", "~0").replaceAll("/", "~1");

/** Pointers of the fields' values in the request. The pointer of a name's field exists only in the form. */
export const pointers = {
  state: (name: string): string => `/plant/states/${part(name)}`,
  rate: (name: string): string => `/plant/equations/${part(name)}`,
  parameter: (name: string): string => `/plant/parameters/${part(name)}`,
  stateName: (row: number): string => `/plant/#/states/${row}`,
  parameterName: (row: number): string => `/plant/#/parameters/${row}`,
  single: {
    input: "/plant/input/name",
    nominal: "/plant/input/nominal",
    min: "/plant/input/min",
    max: "/plant/input/max",
    output: "/plant/output",
    L: "/plant/L",
  } satisfies Record<SingleField, string>,
};

/** An expression on one line: line breaks in the field are only for readability. */
const oneLine = (text: string): string => text.replace(/\s+/g, " ").trim();

/** The rows that are not empty; a name that is missing or occurs twice is a fault. */
function namedRows<Row extends { name: string }>(
  rows: Row[],
  what: string,
  pointer: (row: number) => string,
  errors: FieldError[],
): Row[] {
  const seen = new Set<string>();
  return rows.flatMap((row, index) => {
    if (Object.values(row).every((text: string) => text.trim() === "")) return [];
    const name = row.name.trim();
    if (name === "" || seen.has(name)) {
      const detail =
        name === ""
          ? `${what} ${index + 1} has no name. Give it one, for example ${what === "State" ? "h" : "k"}.`
          : `${name} is used twice. Give one of the two another name.`;
      errors.push({ pointer: pointer(index), detail });
      return [];
    }
    seen.add(name);
    return [{ ...row, name }];
  });
}

/** The plant as typed, and its faults, each with its pointer. */
export function readEquations(texts: EquationTexts): { plant: Plant; errors: FieldError[] } {
  const errors: FieldError[] = [];
  const states: Record<string, number> = {};
  const equations: Record<string, string> = {};
  const parameters: Record<string, number | string> = {};
  const input: Record<string, string | number> = {};
  const number = (text: string, name: string, pointer: string, put: (value: number) => void): void => {
    const parsed = parseNumber(text, name);
    if (parsed.ok) put(parsed.value);
    else errors.push({ pointer, detail: parsed.sentence });
  };

  const rows = namedRows(texts.states, "State", pointers.stateName, errors);
  for (const { name, value, rate } of rows) {
    number(value, name, pointers.state(name), (near) => (states[name] = near));
    equations[name] = oneLine(rate);
    if (equations[name] === "")
      errors.push({
        pointer: pointers.rate(name),
        detail: `d${name}/dt is empty. Write how ${name} changes, for example (q - a*sqrt(${name}))/A.`,
      });
  }
  if (rows.length === 0 && errors.length === 0)
    errors.push({ pointer: pointers.stateName(0), detail: "There is no state. Give at least one with its equation." });
  for (const { name, value } of namedRows(texts.parameters, "Parameter", pointers.parameterName, errors)) {
    const parsed = parseNumber(value, name);
    if (oneLine(value) === "")
      errors.push({ pointer: pointers.parameter(name), detail: `${name} is empty. Write a number or an expression.` });
    else parameters[name] = parsed.ok ? parsed.value : oneLine(value);
  }
  const { single } = texts;
  input["name"] = single.input.trim() || "u";
  number(single.nominal, "The input's value", pointers.single.nominal, (value) => (input["nominal"] = value));
  for (const limit of ["min", "max"] as const)
    if (single[limit].trim() !== "")
      number(single[limit], limit, pointers.single[limit], (value) => (input[limit] = value));
  if (oneLine(single.output) === "")
    errors.push({
      pointer: pointers.single.output,
      detail: "The output is empty. Write what is measured, for example a state.",
    });
  const plant: Plant = { type: "nonlinear", states, parameters, equations, input, output: oneLine(single.output) };
  if (single.L.trim() !== "") number(single.L, "Dead time", pointers.single.L, (value) => (plant.L = value));
  return { plant, errors };
}

const KNOWN = new Set(["type", "states", "parameters", "equations", "input", "output", "L"]);
const record = (value: unknown): Record<string, unknown> =>
  typeof value === "object" && value !== null ? (value as Record<string, unknown>) : {};
const written = (value: unknown): string =>
  typeof value === "number" ? shortest(value) : typeof value === "string" ? value : "";

/** Every digit, but no series of zeros: 4.71e8. */
function shortest(value: number): string {
  const size = Math.abs(value);
  return size >= 1e6 || (size < 1e-3 && size > 0) ? value.toExponential().replace("e+", "e") : exactText(value);
}

/** The texts that show a plant; null if it is of another kind or has parts without a field. */
export function writeEquations(plant: Plant): EquationTexts | null {
  if (plant.type !== "nonlinear" || !Object.keys(plant).every((key) => KNOWN.has(key))) return null;
  const [values, rates, input] = [record(plant["states"]), record(plant["equations"]), record(plant["input"])];
  return {
    states: Object.keys(values).map((name) => ({ name, value: written(values[name]), rate: written(rates[name]) })),
    parameters: Object.entries(record(plant["parameters"])).map(([name, value]) => ({ name, value: written(value) })),
    single: {
      input: written(input["name"]) || "u",
      nominal: written(input["nominal"]),
      min: written(input["min"]),
      max: written(input["max"]),
      output: written(plant["output"]),
      L: written(plant.L),
    },
  };
}

/** The part of the texts in the address: rows under x.name, dx.name and p.name. */
export function equationsAddress(texts: EquationTexts): Record<string, string> {
  const rows = texts.states.flatMap(({ name, value, rate }) => [
    [`x.${name}`, value],
    [`dx.${name}`, rate],
  ]);
  const parameters = texts.parameters.map(({ name, value }) => [`p.${name}`, value]);
  return Object.fromEntries([...rows, ...parameters, ...Object.entries(texts.single)]) as Record<string, string>;
}

export function equationsOfAddress(values: Record<string, string>): EquationTexts {
  const named = (prefix: string): string[] =>
    Object.keys(values).flatMap((key) => (key.startsWith(prefix) ? [key.slice(prefix.length)] : []));
  const states = [...new Set([...named("x."), ...named("dx.")])];
  return {
    states: states.map((name) => ({ name, value: values[`x.${name}`] ?? "", rate: values[`dx.${name}`] ?? "" })),
    parameters: named("p.").map((name) => ({ name, value: values[`p.${name}`] ?? "" })),
    single: Object.fromEntries(SINGLE_FIELDS.map((field) => [field, values[field] ?? ""])) as EquationTexts["single"],
  };
}
