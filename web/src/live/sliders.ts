// The sliders of a design: the options for which its method describes one, and the settings themselves.
import type { Controller, Entry, Method, OptionSlider, Schema, TuneEntry } from "../api/types.ts";
import type { UnitNames } from "../words/numbers.ts";
import { namedUnit, quotient } from "../words/numbers.ts";
import { running } from "../words/running.ts";

export interface SliderSpec {
  /** Its option with dots between the parts, or the setting's name; also used in the address. */
  id: string;
  label: string;
  unit: string;
  lo: number;
  hi: number;
  /** Even steps of the logarithm. */
  log: boolean;
  /** The step of an arrow key; 1 % if it is logarithmic. */
  step?: number;
  /** The meaning of its ends. */
  ends?: [string, string];
  /** Null: the method's own choice, which it does not state. */
  value: number | null;
  /** The method's description of the option's values. */
  schema?: Schema;
  /** Options that have the same value as long as they are tied to it. */
  along?: readonly string[];
  /** The value of this quantity that a design reached: less or more than requested. */
  reached?(entry: Entry): number | null;
  /** It limits that quantity, and nothing as long as it has no value. */
  limit?: boolean;
  /** Its name. */
  figure?: OptionSlider["value_of"];
}

export type ManualName = "Kp" | "Ti" | "Td" | "Tf";
export const MANUAL: readonly ManualName[] = ["Kp", "Ti", "Td", "Tf"];

/** Settings by hand range from this part to this multiple of the value. */
const SPREAD = 5;

/** The reason why a typed value cannot be requested; "" if it can. */
export function wrongValue({ label, schema }: SliderSpec, value: number): string {
  const { minimum, exclusiveMinimum, maximum, exclusiveMaximum } = schema ?? {};
  const rules = [
    minimum !== undefined && value < minimum ? `at least ${minimum}` : "",
    exclusiveMinimum !== undefined && value <= exclusiveMinimum ? `above ${exclusiveMinimum}` : "",
    maximum !== undefined && value > maximum ? `at most ${maximum}` : "",
    exclusiveMaximum !== undefined && value >= exclusiveMaximum ? `below ${exclusiveMaximum}` : "",
  ].filter(Boolean);
  return rules.length > 0 ? `${label} is ${value}; it must be ${rules.join(" and ")}.` : "";
}

const at = (whole: unknown, id: string): number | null => {
  const value = id.split(".").reduce<unknown>((part, name) => (part as Record<string, unknown> | undefined)?.[name], whole);
  return typeof value === "number" ? value : null;
};

interface Movable {
  id: string;
  schema: Schema;
  slider: OptionSlider;
}

/** The options with a slider, including parts of an option. */
const movable = (properties: Record<string, Schema> | undefined, prefix = ""): Movable[] =>
  Object.entries(properties ?? {}).flatMap(([name, schema]) => [
    ...(schema["x-slider"] ? [{ id: prefix + name, schema, slider: schema["x-slider"] }] : []),
    ...movable(schema.properties, `${prefix}${name}.`),
  ]);

/** The requested value, else the method's default. */
const askedOf = (tune: TuneEntry, { id, schema }: Movable): number | null => at(tune, id) ?? given(schema.default);

/** True if the options that may move together with another one have its value. */
export function isTied(tune: TuneEntry, method: Method | undefined): boolean {
  const options = movable(method?.options?.properties);
  return options.every((option) => {
    const other = options.find(({ id }) => id === option.slider.moves_with);
    return !other || askedOf(tune, option) === askedOf(tune, other);
  });
}

/** The same options with one of them changed, and those in `along` with it; parts of an option that exclude each other
 * are replaced. */
export function withOption(tune: TuneEntry, id: string, value: number, along: readonly string[] = []): TuneEntry {
  const [name = id, part] = id.split(".");
  const next: TuneEntry = { ...tune, [name]: part ? { [part]: value } : value };
  return along.reduce((made, other) => ({ ...made, [other]: value }), next);
}

const filterTime = ({ controller }: Entry): number | null => controller?.filter?.Tf ?? null;

/** The place of a design's figures. The overshoot is that of the implemented loop if the request names the user's own
 * controller. */
