// The check of loops in operation in words: causes, actions, owners, and the figures of a loop.
import type { CheckLoop, ListedLoop, LoopChange, LoopCheck, LoopRank } from "../api/types.ts";
import type { ExplainedName } from "./explained.ts";
import { figureUnit } from "./figure_units.ts";
import type { MeasuredType } from "./figure_units.ts";
import { DASH, formatNumber, formatShare, formatUncertain } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

export type Verdict = LoopCheck["cause"]["verdict"];
export type Confidence = LoopCheck["cause"]["confidence"];
export type ActionCode = LoopCheck["action"]["code"];
export type Owner = LoopCheck["action"]["owner"];
export type Kind = NonNullable<CheckLoop["kind"]>;

const VERDICTS: Record<Verdict, string> = {
  stiction: "Sticking valve",
  backlash: "Backlash",
  tight: "Tuned too tight",
  sluggish: "Tuned too slow",
  external: "Disturbed from outside",
  saturation: "Output at its limit",
  quantised: "Coarse measurement",
  manual: "In manual",
  frozen: "Frozen measurement",
  undetermined: "Cause not found",
  "insufficient-data": "Record not sufficient",
  healthy: "Healthy",
};

const CONFIDENCES: Record<Confidence, string> = { sure: "sure", likely: "likely", open: "open" };

const ACTIONS: Record<ActionCode, string> = {
  none: "nothing",
  retune: "tune",
  "repair-valve": "repair the valve",
  "find-source": "find the source",
  "return-to-automatic": "return to automatic",
  "check-range": "look at the limit",
  "check-transmitter": "check the transmitter",
  "record-again": "record again",
  test: "make a test",
};

const OWNERS: Record<Owner, string> = {
  nobody: DASH,
  control: "control",
  instruments: "instruments",
  process: "process",
  operations: "operations",
};

const EFFORTS = ["none", "settings", "a test", "work on the plant"] as const;

export const KINDS: readonly (readonly [Kind, string])[] = [
  ["unknown", "not given"],
  ["flow", "flow"],
  ["pressure", "pressure"],
  ["level", "level"],
  ["temperature", "temperature"],
  ["composition", "composition"],
];

/** A code that is newer than the page is shown as it is. */
const named = (words: Readonly<Record<string, string>>, code: string): string => words[code] ?? code.replaceAll("-", " ");

export const verdictWords = (verdict: string): string => named(VERDICTS, verdict);
export const confidenceWords = (confidence: string): string => named(CONFIDENCES, confidence);
export const actionWords = (action: string): string => named(ACTIONS, action);
export const ownerWords = (owner: string): string => named(OWNERS, owner);
export const effortWords = (effort: number): string => EFFORTS[effort] ?? DASH;

/** Verdicts in the order of their list above; newer ones last. */
export const verdictOrder = (verdict: string): number => {
  const at = Object.keys(VERDICTS).indexOf(verdict);
  return at < 0 ? Object.keys(VERDICTS).length : at;
};

/** Whether chance explains a change of the error. */
export const significance = (change: LoopChange | undefined): string => (!change || change.likelihood === null ? DASH : change.significant ? "yes" : "no");

/** What has changed in a loop since an earlier check. */
export function changeWords(change: LoopChange): string {
  const { before, now, variability_ratio: ratio, significant, why_null } = change;
  const cause = before === now ? "The cause was the same." : `The cause was: ${verdictWords(before)}.`;
  if (ratio === null) return `${cause} ${why_null?.["variability_ratio"] ?? ""}`.trim();
  return `${cause} The standard deviation of the error is ${formatNumber(ratio)} times that of then; ${significant ? "chance does not explain this" : "chance may explain this"}.`;
}

/** The colour of a verdict: "open" has none. Text and shape say the same. */
export type Tone = "good" | "bad" | "open";

export const toneOf = ({ verdict, confidence }: Pick<LoopCheck["cause"], "verdict" | "confidence">): Tone =>
  verdict === "healthy" ? "good" : confidence === "open" ? "open" : "bad";

/** A share that is an estimate, in percent without decimals. */
export const estimate = (share: number): string => String(Math.round(100 * share));

const SECONDS: Readonly<Record<string, number>> = { ms: 0.001, s: 1, min: 60, h: 3600, d: 86_400 };

/** In a unit of time of a request. */
export const secondsPer = (unit: string | undefined): number => SECONDS[unit ?? "s"] ?? 1;

const SCALES = [
  ["h", 3600],
  ["min", 60],
] as const;

/** "155 s", "12.4 min", "3.20 h": seconds in the unit in which they are read best. */
export function timeWords(seconds: number): string {
  const [unit, size] = SCALES.find(([, length]) => seconds >= 5 * length) ?? ["s", 1];
  return `${formatNumber(seconds / size)} ${unit}`;
}

/** A figure of a loop: its label, its text with its unit, and the reason if there is none. */
export interface LoopFigure {
  label: string;
  about: ExplainedName | null;
  text: string;
  why: string;
}

export interface LoopFigures {
  title: string;
  rows: LoopFigure[];
}

type Value = number | null | undefined;

/** Rows of one part of the answer. */
class Rows {
  readonly rows: LoopFigure[] = [];

  constructor(
    private readonly units: UnitNames,
    private readonly type: MeasuredType | null,
    private readonly why: Record<string, string> | undefined,
  ) {}

