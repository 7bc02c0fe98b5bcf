// Conversion of the form of a range to a request, and back. No DOM.
import type { Along, RangePoint, RangeRequest } from "../api/range.ts";
import type { FieldError, Plant, RecordedTest, Units } from "../api/types.ts";
import { parseNumber } from "../form/number.ts";
import { plainSetting } from "../words/numbers.ts";

/** One point as typed. A plant that was not changed, and a record, are sent unchanged. */
export interface PointTexts {
  at: string;
  text: string;
  given?: { text: string; plant: Plant | string };
  record?: RecordedTest;
  /** For a record: the file's name. */
  file?: string;
}

export interface TermTexts {
  controller: string;
  Ms: string;
  Mt: string;
  interpolation: string;
  /** "": the smallest number. */
  rows: string;
  /** In percent. */
  allowance: string;
  identified: boolean;
}

export interface WayTexts {
  along: Along;
  parameter: string;
  from: string;
  to: string;
  holdOutput: boolean;
}

export interface RangeTexts {
  mode: "points" | "equations";
  name: string;
  scheduling: { name: string; unit: string };
  units: Record<keyof Units, string>;
  points: PointTexts[];
  way: WayTexts;
  terms: TermTexts;
  /** Members without a field here: sent unchanged. */
  rest: RangeRequest;
}

/** Parts that other fields have read: equations, and options for reading records. */
export interface ReadParts {
  equations: { plant: Plant; errors: FieldError[] };
  records: { record: RecordedTest; identify: Record<string, unknown>; errors: FieldError[] };
}

type Faults = FieldError[];

function numberOf(text: string, name: string, pointer: string, faults: Faults): number {
  const parsed = parseNumber(text, name);
  if (!parsed.ok) faults.push({ pointer, detail: parsed.sentence });
  return parsed.ok ? parsed.value : NaN;
}

const named = <T extends Record<string, string>>(texts: T): Partial<T> =>
  Object.fromEntries(
    Object.entries(texts)
      .filter(([, text]) => text.trim() !== "")
      .map(([key, text]) => [key, text.trim()]),
  ) as Partial<T>;

/** If the text was changed, only the text counts. */
function plantOf(point: PointTexts): Plant | string {
  return point.given && point.given.text === point.text ? point.given.plant : point.text.trim();
}

function readPoints(texts: RangeTexts, records: ReadParts["records"], faults: Faults): RangePoint[] {
  return texts.points.map((point, row) => {
    const pointer = `/points/${row}`;
    const at = numberOf(point.at, `The ${texts.scheduling.name || "place"} of row ${row + 1}`, `${pointer}/at`, faults);
    if (point.record) return { at, record: { ...point.record, ...records.record } };
    if (point.text.trim() === "")
      faults.push({
        pointer: `${pointer}/plant`,
        detail: `Row ${row + 1} has no plant. Write one, for example K=2 T=12 L=3.`,
      });
    return { at, plant: plantOf(point) };
  });
}

function readWay(texts: WayTexts, faults: Faults): NonNullable<RangeRequest["range"]> {
  const moved = texts.along === "parameter";
  if (moved && texts.parameter.trim() === "")
    faults.push({ pointer: "/range/parameter", detail: "Name the parameter that is moved." });
  return {
    along: texts.along,
    ...(moved ? { parameter: texts.parameter.trim(), hold_output: texts.holdOutput } : {}),
    from: numberOf(texts.from, "From", "/range/from", faults),
    to: numberOf(texts.to, "To", "/range/to", faults),
  };
}

function readTerms(texts: TermTexts, faults: Faults): NonNullable<RangeRequest["schedule"]> {
  const rows = texts.rows.trim();
  const limit = (name: "Ms" | "Mt") =>
    texts[name].trim() === "" ? {} : { [name]: numberOf(texts[name], name, `/schedule/${name}`, faults) };
  return {
    controller: texts.controller,
    ...limit("Ms"),
    ...limit("Mt"),
    interpolation: texts.interpolation,
    allowance: Number(
      (numberOf(texts.allowance, "The allowance", "/schedule/allowance", faults) / 100).toPrecision(12),
    ),
    ...(rows === "" ? {} : { rows: numberOf(rows, "The number of rows", "/schedule/rows", faults) }),
  };
}

