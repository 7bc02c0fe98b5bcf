// What can be turned on a design: the options of its method that are numbers, and the settings themselves.
import type { Controller, Entry, Method, Schema, TuneEntry } from "../api/types.ts";
import type { UnitNames } from "../words/numbers.ts";
import { namedUnit, quotient } from "../words/numbers.ts";

export interface Knob {
  /** Its option with dots between the parts, or the setting's name; stands in the address too. */
  id: string;
  label: string;
  unit: string;
  lo: number;
  hi: number;
  /** Even steps of the logarithm. */
  log: boolean;
  /** What one press of an arrow key is worth; 1 % where it is logarithmic. */
  step?: number;
  /** What its ends mean. */
  ends?: [string, string];
  /** Null: the method's own choice, which it does not tell. */
  value: number | null;
  /** What the method says of the option's values. */
  schema?: Schema;
  /** The value of the same quantity that a design came to: less or more than was asked for. */
  reached?(entry: Entry): number | null;
}

export type HandName = "Kp" | "Ti" | "Td" | "Tf";
export const HAND: readonly HandName[] = ["Kp", "Ti", "Td", "Tf"];

const MS_RANGE = { lo: 1.1, hi: 2.5, step: 0.01, log: false };
export const DEFAULT_LIMIT = 1.4;
const SPREAD = 5;
export const OVERSHOOT = "setpoint.overshoot";

/** Why a typed value cannot be asked for; "" where it can. */
export function wrongValue({ label, schema }: Knob, value: number): string {
  const { minimum, exclusiveMinimum, maximum, exclusiveMaximum } = schema ?? {};
  const rules = [
    minimum !== undefined && value < minimum ? `at least ${minimum}` : "",
    exclusiveMinimum !== undefined && value <= exclusiveMinimum ? `above ${exclusiveMinimum}` : "",
    maximum !== undefined && value > maximum ? `at most ${maximum}` : "",
    exclusiveMaximum !== undefined && value >= exclusiveMaximum ? `below ${exclusiveMaximum}` : "",
  ].filter(Boolean);
  return rules.length > 0 ? `${label} is ${value}; it must be ${rules.join(" and ")}.` : "";
}

/** Of an option with dots between its parts, as far as the method describes it. */
function schemaAt(method: Method | undefined, id: string): Pick<Knob, "schema"> {
  let at: Schema | undefined = method?.options;
  for (const part of id.split(".")) at = at?.properties?.[part];
  const schema = at && numberSchema(at);
  return schema ? { schema } : {};
}

const numberAt = (tune: TuneEntry, id: string): number | null => {
  const value = id.split(".").reduce<unknown>((at, part) => (at as Record<string, unknown> | undefined)?.[part], tune);
  return typeof value === "number" ? value : null;
};

/** One slider for both limits of `robust`. */
export const isTied = (tune: TuneEntry): boolean =>
  (numberAt(tune, "Ms") ?? DEFAULT_LIMIT) === (numberAt(tune, "Mt") ?? DEFAULT_LIMIT);

/** The same options with one of them changed; parts of an option that exclude each other are replaced by it. */
export function withOption(tune: TuneEntry, id: string, value: number, tied: boolean): TuneEntry {
  const [name = id, part] = id.split(".");
  const next: TuneEntry = { ...tune, [name]: part ? { [part]: value } : value };
  return tied && id === "Ms" ? { ...next, Mt: value } : next;
}

/** Options that a slider makes no sense of: they choose how to search, or shape a report. */
const NOT_TURNED = ["rho", "take", "Ku", "Pu", "c3", "horizon"];
/** Methods whose own cards have their sliders. */
const OWN_CARDS = ["rimc", "emulation", "frontier"];

export function optionKnobs(tune: TuneEntry, entry: Entry, method: Method | undefined, units: UnitNames): Knob[] {
  if (tune.method === "robust") return robustKnobs(tune, entry, method, units);
  if (OWN_CARDS.includes(tune.method)) return [];
  return Object.entries(method?.options?.properties ?? {}).flatMap(([name, schema]) => {
    const numeric = numberSchema(schema);
    if (!numeric || NOT_TURNED.includes(name)) return [];
    const told = numberAt(tune, name) ?? numberAt({ method: "", ...entry.options }, name) ?? given(schema.default);
    const range = rangeOf(numeric, told, entry);
    return range ? [{ id: name, label: nameOf(name), unit: namedUnit(schema["x-unit"] ?? "", units), ...range, value: told, schema: numeric }] : [];
  });
}

const given = (value: unknown): number | null => (typeof value === "number" ? value : null);
/** Words in full, symbols as they are written. */
const nameOf = (name: string): string => (name.length < SYMBOL_LENGTH ? name : name.replaceAll("_", " ").replace(/ deg$/, ""));
const SYMBOL_LENGTH = 7;

/** The schema of the number that an option may be. */
const numberSchema = (schema: Schema): Schema | null =>
  schema.type === "number" ? schema : (schema.oneOf?.find((item) => item.type === "number") ?? null);

