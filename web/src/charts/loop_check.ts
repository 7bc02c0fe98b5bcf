// A checked loop: its record over time, the measurement against the output, the spectrum and the autocorrelation of
// its error.
import type { CheckCurve, LoopCheck, LoopTrend } from "../api/types.ts";
import type { Frame, Mark, Pane, Trace } from "../plot/frame.ts";
import { secondsPer, valveSizeName, verdictWords } from "../words/check.ts";
import { formatNumber, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { held } from "./record.ts";

/** Loops are drawn in a few pictures, which the loop's page shows by these keys. */
export interface LoopFrames {
  trend: Frame | null;
  excerpt: Frame | null;
  plane: Frame | null;
  spectrum: Frame | null;
  autocorrelation: Frame | null;
}

/** `other`: a loop whose record is drawn below, on the same time axis. */
export const loopFrames = (loop: LoopCheck, units: UnitNames, other: LoopCheck | null = null): LoopFrames => ({
  trend: trendFrame(loop, units, "trend", other),
  excerpt: trendFrame(loop, units, "excerpt", other),
  plane: planeFrame(loop, units),
  spectrum: spectrumFrame(loop, units),
  autocorrelation: autocorrelationFrame(loop, units),
});

const SPANS = {
  trend: { title: "Whole record", what: "the whole record, the extremes of even stretches", link: "whole-record" },
  excerpt: { title: "Last periods", what: "the last periods, row by row", link: "last-periods" },
} as const;

/** Longer labels do not fit next to a low pane. */
const LONGEST_LABEL = 16;

/** "FIC101 PV (%)"; without the tag if that is too long. */
function labelOf({ tag }: LoopCheck, name: string, unit: string): string {
  const whole = withUnit(`${tag} ${name}`, unit);
  return whole.length <= LONGEST_LABEL ? whole : withUnit(name, unit);
}

const measurementPane = (loop: LoopCheck, { t, y, r }: LoopTrend, units: UnitNames): Pane => ({
  y: { kind: "linear", label: labelOf(loop, "PV", units.y) },
  traces: [{ name: "measurement", look: "data", x: t, y }, ...(r ? [{ name: "set point", look: 2, ...held(t, r) } satisfies Trace] : [])],
  weight: 1.5,
});

/** Long records are read in hours. */
const LONG_S = 3 * 3600;

/** The unit of the time axis, and how many units of the record it has. */
function timeAxis({ trend: { t } }: LoopCheck, { time }: UnitNames): { unit: string; size: number } {
  const second = secondsPer(time);
  const isLong = second < 3600 && (t[t.length - 1]! - t[0]!) * second > LONG_S;
  return isLong ? { unit: "h", size: 3600 / second } : { unit: time, size: 1 };
}

const scaled = (trend: LoopTrend, size: number, shift = 0): LoopTrend => ({ ...trend, t: trend.t.map((at) => (at + shift) / size) });

/** When t = 0 was, in the unit of the times; 0 if the record has no date. */
const zeroOf = ({ shape, trend }: LoopCheck, units: UnitNames): number =>
  shape.dated ? shape.from / secondsPer(units.time) - (trend.t[0] ?? 0) : 0;

/** Measurement with set point over the output, and over the measurement of `other`; null without rows. */
export function trendFrame(loop: LoopCheck, units: UnitNames, span: "trend" | "excerpt", other: LoopCheck | null = null): Frame | null {
  const { title, what, link } = SPANS[span];
  if (loop[span].t.length < 2) return null;
  const { unit, size } = timeAxis(loop, units);
  const trend = scaled(loop[span], size);
  const { t, u } = trend;
  const below = other && scaled(other[span], size, loop.shape.dated && other.shape.dated ? zeroOf(other, units) - zeroOf(loop, units) : 0);
  return {
    title,
    description: `${loop.tag}, ${what}. ${verdictWords(loop.cause.verdict)}.${other ? ` Below: ${other.tag}, ${verdictWords(other.cause.verdict)}.` : ""}`,
    x: { kind: "linear", label: withUnit("time", unit), ...(below ? { range: [t[0]!, t[t.length - 1]!] } : {}) },
    panes: [
      measurementPane(loop, trend, units),
      {
        y: { kind: "linear", label: labelOf(loop, "OP", units.u) },
        // The samples of the whole record are extremes of the measurement, between which the output moves too: it is not held.
        traces: [{ name: "output", look: "data", ...(span === "trend" ? { x: t, y: u } : held(t, u)) }],
      },
      ...(other && below && below.t.length > 1 ? [measurementPane(other, below, units)] : []),
    ],
    // The picture below has the same lines.
    ownLegend: span === "trend",
    link,
    cursorLabel: withUnit("time", unit),
    cursorKind: "linear",
    fileName: link,
  };
}

/** The band in which the output moves and the valve does not, about the middle of the output. */
function valveBand({ cause, excerpt }: LoopCheck, units: UnitNames): Mark[] {
  const u = excerpt.u.filter((value): value is number => value !== null);
  if (!cause.size || u.length === 0) return [];
  const middle = (Math.min(...u) + Math.max(...u)) / 2;
  const label = `${valveSizeName(cause.verdict).toLowerCase()} ${formatNumber(cause.size)}${units.u ? ` ${units.u}` : ""}`;
  return [{ kind: "band", from: middle - cause.size / 2, to: middle + cause.size / 2, label }];
}

/** The path of the loop in the plane of output and measurement: a sticking valve draws a parallelogram there. */
function planeFrame(loop: LoopCheck, units: UnitNames): Frame | null {
  const { tag, excerpt } = loop;
  const { unit, size } = timeAxis(loop, units);
  const { t, y, u } = scaled(excerpt, size);
  if (t.length < 2) return null;
  return {
    title: "Measurement against output",
    description: `${tag}: PV against OP over the last periods.`,
    x: { kind: "linear", label: withUnit(`${tag} OP`, units.u) },
    panes: [
      {
        y: { kind: "linear", label: labelOf(loop, "PV", units.y) },
        traces: [{ name: "PV", look: "data", x: u, y, parameter: t }],
        marks: valveBand(loop, units),
      },
    ],
    link: "measurement-output",
    cursorLabel: withUnit("time", unit),
    cursorKind: "linear",
    fileName: "measurement-against-output",
  };
}

const periodMarks = ({ oscillation }: LoopCheck, units: UnitNames): Mark[] =>
  oscillation.periods.map(({ period }) => ({
    kind: "upright",
    value: period,
    label: `${formatNumber(period)} ${units.time}`,
    role: "limit",
  }));

const hasCurve = ({ x }: CheckCurve): boolean => x.length > 1;

function periodSentence({ oscillation }: LoopCheck, units: UnitNames): string {
  const { found, periods } = oscillation;
  if (!found) return "No regular oscillation.";
  return `Regular oscillations with periods of ${periods.map(({ period }) => `${formatNumber(period)} ${units.time}`).join(", ")}.`;
}

function spectrumFrame(loop: LoopCheck, units: UnitNames): Frame | null {
  const { x, y } = loop.spectrum;
  if (!hasCurve(loop.spectrum)) return null;
  const label = withUnit("period", units.time);
  return {
    title: "Spectrum of the error",
    description: `${loop.tag}. ${periodSentence(loop, units)}`,
    x: { kind: "log", label },
    panes: [
      {
        y: { kind: "linear", label: "power (%)" },
        traces: [{ name: "share of the power", look: 1, x, y: y.map((share) => (share === null ? null : 100 * share)) }],
        marks: periodMarks(loop, units),
      },
    ],
    link: "spectrum",
    cursorLabel: label,
    cursorKind: "log",
    fileName: "spectrum",
  };
}

function autocorrelationFrame(loop: LoopCheck, units: UnitNames): Frame | null {
  const { x, y } = loop.autocorrelation;
  if (!hasCurve(loop.autocorrelation)) return null;
  const label = withUnit("lag", units.time);
  return {
    title: "Autocorrelation of the error",
    description: `${loop.tag}. ${periodSentence(loop, units)}`,
    x: { kind: "linear", label },
    panes: [
      {
        y: { kind: "linear", label: "correlation" },
        traces: [{ name: "correlation", look: 1, x, y }],
        marks: periodMarks(loop, units),
      },
    ],
    link: "autocorrelation",
    cursorLabel: label,
    cursorKind: "linear",
    fileName: "autocorrelation",
  };
}