const FIGURES: Record<NonNullable<OptionSlider["value_of"]>, (entry: Entry) => number | null> = {
  Mks: ({ robustness }) => robustness?.Mks ?? null,
  Tf: filterTime,
  Tf_over_Td: (entry) => (entry.controller?.Td ? quotientOf(filterTime(entry), entry.controller.Td) : null),
  overshoot_percent: (entry) => given(running(entry).performance?.setpoint?.["overshoot_percent"]),
};

const quotientOf = (a: number | null, b: number): number | null => (a === null ? null : a / b);

/** `tied`: without those that move together with another one. */
export function optionSliders(tune: TuneEntry, entry: Entry, method: Method | undefined, units: UnitNames, tied = isTied(tune, method)): SliderSpec[] {
  const options = movable(method?.options?.properties);
  const valueOf = (option: Movable): number | null =>
    at(tune, option.id) ??
    at(entry.options, option.id) ??
    given(option.schema.default) ??
    (option.slider.value_of ? FIGURES[option.slider.value_of](entry) : null);
  const chosen = (option: Movable): boolean => {
    const group = options.filter(({ slider }) => slider.group === option.slider.group);
    const known = [...group].reverse().find((other) => valueOf(other) !== null);
    const last = group.at(-1)?.slider.value_of ? undefined : group.at(-1);
    const one = group.find(({ id }) => at(tune, id) !== null) ?? known ?? last;
    return !option.slider.group || option === one;
  };
  return options.filter((option) => chosen(option) && !(tied && option.slider.moves_with)).flatMap((option) => {
    const { id, schema, slider } = option;
    const value = valueOf(option);
    const ends = endsOf(schema, slider, value ?? (slider.reached ? FIGURES[slider.reached](entry) : null), entry);
    const along = options.flatMap((other) => (other.slider.moves_with === id ? [other.id] : []));
    const { label, low, high, step, reached } = slider;
    return ends
      ? [
          {
            id,
            label: label ?? nameOf(id),
            unit: namedUnit(schema["x-unit"] ?? "", units),
            ...ends,
            log: slider.logarithmic ?? false,
            ...(step === undefined ? {} : { step }),
            ...(low && high ? { ends: [low, high] as [string, string] } : {}),
            value,
            schema: numberSchema(schema),
            along,
            ...(reached ? { reached: FIGURES[reached], figure: reached } : {}),
            ...(reached && !slider.value_of && !slider.group ? { limit: true } : {}),
          },
        ]
      : [];
  });
}

const given = (value: unknown): number | null => (typeof value === "number" ? value : null);
/** Words in full, symbols unchanged. */
const nameOf = (name: string): string => (name.length < SYMBOL_LENGTH ? name : name.replaceAll("_", " ").replace(/ deg$/, ""));
const SYMBOL_LENGTH = 7;

/** The number schema of an option that may be a number. */
const numberSchema = (schema: Schema): Schema => schema.oneOf?.find((item) => item.type === "number") ?? schema;

/** Relative ends around the value, else around the loop's own time. */
function endsOf(schema: Schema, { from, to, relative }: OptionSlider, value: number | null, entry: Entry): Pick<SliderSpec, "lo" | "hi"> | null {
  if (!relative) return { lo: from, hi: to };
  const crossover = entry.robustness?.gain_crossover;
  const about = value ?? (schema["x-unit"] === "time" && crossover ? 1 / crossover : null);
  return about ? { lo: about * from, hi: about * to } : null;
}

export const manualValue = (controller: Controller, name: ManualName): number | null =>
  (name === "Tf" ? controller.filter?.Tf : controller[name]) ?? null;

export function withManual(controller: Controller, name: ManualName, value: number): Controller {
  return name === "Tf"
    ? { ...controller, filter: { type: controller.filter?.type ?? "none", Tf: value } }
    : { ...controller, [name]: value };
}

/** The settings of a controller, with ranges around the proposal's. */
export function manualSliders(controller: Controller, units: UnitNames): SliderSpec[] {
  return MANUAL.flatMap((name) => {
    const value = manualValue(controller, name);
    if (value === null || value === 0) return [];
    const unit = name === "Kp" ? quotient(units.u, units.y) : units.time;
    return [{ id: name, label: name, unit, lo: value / SPREAD, hi: value * SPREAD, log: true, value }];
  });
}
