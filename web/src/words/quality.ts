// "Was the test good enough?": the service's findings about the record, in words. Figures that the page does not know
// are shown by their names.
import type { Model, Notice, Plant } from "../api/types.ts";
import { figureUnit } from "./figure_units.ts";
import type { MeasuredType } from "./figure_units.ts";
import { formatNumber, formatParameter, withUnit } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";
import { plantWords } from "./plant.ts";

export type Level = "good" | "warn" | "bad";

export interface QualityWords {
  level: Level;
  head: string;
  /** The moves of u. */
  input: string;
  rows: [name: string, text: string][];
  notes: string[];
  warnings: Notice[];
}

const LEVELS: Record<NonNullable<Model["grade"]>, Level> = { good: "good", usable: "warn", doubtful: "bad" };

export function qualityOf(model: Model, units: UnitNames): QualityWords {
  const warnings = model.warnings ?? [];
  const notes = listOf(model.data_quality?.["notes"]);
  const level = LEVELS[model.grade ?? "good"];
  return {
    level,
    head: headOf(model, level, warnings.length, notes.length),
    input: inputWords(model, units),
    rows: rowsOf(model, units),
    notes,
    warnings,
  };
}

function headOf(model: Model, level: Level, warnings: number, notes: number): string {
  if (level === "bad" && model.grade_reason === "warning") return `A doubtful model: ${counted(warnings, "warning")}.`;
  if (level === "bad")
    return `A doubtful model: it explains ${formatNumber(model.fit_percent)} % of the record's movement${warnings > 0 ? `; ${counted(warnings, "warning")}` : ""}.`;
  if (level === "warn") return `Usable with care: ${counted(warnings, "warning")}.`;
  return notes > 0 ? `Good enough, with ${counted(notes, "remark")}.` : "Good enough.";
}

/** A question about the unit of the record's times, if it may be another one: every time and gain of the answer
    depends on it. "" if it is named. */
export function timeUnitDoubt(model: Model): string {
  const doubtful = model.warnings?.find((warning) => warning.code === "time-unit-doubtful");
  if (doubtful) return doubtful.detail;
  if (model.data_quality?.["time_unit_assumed"] !== true) return "";
  return "The unit of the record's times is not given: seconds are assumed. If they are milliseconds, every time here is a thousand times too long.";
}

const counted = (count: number, name: string): string => `${count} ${name}${count === 1 ? "" : "s"}`;

const listOf = (value: unknown): string[] =>
  Array.isArray(value) ? value.filter((item): item is string => typeof item === "string") : [];

function rowsOf(model: Model, units: UnitNames): [string, string][] {
  const quality: Record<string, unknown> = model.data_quality ?? {};
  const rows: [string, string][] = [];
  const number = (name: string): number | null =>
    typeof quality[name] === "number" && Number.isFinite(quality[name]) ? quality[name] : null;
  const samples = number("samples");
  const dropped = number("samples_dropped");
  if (samples !== null) rows.push(["Samples", `${samples}${dropped ? `, ${dropped} left out` : ""}`]);
  const spacing = number("sample_time");
  if (spacing !== null)
    rows.push([
      withUnit("Spacing", units.time),
      `${formatParameter(spacing)}${quality["irregular"] === true ? ", irregular" : ""}`,
    ]);
  const noise = number("noise_std");
  if (noise !== null) rows.push([withUnit("Noise of y", units.y), noise === 0 ? "none" : noiseWords(noise, model)]);
  const grid = number("quantisation");
  if (grid !== null)
    rows.push([withUnit("Smallest step of y", units.y), grid === 0 ? "none found" : formatNumber(grid)]);
  const steps = number("steps");
  const test = testWords(model);
  if (test !== "") rows.unshift(["Test", test]);
  if (steps !== null) rows.push(["Moves of u", String(steps)]);
  if (typeof quality["settled"] === "boolean") rows.push(["y came to rest", quality["settled"] ? "yes" : "no"]);
  for (const { name, plant, share } of model.disturbances ?? []) rows.push([name, disturbanceWords(plant, share, units)]);
  const known = new Set([
    "samples",
    "samples_dropped",
    "sample_time",
    "irregular",
    "noise_std",
    "quantisation",
    "kind",
    "test",
    "steps",
    "move_times",
    "settled",
    "notes",
    "time_unit_assumed",
    "why_null",
  ]);
  for (const [name, value] of Object.entries(quality)) if (!known.has(name)) rows.push(...otherRows(name, value, figureUnit("DataQuality", name, units), units));
  return rows;
}

