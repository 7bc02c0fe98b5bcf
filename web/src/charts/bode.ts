// |L| and its phase over frequency, with marks at the margins.
import type { FrequencyTraces, TuningRequest } from "../api/types.ts";
import { extent } from "../plot/axis.ts";
import type { Range } from "../plot/axis.ts";
import type { Frame, Mark, Trace } from "../plot/frame.ts";
import { formatNumber, unitNames } from "../words/numbers.ts";
import type { Drawn } from "./drawn.ts";

/** Decades shown on both sides of the gain crossover. */
const DECADES = 2;
/** Lower phases give no further information about the loop, degrees. */
const LOWEST_PHASE = -540;

export function bodeFrame(drawn: Drawn[], request: TuningRequest | undefined): Frame {
  const units = unitNames(request?.units);
  const traces = (pick: (frequency: FrequencyTraces) => readonly (number | null)[]): Trace[] =>
    drawn.flatMap(({ name, look, entry: { frequency } }) =>
      frequency ? [{ name, look, x: frequency.omega, y: pick(frequency) }] : [],
    );
  const gains = traces(({ L }) => L.re.map((re, i) => (re === null || L.im[i] == null ? null : Math.hypot(re, L.im[i]!))));
  const phases = traces(({ L, omega }) => L.phase_deg ?? omega.map(() => null));
  const range = aroundCrossover(drawn);
  return {
    title: "Bode plot of L",
    description:
      drawn
        .map(({ name, entry: { robustness } }) => {
          const phase = formatNumber(robustness?.phase_margin_deg);
          return `${name}: phase margin ${phase} degrees, gain margin ${formatNumber(robustness?.gain_margin)}.`;
        })
        .join(" ") || "No curve to draw.",
    x: { kind: "log", label: `ω (rad/${units.time})`, ...(range ? { range } : {}) },
    panes: [
      {
        y: { kind: "log", label: "|L|", range: gainRange(gains, range) },
        traces: gains,
        marks: [{ kind: "level", value: 1, role: "zero" }, ...crossovers(drawn, "gain")],
      },
      {
        y: { kind: "linear", label: "phase of L (°)", range: phaseRange(phases, range) },
        traces: phases,
        marks: [{ kind: "level", value: -180, role: "limit", label: "−180°" }, ...crossovers(drawn, "phase")],
      },
    ],
    link: "omega",
    cursorLabel: `ω (rad/${units.time})`,
    cursorKind: "log",
    fileName: "bode",
  };
}

/** Two decades on both sides of the first loop's crossover, as far as the curves extend. */
export function aroundCrossover(drawn: Drawn[]): Range | null {
  const entry = drawn.find((item) => item.entry.frequency && item.entry.robustness?.gain_crossover)?.entry;
  const crossover = entry?.robustness?.gain_crossover;
  if (!entry?.frequency || typeof crossover !== "number") return null;
  const omega = entry.frequency.omega.filter((value) => typeof value === "number");
  const lo = Math.max(omega[0]!, crossover / 10 ** DECADES);
  const hi = Math.min(omega[omega.length - 1]!, crossover * 10 ** DECADES);
  return hi > lo ? [lo, hi] : null;
}

/** The part of a trace within the range of x. */
const within = (traces: Trace[], range: Range | null): (number | null)[][] =>
  traces.map(({ x, y }) => y.filter((_, i) => !range || (x[i]! >= range[0] && x[i]! <= range[1])));

function gainRange(traces: Trace[], range: Range | null): Range {
  const [lo, hi] = extent(within(traces, range), "log");
  return [Math.min(lo, 0.1) / 1.2, Math.max(hi, 10) * 1.2];
}

function phaseRange(traces: Trace[], range: Range | null): Range {
  const [lo, hi] = extent(within(traces, range), "linear");
  return [Math.max(lo, LOWEST_PHASE) - 10, Math.max(hi, -90) + 10];
}

/** The frequencies at which |L| = 1 and at which the phase is -180 degrees, for the first loop: the margins belong
    to them. */
function crossovers(drawn: Drawn[], pane: "gain" | "phase"): Mark[] {
  const robustness = drawn.find((item) => item.entry.robustness?.stable)?.entry.robustness;
  if (!robustness) return [];
  const { gain_crossover, phase_crossover, phase_margin_deg, gain_margin } = robustness;
  const at = pane === "phase" ? gain_crossover : phase_crossover;
  const margin = pane === "phase" ? phase_margin_deg : gain_margin;
  if (typeof at !== "number" || typeof margin !== "number") return [];
  const label = pane === "phase" ? `${formatNumber(margin)}°` : `× ${formatNumber(margin)}`;
  const y = pane === "phase" ? margin - 180 : 1 / margin;
  return [
    { kind: "upright", value: at, role: "zero" },
    { kind: "point", x: at, y, label },
  ];
}
