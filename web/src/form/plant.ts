// The model card's fields: the plants that can be entered, and the notation of their parameters.
import type { Plant } from "../api/types.ts";
import { parseMatrix, parseNumber, parseNumbers, parseRanges, parseRoots, writeRoots } from "./number.ts";
import type { Parsed } from "./number.ts";
import { exactText } from "../words/numbers.ts";

export interface PlantField {
  /** Name in the contract. */
  name: string;
  hint: string;
  /** The unit behind it. */
  unit: "gain" | "slope" | "time" | "";
  optional?: boolean;
  example: string;
  read(text: string): Parsed<unknown>;
  write(value: unknown): string;
}

export interface PlantForm {
  /** The form's own key; several forms may represent one type. */
  id: string;
  type: string;
  title: string;
  fields: PlantField[];
}

const writeNumber = (value: unknown): string => (typeof value === "number" ? exactText(value) : "");
const writeList = (value: unknown): string => (Array.isArray(value) ? value.map(String).join(" ") : writeNumber(value));
const writeMatrix = (value: unknown): string =>
  Array.isArray(value)
    ? value.map((row: unknown) => (Array.isArray(row) ? row.map(String).join(" ") : String(row))).join("; ")
    : writeNumber(value);

const writeRanges = (value: unknown): string =>
  typeof value === "object" && value !== null
    ? Object.entries(value)
        .map(([symbol, range]) => `${symbol} ${writeList(range)}`)
        .join("; ")
    : "";

function numberField(
  name: string,
  hint: string,
  unit: PlantField["unit"],
  example: string,
  optional = false,
): PlantField {
  return { name, hint, unit, example, optional, read: (text) => parseNumber(text, name), write: writeNumber };
}

const listField = (name: string, hint: string, example: string): PlantField => ({
  name,
  hint,
  unit: "",
  example,
  read: (text) => parseNumbers(text, name),
  write: writeList,
});
const rootField = (name: string, hint: string, example: string): PlantField => ({
  name,
  hint,
  unit: "",
  example,
  optional: true,
  read: (text) => parseRoots(text, name),
  write: writeRoots,
});
const matrixField = (name: string, hint: string, example: string): PlantField => ({
  name,
  hint,
  unit: "",
  example,
  read: (text) => parseMatrix(text, name),
  write: writeMatrix,
});

const gain = numberField("K", "steady-state change in y per unit of u", "gain", "1.25");
const deadTime = numberField("L", "dead time: time before y responds", "time", "8");
const optionalDeadTime = numberField("L", "dead time; empty: 0", "time", "", true);

/** Factors of the parameters that bound the plant. */
const uncertainty: PlantField = {
  name: "uncertainty",
  hint: "least and largest factor, as K 0.8 1.2; L 0.9 1.2. Empty: known exactly",
  unit: "",
  example: "",
  optional: true,
  read: (text) => parseRanges(text, "uncertainty"),
  write: writeRanges,
};

export const PLANT_FORMS: PlantForm[] = [
  {
    id: "fopdt",
    type: "fopdt",
    title: "First order with dead time",
    fields: [
      gain,
      numberField("T", "time constant, at 63 % of the step response; negative: unstable", "time", "40"),
      deadTime,
      uncertainty,
    ],
  },
  {
    id: "sopdt",
    type: "sopdt",
    title: "Second order, two time constants",
    fields: [
      gain,
      numberField("T1", "first time constant", "time", "10"),
      numberField("T2", "second time constant", "time", "5"),
      deadTime,
      uncertainty,
    ],
  },
  {
    id: "sopdt_zeta",
    type: "sopdt",
    title: "Second order, damped oscillation",
    fields: [
      gain,
      numberField("T", "1/natural frequency", "time", "10"),
      numberField("zeta", "damping; below 1 it oscillates", "", "0.4"),
      deadTime,
      uncertainty,
    ],
  },
  {
    id: "ipdt",
    type: "ipdt",
    title: "Integrating with dead time",
    fields: [
      numberField("K", "slope of y per unit of u", "slope", "0.02"),
      deadTime,
      numberField("T", "additional lag; empty: none", "time", "", true),
      uncertainty,
    ],
  },
  {
    id: "transfer_function",
    type: "transfer_function",
    title: "Transfer function",
    fields: [
      listField("num", "numerator, falling powers of s", "1"),
      listField("den", "denominator, falling powers of s", "1 3 3 1"),
      optionalDeadTime,
    ],
  },
  {
    id: "zpk",
    type: "zpk",
    title: "Zeros, poles and gain",
    fields: [
      numberField("K", "leading factor; not the static gain", "", "2"),
      rootField("zeros", "empty: none. Pairs as -1±2i", ""),
      rootField("poles", "for example -1 -2±1i", "-1 -2±1i"),
      optionalDeadTime,
    ],
  },
  {
    id: "state_space",
    type: "state_space",
    title: "State space",
    fields: [
      matrixField("A", "rows with semicolons between them", "-1 0; 1 -2"),
      listField("B", "input column", "1 0"),
      listField("C", "output row", "0 1"),
      numberField("D", "direct part; empty: 0", "", "", true),
      optionalDeadTime,
    ],
  },
];

/** The form that can show this plant, or null. */
export function formOf(plant: Plant): PlantForm | null {
  if (plant.type === "sopdt" && plant["zeta"] !== undefined)
    return PLANT_FORMS.find((form) => form.id === "sopdt_zeta")!;
  const form = PLANT_FORMS.find((candidate) => candidate.type === plant.type) ?? null;
  const known = new Set(["type", ...(form?.fields.map((field) => field.name) ?? [])]);
  return form && Object.keys(plant).every((key) => known.has(key)) ? form : null;
}

export interface PlantReading {
  plant: Plant;
  errors: { pointer: string; detail: string }[];
}

/** The plant as typed; faults carry their pointers. */
export function readPlant(form: PlantForm, typed: (name: string) => string): PlantReading {
  const plant: Plant = { type: form.type };
  const errors: PlantReading["errors"] = [];
  for (const field of form.fields) {
    const text = typed(field.name);
    const listLike = field.name === "zeros" || field.name === "poles";
    if (field.optional && text.trim() === "" && !listLike) continue;
    const parsed = field.read(text);
    if (parsed.ok) plant[field.name] = parsed.value;
    else errors.push({ pointer: `/plant/${field.name}`, detail: parsed.sentence });
  }
  return { plant, errors };
}
