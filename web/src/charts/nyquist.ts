// The Nyquist curve of L with the circles that it must not enter.
import type { TuningRequest } from "../api/types.ts";
import type { Frame, Mark } from "../plot/frame.ts";
import { formatNumber, unitNames } from "../words/numbers.ts";
import type { Drawn } from "./drawn.ts";
import type { Limits } from "../words/limits.ts";

/** Where |S| = Ms: centre -1, radius 1/Ms. */
function sensitivityCircle(Ms: number): { x: number; radius: number } {
  return { x: -1, radius: 1 / Ms };
}

/** Where |T| = Mt > 1: centre -Mt^2/(Mt^2 - 1), radius Mt/(Mt^2 - 1). */
function complementaryCircle(Mt: number): { x: number; radius: number } {
  return { x: -(Mt * Mt) / (Mt * Mt - 1), radius: Mt / (Mt * Mt - 1) };
}

export function nyquistFrame(drawn: Drawn[], limits: Limits, request: TuningRequest | undefined): Frame {
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
  return {
    title: "Nyquist curve of L",
    description:
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
          return frequency
            ? [{ name: item.name, look: item.look, x: frequency.L.re, y: frequency.L.im, parameter: frequency.omega }]
            : [];
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

const inverse = (value: number | null | undefined): number | null =>
  typeof value === "number" && value > 0 ? 1 / value : null;