/** "K 1.5, T 25 s, L 8 s; 49 % of the movement of y": its own unit is not known. */
function disturbanceWords(plant: Plant, share: number | null, units: UnitNames): string {
  const part = share === null ? "" : `; ${formatNumber(100 * share, 2)} % of the movement of y`;
  return `${plantWords(plant, { ...units, u: "", y: "" })}${part}`;
}

function noiseWords(noise: number, model: Model): string {
  const values = (model.fit?.y ?? []).filter((value): value is number => typeof value === "number");
  const movement = values.length > 0 ? maximum(values) - minimum(values) : 0;
  return movement > 0
    ? `${formatNumber(noise, 2)}, ${formatNumber((100 * noise) / movement, 2)} %`
    : formatNumber(noise, 2);
}

/** The types of parts of the quality. */
const PARTS: Record<string, MeasuredType> = { pretest: "PreTest", gaps: "MissingPart", missing: "MissingPart" };

const isNumbers = (value: unknown): value is number[] => Array.isArray(value) && value.every((item) => typeof item === "number");

/** A figure without words of its own here, under its name in the contract. */
function otherRows(name: string, value: unknown, unit: string, units: UnitNames): [string, string][] {
  const label = withUnit(name.charAt(0).toUpperCase() + name.slice(1).replaceAll("_", " "), unit);
  if (typeof value === "number") return [[label, formatParameter(value)]];
  if (typeof value === "boolean") return [[label, value ? "yes" : "no"]];
  if (typeof value === "string" && value !== "") return [[label, value.replaceAll("_", " ")]];
  if (isNumbers(value) && value.length === 2) return [[label, value.map(formatParameter).join(" to ")]];
  if (Array.isArray(value)) {
    const texts = listOf(value);
    return value.length === 0 ? [] : [[label, texts.length === value.length ? texts.join(", ") : String(value.length)]];
  }
  if (typeof value === "object" && value !== null) {
    const type = PARTS[name];
    return Object.entries(value).flatMap(([inner, item]) =>
      inner === "why_null" ? [] : otherRows(`${name} ${inner}`, item, type ? figureUnit(type, inner, units) : "", units),
    );
  }
  return [];
}

/** The test in words: "one step of the set point, in automatic". */
const testWords = (model: Model): string => String(model.data_quality?.["test"] ?? "");

/** "u steps once, at 120 s, from 30 to 35 %." */
function inputWords(model: Model, units: UnitNames): string {
  const { t = [], u = [] } = model.fit ?? {};
  const values = u.filter((value): value is number => typeof value === "number");
  if (values.length === 0) return "";
  const unit = units.u ? ` ${units.u}` : "";
  const range = `from ${formatParameter(minimum(values))} to ${formatParameter(maximum(values))}${unit}`;
  const { steps, move_times = [], closed_loop } = model.data_quality ?? {};
  const test = testWords(model);
  if (closed_loop) return `${test.charAt(0).toUpperCase()}${test.slice(1)}: the controller moved u ${range}.`;
  if (steps === 0 || (steps === 1 && move_times[0]! <= t[0]!)) return `u is constant at ${formatParameter(values[0]!)}${unit} from the first sample on.`;
  if (steps !== 1) return `u changes${steps === undefined ? "" : ` ${steps} times`}, ${range}.`;
  const at = move_times.length === 1 ? `, at ${formatParameter(move_times[0]!)} ${units.time}` : "";
  return `u steps once${at}, from ${formatParameter(values[0]!)} to ${formatParameter(values[values.length - 1]!)}${unit}.`;
}

// Math.min(...list) overflows the stack with long lists.
const minimum = (values: number[]): number => values.reduce((min, value) => (value < min ? value : min));
const maximum = (values: number[]): number => values.reduce((max, value) => (value > max ? value : max));