/** Between the option's own ends, else about its value, else about the loop's own time. */
function rangeOf(schema: Schema, value: number | null, entry: Entry): Pick<Knob, "lo" | "hi" | "log"> | null {
  const lo = schema.minimum ?? schema.exclusiveMinimum;
  const hi = schema.maximum ?? schema.exclusiveMaximum;
  if (lo !== undefined && hi !== undefined) {
    const inside = schema.exclusiveMinimum === undefined ? 0 : (hi - lo) / 100;
    return { lo: lo + inside, hi, log: false };
  }
  if (lo !== 0) return null;
  const crossover = entry.robustness?.gain_crossover;
  const about = value ?? (schema["x-unit"] === "time" && crossover ? 1 / crossover : null);
  return about && about > 0 ? { lo: about / SPREAD, hi: about * SPREAD, log: true } : null;
}

function robustKnobs(tune: TuneEntry, entry: Entry, method: Method | undefined, units: UnitNames): Knob[] {
  const limit = (id: "Ms" | "Mt", label: string): Knob => ({
    id,
    label,
    unit: "",
    ...MS_RANGE,
    ends: ["calm", "sharp"],
    value: numberAt(tune, id) ?? DEFAULT_LIMIT,
  });
  return [
    limit("Ms", "Robustness Ms"),
    ...(isTied(tune) ? [] : [limit("Mt", "Robustness Mt")]),
    noiseKnob(tune, entry, units),
    ...setpointKnob(tune, entry, method),
  ].map((knob) => ({ ...knob, ...schemaAt(method, knob.id) }));
}

/** How much noise reaches the output: by a limit on Mks, or by the filter's time. */
function noiseKnob(tune: TuneEntry, entry: Entry, units: UnitNames): Knob {
  const filter = entry.controller?.filter?.Tf ?? null;
  const Td = entry.controller?.Td ?? null;
  const byLimit = numberAt(tune, "Mks") !== null || filter === null || !Td;
  const ends: [string, string] = ["more noise", "less noise"];
  if (byLimit) {
    const Mks = numberAt(tune, "Mks") ?? entry.robustness?.Mks ?? 1;
    return {
      id: "Mks",
      label: "Noise limit Mks",
      unit: quotient(units.u, units.y),
      lo: Mks / SPREAD,
      hi: Mks * 2,
      log: true,
      ends: ["less noise", "more noise"],
      value: Mks,
    };
  }
  const fixed = numberAt(tune, "filter.Tf");
  if (fixed !== null) {
    const about = { unit: units.time, lo: fixed / SPREAD, hi: fixed * SPREAD, value: fixed };
    return { id: "filter.Tf", label: "Noise filter Tf", log: true, ends, ...about, reached: filterTime };
  }
  const ratio = (made: Entry): number | null => {
    const Tf = filterTime(made);
    return Tf === null || !made.controller?.Td ? null : Tf / made.controller.Td;
  };
  const value = numberAt(tune, "filter.Tf_over_Td") ?? filter / Td;
  return { id: "filter.Tf_over_Td", label: "Noise filter Tf/Td", unit: "", lo: 0.02, hi: 1, log: true, ends, value, reached: ratio };
}

const filterTime = ({ controller }: Entry): number | null => controller?.filter?.Tf ?? null;

/** The overshoot of the loop that runs: in the user's own controller where the request names one. */
const overshootReached = ({ implemented, performance }: Entry): number | null =>
  given((implemented?.performance ?? performance)?.setpoint?.["overshoot_percent"]);

/** Sharpness of set-point steps, where the service has the option. */
function setpointKnob(tune: TuneEntry, { options }: Entry, method: Method | undefined): Knob[] {
  if (!method?.options?.properties?.["setpoint"]) return [];
  const weight = numberAt(tune, "setpoint.weight");
  return weight === null
    ? [
        {
          id: OVERSHOOT,
          label: "Set-point overshoot",
          unit: "%",
          lo: 0,
          hi: 40,
          step: 0.5,
          log: false,
          ends: ["soft", "sharp"],
          value: numberAt(tune, OVERSHOOT) ?? numberAt({ method: "", ...options }, OVERSHOOT),
          reached: overshootReached,
        },
      ]
    : [
        {
          id: "setpoint.weight",
          label: "Set-point weight b",
          unit: "",
          lo: 0,
          hi: 1,
          step: 0.01,
          log: false,
          ends: ["soft", "sharp"],
          value: weight,
        },
      ];
}

export const handValue = (controller: Controller, name: HandName): number | null =>
  (name === "Tf" ? controller.filter?.Tf : controller[name]) ?? null;

export function withHand(controller: Controller, name: HandName, value: number): Controller {
  return name === "Tf"
    ? { ...controller, filter: { type: controller.filter?.type ?? "none", Tf: value } }
    : { ...controller, [name]: value };
}

/** The settings that a controller has, each about the proposal's. */
export function handKnobs(controller: Controller, units: UnitNames): Knob[] {
  return HAND.flatMap((name) => {
    const value = handValue(controller, name);
    if (value === null || value === 0) return [];
    const unit = name === "Kp" ? quotient(units.u, units.y) : units.time;
    return [{ id: name, label: name, unit, lo: value / SPREAD, hi: value * SPREAD, log: true, value }];
  });
}
