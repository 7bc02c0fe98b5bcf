// Conversion of the form of a check to a request, and back.
import type { CheckLoop, CheckRequest, FieldError, RecordedTest } from "../api/types.ts";
import { parseNumber } from "../form/number.ts";
import { KINDS } from "../words/check.ts";
import type { Kind } from "../words/check.ts";

/** A loop as the form shows it. */
export interface LoopTexts {
  tag: string;
  kind: Kind;
  averaging: boolean;
  /** The ends of the output's range. */
  low: string;
  high: string;
  weight: string;
  /** Of measurement and output, as its file names them; undefined: its file was not read yet. */
  units?: { y: string; u: string } | undefined;
  /** The name of its file; "" if it came with a request. */
  file: string;
  /** The loop as it came: its record, and members that no field shows. */
  given: CheckLoop;
}

/** How all files are read, by the names of the contract; "": as the service finds it. */
export interface Reading {
  columns: Record<string, string>;
  timeUnit: string;
}

export interface CheckTexts {
  name: string;
  cluster: boolean;
  reading: Reading;
  loops: LoopTexts[];
  /** Members that no field shows. */
  base: Partial<CheckRequest>;
}

/** Many loops take longer than one design, for which the service's own time limit is made. */
const TIMEOUT_S = 1800;

/** The ISA-5.1 letter of the measured quantity: "TIC-101", "2111FIC41004", "U7.LC3". Undefined letters: not given. */
export function kindOfTag(tag: string): Kind {
  const letters = /(?:^|[^A-Za-z])([FPLTA])[DFRYIQ]{0,2}C[A-Z]{0,2}(?=[^A-Za-z]|$)/.exec(tag.toUpperCase())?.[1] ?? "";
  const kinds: Record<string, Kind> = { F: "flow", P: "pressure", L: "level", T: "temperature", A: "composition" };
  return kinds[letters] ?? "unknown";
}

export const tagOfFile = (name: string): string => name.replace(/\.[A-Za-z]{1,5}$/, "");

/** A loop of a new file. */
export function loopOfFile(name: string, csv: string): LoopTexts {
  const tag = tagOfFile(name);
  return { tag, kind: kindOfTag(tag), averaging: false, low: "", high: "", weight: "", file: name, given: { csv } };
}

export const NO_LOOPS = "There is no loop yet. Drop CSV files here, or choose them.";

const given = (text: string): boolean => text.trim() !== "";

/** A number of a loop, or the fault of its text. */
function number(text: string, label: string, pointer: string, errors: FieldError[]): number | undefined {
  if (!given(text)) return undefined;
  const parsed = parseNumber(text, label);
  if (parsed.ok) return parsed.value;
  errors.push({ pointer, detail: parsed.sentence });
  return undefined;
}

/** The range of the output; undefined: the service's own. */
function outputRange({ low, high }: LoopTexts, pointer: string, errors: FieldError[]): [number, number] | undefined {
  const before = errors.length;
  const from = number(low, "From", `${pointer}/low`, errors);
  const to = number(high, "To", `${pointer}/high`, errors);
  if (errors.length > before || (from === undefined && to === undefined)) return undefined;
  if (from !== undefined && to !== undefined && from < to) return [from, to];
  const detail =
    from === undefined || to === undefined
      ? `The range of the output has one end only; write both, such as 0 and 100.`
      : `The range of the output is ${low.trim()} to ${high.trim()}; its first end must be below the second.`;
  errors.push({ pointer: `${pointer}/${from === undefined ? "low" : "high"}`, detail });
  return undefined;
}

function readLoop(texts: LoopTexts, index: number, reading: Reading, errors: FieldError[]): CheckLoop {
  const { kind: _kind, averaging: _averaging, weight: _weight, range, tag: _tag, ...kept } = texts.given;
  const pointer = `/loops/${index}`;
  const op = outputRange(texts, `${pointer}/range/op`, errors);
  const weight = number(texts.weight, "Weight", `${pointer}/weight`, errors);
  if (weight !== undefined && weight < 0)
    errors.push({ pointer: `${pointer}/weight`, detail: `Weight is ${texts.weight.trim()}; it must not be negative.` });
  const { op: _op, ...ranges } = range ?? {};
  const whole = { ...ranges, ...(op ? { op } : {}) };
  const columns = Object.fromEntries(Object.entries(reading.columns).filter(([, column]) => column !== ""));
  return {
    ...(given(texts.tag) ? { tag: texts.tag.trim() } : {}),
    ...(texts.kind === "unknown" ? {} : { kind: texts.kind }),
    ...(texts.averaging && texts.kind === "level" ? { averaging: true } : {}),
    ...(Object.keys(whole).length > 0 ? { range: whole } : {}),
    ...(weight === undefined ? {} : { weight }),
    ...kept,
    ...(kept.csv === undefined || Object.keys(columns).length === 0 ? {} : { columns: columns as RecordedTest["columns"] & object }),
    ...(kept.csv === undefined || reading.timeUnit === "" ? {} : { time_unit: reading.timeUnit }),
  };
}