export function readRange(texts: RangeTexts, parts: ReadParts): { request: RangeRequest; errors: FieldError[] } {
  const errors: FieldError[] = [];
  const units = named(texts.units);
  const scheduling = named(texts.scheduling);
  const withRecords = texts.mode === "points" && texts.points.some((point) => point.record);
  const { schedule: kept, ...rest } = texts.rest;
  const request: RangeRequest = {
    ...rest,
    ...(texts.name.trim() ? { name: texts.name.trim() } : {}),
    ...(Object.keys(units).length > 0 ? { units } : {}),
    ...(Object.keys(scheduling).length > 0 ? { scheduling } : {}),
  };
  if (texts.mode === "points") {
    if (withRecords) errors.push(...parts.records.errors);
    request.points = readPoints(texts, parts.records, errors);
  } else {
    errors.push(...parts.equations.errors);
    request.plant = parts.equations.plant;
    request.range = readWay(texts.way, errors);
  }
  if (withRecords) request.identify = parts.records.identify;
  // Sent in both cases: the service has a default of its own.
  if (withRecords) request.uncertainty = texts.terms.identified ? "identified" : "none";
  request.schedule = { ...kept, ...readTerms(texts.terms, errors) };
  return { request, errors };
}

/** A plant as typed; "" if only the service can write it. */
export function plantText(plant: Plant | string | undefined): string {
  if (typeof plant === "string") return plant;
  if (plant?.type !== "fopdt" || Object.keys(plant).some((key) => !["type", "K", "T", "L"].includes(key))) return "";
  return ["K", "T", "L"]
    .flatMap((name) => (typeof plant[name] === "number" ? [`${name}=${plant[name] as number}`] : []))
    .join(" ");
}

function pointTexts({ at, plant, record }: RangePoint, index: number): PointTexts {
  if (record) return { at: String(at), text: "", record, file: `record ${index + 1}` };
  const text = plantText(plant);
  return { at: String(at), text, ...(plant === undefined ? {} : { given: { text, plant } }) };
}

export const EMPTY_POINTS: PointTexts[] = [
  { at: "", text: "" },
  { at: "", text: "" },
];

const written = (value: unknown, fallback: string): string =>
  typeof value === "number" ? plainSetting(value) : typeof value === "string" ? value : fallback;

/** The texts that show a request; given rows of a schedule are not part of a design. */
export function textsOf(request: RangeRequest): RangeTexts {
  const {
    name,
    units,
    scheduling,
    points,
    plant: _plant,
    range,
    identify: _identify,
    uncertainty,
    schedule,
    ...rest
  } = request;
  const { controller, Ms, Mt, interpolation, allowance, rows, given: _given, ...kept } = schedule ?? {};
  const share = typeof allowance === "number" ? allowance : 0.05;
  // The terms on which a job is run are not part of this form.
  const { notify: _notify, priority: _priority, timeout_s: _timeout, runs: _runs, ...others } = rest;
  return {
    mode: range ? "equations" : "points",
    name: name ?? "",
    scheduling: { name: scheduling?.name ?? "", unit: scheduling?.unit ?? "" },
    units: { time: units?.time ?? "", u: units?.u ?? "", y: units?.y ?? "" },
    points: points?.map(pointTexts) ?? EMPTY_POINTS,
    way: {
      along: range?.along ?? "output",
      parameter: range?.parameter ?? "",
      from: written(range?.from, ""),
      to: written(range?.to, ""),
      holdOutput: range?.hold_output !== false,
    },
    terms: {
      controller: controller ?? "PID",
      Ms: written(Ms, ""),
      Mt: written(Mt, ""),
      interpolation: interpolation ?? "linear_in_gains",
      rows: written(rows, ""),
      allowance: plainSetting(100 * share),
      identified: uncertainty !== "none",
    },
    rest: { ...others, ...(Object.keys(kept).length > 0 ? { schedule: kept } : {}) },
  };
}

/** All records share one set of fields for reading them: a fault of a record's column is shown there. */
export function atSharedFields(errors: FieldError[]): FieldError[] {
  return errors.map(({ pointer, detail }) => {
    const [, row, below] = /^\/points\/(\d+)\/record\/(columns.*|time_unit|dt|kind)$/.exec(pointer) ?? [];
    return row === undefined
      ? { pointer, detail }
      : { pointer: `/record/${below}`, detail: `Row ${Number(row) + 1}: ${detail}` };
  });
}