  add(label: string, about: ExplainedName | null, name: string, value: Value, format = (given: number) => formatNumber(given), unit = this.unitOf(name)): this {
    const known = typeof value === "number" && Number.isFinite(value);
    const text = known ? `${format(value)}${unit ? ` ${unit}` : ""}` : DASH;
    this.rows.push({ label, about, text, why: known ? "" : (this.why?.[name] ?? "") });
    return this;
  }

  private unitOf(name: string): string {
    return this.type ? figureUnit(this.type, name, this.units) : "";
  }
}

const share = (value: number): string => formatShare(value);

function performanceRows({ performance }: ListedLoop, units: UnitNames): LoopFigure[] {
  const { harris, why_null } = performance;
  const time = units.time;
  const harrisText = harris ? `${formatNumber(harris.low, 2)} to ${formatNumber(harris.high, 2)}` : DASH;
  const delays = harris ? `, dead time ${harris.delays.map((delay) => formatNumber(delay)).join(" to ")} ${time}` : "";
  return [
    ...new Rows(units, "LoopPerformance", why_null)
      .add("Mean error", "mean_error", "mean_error", performance.mean_error)
      .add("Standard deviation", "variability", "variability", performance.variability)
      .add("Standard deviation over the range", "variability", "variability_share", performance.variability_share ?? null, share, "%").rows,
    { label: "Harris range", about: "harris", text: harrisText + delays, why: harris ? "" : (why_null?.["harris"] ?? "") },
    ...new Rows(units, "LoopPerformance", why_null)
      .add("Idle index", "idle_index", "idle_index", performance.idle_index, (value) => formatNumber(value, 2))
      .add("Following", "following", "following", performance.following)
      .add("Travel of the output", "travel", "travel", performance.travel, undefined, "ranges/h")
      .add("Reversals of the output", "reversals", "reversals", performance.reversals, undefined, "1/h").rows,
  ];
}

function serviceRows({ service }: ListedLoop, units: UnitNames): LoopFigure[] {
  return new Rows(units, null, service.why_null)
    .add("In automatic", "in_automatic", "automatic", service.automatic, share, "%")
    .add("In manual", null, "manual", service.manual, share, "%")
    .add("Output at its lower limit", "at_limit", "saturated_low", service.saturated_low, share, "%")
    .add("Output at its upper limit", "at_limit", "saturated_high", service.saturated_high, share, "%")
    .add("Output at rest", "output_still", "output_still", service.output_still, share, "%")
    .add("Measurement at rest", "measurement_still", "measurement_still", service.measurement_still, share, "%").rows;
}

function recordRows({ quality }: ListedLoop, units: UnitNames): LoopFigure[] {
  const none = (value: number): string => (value === 0 ? "none found" : formatNumber(value));
  const step = (name: "y_step" | "u_step"): string => (quality[name] === 0 ? "" : figureUnit("CheckedRecord", name, units));
  return new Rows(units, "CheckedRecord", undefined)
    .add("Rows", null, "rows", quality.rows, String)
    .add("Duration", null, "duration", secondsPer(units.time) * quality.duration, timeWords, "")
    .add("Time between rows", null, "sample_time", quality.sample_time)
    .add("Rows without a measurement", null, "missing", quality.missing, share, "%")
    .add("Repeated measurements", "held", "held", quality.held, share, "%")
    .add("Longest gap", null, "longest_gap", quality.longest_gap)
    .add("Noise of the measurement", "noise", "noise", quality.noise)
    .add("Smallest step of the measurement", null, "y_step", quality.y_step, none, step("y_step"))
    .add("Smallest step of the output", null, "u_step", quality.u_step, none, step("u_step")).rows;
}

export const valveSizeName = (verdict: string): string => (verdict === "backlash" ? "Width of the backlash" : "Dead band and stick");

/** The valve and its cycle; without rows if the cause has none. */
function causeRows({ cause }: ListedLoop, units: UnitNames): LoopFigure[] {
  return new Rows(units, "LoopCause", cause.why_null)
    .add(valveSizeName(cause.verdict), "valve_size", "size", cause.size)
    .add("Jump when it breaks loose", "valve_jump", "jump", cause.jump)
    .add("Period of its cycle", null, "period", cause.period)
    .rows.filter(({ text }) => text !== DASH);
}

/** All figures of a loop except its oscillations. */
export const loopFigures = (loop: ListedLoop, units: UnitNames): LoopFigures[] =>
  [
    { title: "Cause", rows: causeRows(loop, units) },
    { title: "Error and output", rows: performanceRows(loop, units) },
    { title: "Service", rows: serviceRows(loop, units) },
    { title: "Record", rows: recordRows(loop, units) },
  ].filter(({ rows }) => rows.length > 0);

/** "155.5 ± 4.7": a period with its standard error. */
export const periodText = ({ period, period_error }: LoopCheck["oscillation"]["periods"][number]): string =>
  formatUncertain(period, period_error);

/** "38 %: 0.520 °C of a mean error of 1.36 °C"; "" if it is not known. */
export function gainWords(rank: LoopRank, loop: ListedLoop, units: UnitNames): string {
  if (typeof rank.share !== "number" || typeof rank.gain !== "number") return "";
  const unit = units.y ? ` ${units.y}` : "";
  return `${estimate(rank.share)} %: ${formatNumber(rank.gain)}${unit} of a mean error of ${formatNumber(loop.performance.mean_error)}${unit}`;
}
