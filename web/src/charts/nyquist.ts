// The Nyquist curve of L with the circles that it must not enter.
import type { Entry, FrequencyTraces, TuningRequest } from "../api/types.ts";
import type { Frame, Mark, OnDrag } from "../plot/frame.ts";
import { formatNumber, unitNames } from "../words/numbers.ts";
import type { Drawn } from "./drawn.ts";
import type { Limits } from "../words/limits.ts";

/** The circle |S| = Ms: centre -1, radius 1/Ms. */
function sensitivityCircle(Ms: number): { x: number; radius: number } {
  return { x: -1, radius: 1 / Ms };
}

/** The circle |T| = Mt > 1: centre -Mt^2/(Mt^2 - 1), radius Mt/(Mt^2 - 1). */
function complementaryCircle(Mt: number): { x: number; radius: number } {
  return { x: -(Mt * Mt) / (Mt * Mt - 1), radius: Mt / (Mt * Mt - 1) };
}

/** The curve that can be dragged, and the slider that follows. */
export interface CurveGrip {
  index: number;
  label: string;
  drag: OnDrag;
}

/** The point of L that is nearest to −1. */
function nearest(entry: Entry): { x: number; y: number } | null {
  const { re = [], im = [] } = entry.frequency?.L ?? {};
  const away = (index: number): number => Math.hypot((re[index] ?? Infinity) + 1, im[index] ?? Infinity);
  const at = re.reduce<number>((best, _, index) => (away(index) < away(best) ? index : best), 0);
  const [x, y] = [re[at], im[at]];
  return typeof x === "number" && typeof y === "number" ? { x, y } : null;
}

export function nyquistFrame(drawn: Drawn[], limits: Limits, request: TuningRequest | undefined, grip?: CurveGrip | null): Frame {
  const units = unitNames(request?.units);
  const achieved = drawn[0]?.entry.robustness;
  const Ms = limits.Ms ?? achieved?.Ms ?? null;
  const Mt = limits.Mt ?? achieved?.Mt ?? null;
  const marks: Mark[] = [];
  let left = -2;
  if (Mt !== null && Mt > 1.05) {
    const circle = complementaryCircle(Mt);
    marks.push({ kind: "circle", ...circle, y: 0, label: `Mt ${formatNumber(Mt)}`, labelAt: "below" });
    left = Math.min(left, Math.max(circle.x - circle.radius - 0.2, -4.5));
  }
  if (Ms !== null && Ms > 1)
    marks.push({ kind: "circle", ...sensitivityCircle(Ms), y: 0, label: `Ms ${formatNumber(Ms)}`, labelAt: "above" });
  marks.push({ kind: "point", x: -1, y: 0, label: "−1" });
  const held = grip && drawn.find(({ index }) => index === grip.index);
  const point = held && nearest(held.entry);
  if (point) marks.push({ kind: "point", ...point, label: `drag: ${grip.label}`, look: held.look, quiet: true, handle: true });
  return {
    ...(point ? { drag: grip.drag } : {}),
    title: "Nyquist curve of L",
    description:
      (point ? `${held.name} can be dragged to or from −1, which moves ${grip.label}. ` : "") +
      drawn
        .map(
          (item) => `${item.name}: nearest to −1 at a distance of ${formatNumber(inverse(item.entry.robustness?.Ms))}.`,
        )
        .join(" ") || "No curve to draw.",
    x: { kind: "linear", label: "Re L", range: [left, 0.8] },
    panes: [
      {
        y: { kind: "linear", label: "Im L", range: [-1.8, 1.2] },
        traces: drawn.flatMap((item) => {
          const frequency = item.entry.frequency;
          if (!frequency) return [];
          const { re: x, im: y } = frequency.L;
          const winding = windingOf(frequency);
          return [{ name: item.name, look: item.look, x, y, parameter: frequency.omega, grab: item === held, ...(winding ? { winding } : {}) }];
        }),
        marks: [{ kind: "upright", value: 0, role: "zero" }, ...marks],
      },
    ],
    equal: true,
    link: "omega",
    cursorLabel: `ω (rad/${units.time})`,
    cursorKind: "log",
    fileName: "nyquist",
  };
}

const TURN_DEG = 360;
/** A wider ring of turns is drawn. */
const WIDEST = 0.6;

/** The point from which L has made a whole turn beyond its last gain of one and will make at least another: the
    effect of a dead time. */
export function windingOf(frequency: FrequencyTraces): { from: number; radius: number } | null {
  const { re, im, phase_deg: phase } = frequency.L;
  if (!phase) return null;
  const gain = re.map((value, index) => Math.hypot(value ?? NaN, im[index] ?? NaN));
  const crossover = gain.map((value) => value >= 1).lastIndexOf(true);
  const after = (index: number): number => (phase[Math.max(0, crossover)] ?? NaN) - (phase[index] ?? NaN);
  const from = phase.findIndex((_, index) => index > crossover && after(index) > TURN_DEG);
  if (from < 0 || !(after(phase.length - 1) > 2 * TURN_DEG)) return null;
  const radius = Math.max(...gain.slice(from).filter(Number.isFinite));
  return radius < WIDEST ? { from, radius } : null;
}

const inverse = (value: number | null | undefined): number | null =>
  typeof value === "number" && value > 0 ? 1 / value : null;