/** What is sent: loops, or a file whose loops the service finds. */
export type CheckOrder = { kind: "loops"; request: CheckRequest } | { kind: "file"; csv: string; options: Record<string, string> };

/** A file with the columns of several loops, which are found by their tags. */
export function readFile(texts: CheckTexts): { order: CheckOrder; errors: FieldError[] } {
  const [first, ...others] = texts.loops;
  const { csv = "" } = first?.given ?? {};
  const detail = `${first?.file ?? ""} has the columns of several loops. Remove the other files, and check it alone.`;
  return {
    order: {
      kind: "file",
      csv,
      options: {
        name: given(texts.name) ? texts.name.trim() : (first?.tag ?? ""),
        ...(texts.reading.timeUnit === "" ? {} : { "units.time": texts.reading.timeUnit }),
      },
    },
    errors: others.length > 0 ? [{ pointer: "/loops/0/tag", detail }] : [],
  };
}

/** The loops of a request that is too long, each as a request of its own in a line. */
export function linesOf({ loops, name: _name, ...terms }: CheckRequest): string[] {
  return loops.map((loop) => `${JSON.stringify({ ...(loop.tag ? { name: loop.tag } : {}), ...terms, loops: [loop] })}\n`);
}

/** Units have one place in a request: those that all files name alike. */
function commonUnits(loops: readonly LoopTexts[]): Pick<CheckRequest, "units"> {
  const common = (["y", "u"] as const).flatMap((signal) => {
    const [unit = "", ...others] = new Set(loops.map(({ units }) => units?.[signal] ?? ""));
    return unit !== "" && others.length === 0 ? [[signal, unit] as const] : [];
  });
  return common.length > 0 ? { units: Object.fromEntries(common) } : {};
}

export function readCheck(texts: CheckTexts): { request: CheckRequest; errors: FieldError[] } {
  const errors: FieldError[] = [];
  const loops = texts.loops.map((loop, index) => readLoop(loop, index, texts.reading, errors));
  if (loops.length === 0) errors.push({ pointer: "/loops", detail: NO_LOOPS });
  const { name: _name, cluster: _cluster, loops: _loops, ...kept } = texts.base;
  const request: CheckRequest = {
    ...(given(texts.name) ? { name: texts.name.trim() } : {}),
    timeout_s: TIMEOUT_S,
    ...commonUnits(texts.loops),
    ...kept,
    ...(texts.cluster ? {} : { cluster: false }),
    loops,
  };
  return { request, errors };
}

const written = (value: number | undefined): string => (value === undefined ? "" : String(value));

function loopTexts(loop: CheckLoop): LoopTexts {
  const [low, high] = loop.range?.op ?? [];
  const kind = KINDS.some(([known]) => known === loop.kind) ? loop.kind! : "unknown";
  return {
    tag: loop.tag ?? "",
    kind,
    averaging: loop.averaging ?? false,
    low: written(low),
    high: written(high),
    weight: written(loop.weight),
    file: "",
    given: loop,
  };
}

export const textsOf = (request: CheckRequest): CheckTexts => ({
  name: request.name ?? "",
  cluster: request.cluster ?? true,
  reading: { columns: {}, timeUnit: "" },
  loops: request.loops.map(loopTexts),
  base: request,
});

/** The record of a loop, for Identify. */
export function recordOf({ record, csv, columns, time_unit }: CheckLoop): RecordedTest {
  if (record) return record;
  return { ...(csv === undefined ? {} : { csv }), ...(columns ? { columns } : {}), ...(time_unit ? { time_unit } : {}) };
}
