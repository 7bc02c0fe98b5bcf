// A checked loop: its record over time, the measurement against the output, the spectrum and the autocorrelation of
// its error.
import type { CheckCurve, LoopCheck, LoopTrend } from "../api/types.ts";
import type { Frame, Mark, Pane, Trace } from "../plot/frame.ts";
import { verdictWords } from "../words/check.ts";
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

export const loopFrames = (loop: LoopCheck, units: UnitNames): LoopFrames => ({
  trend: trendFrame(loop, units, "trend"),
  excerpt: trendFrame(loop, units, "excerpt"),
  plane: planeFrame(loop, units),
  spectrum: spectrumFrame(loop, units),
  autocorrelation: autocorrelationFrame(loop, units),
});

const SPANS = {
  trend: { title: "Whole record", what: "the whole record, the extremes of even stretches", link: "whole-record" },
  excerpt: { title: "Last periods", what: "the last periods, row by row", link: "last-periods" },
} as const;

/** `whole`: the samples are extremes of the measurement, between which the output moves too: it is not held. */
function panesOf({ t, y, r, u }: LoopTrend, units: UnitNames, whole: boolean): Pane[] {
  const setPoint: Trace[] = r ? [{ name: "set point", look: 2, ...held(t, r) }] : [];
  return [
    {
      y: { kind: "linear", label: withUnit("y", units.y) },
      traces: [{ name: "measurement", look: "data", x: t, y }, ...setPoint],
      weight: 1.5,
    },
    {
      y: { kind: "linear", label: withUnit("u", units.u) },
      traces: [{ name: "output", look: "data", ...(whole ? { x: t, y: u } : held(t, u)) }],
    },
  ];
}

/** Measurement with set point over the output; null without rows. */
export function trendFrame(loop: LoopCheck, units: UnitNames, span: "trend" | "excerpt"): Frame | null {
  const { title, what, link } = SPANS[span];
  const trend = loop[span];
  if (trend.t.length < 2) return null;
  return {
    title,
    description: `${loop.tag}, ${what}. ${verdictWords(loop.cause.verdict)}.`,
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes: panesOf(trend, units, span === "trend"),
    // The picture below has the same lines.
    ownLegend: span === "trend",
    link,
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: link,
  };
}

/** The path of the loop in the plane of output and measurement: a sticking valve draws a parallelogram there. */
function planeFrame({ tag, excerpt }: LoopCheck, units: UnitNames): Frame | null {
  const { t, y, u } = excerpt;
  if (t.length < 2) return null;
  return {
    title: "Measurement against output",
    description: `${tag}: PV against OP over the last periods.`,
    x: { kind: "linear", label: withUnit("u, output", units.u) },
    panes: [
      {
        y: { kind: "linear", label: withUnit("y, measurement", units.y) },
        traces: [{ name: "y", look: "data", x: u, y, parameter: t }],
      },
    ],
    link: "measurement-output",
    cursorLabel: withUnit("time", units.time),
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
