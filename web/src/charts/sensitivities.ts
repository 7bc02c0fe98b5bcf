// |S|, |T| and |CS| over frequency, in one pane each so that up to four entries remain distinct, with their limits.
import type { FrequencyTraces, TuningRequest } from "../api/types.ts";
import { extent } from "../plot/axis.ts";
import type { Range } from "../plot/axis.ts";
import type { Frame, Mark, Pane, Trace } from "../plot/frame.ts";
import { formatNumber, quotient, unitNames, withUnit } from "../words/numbers.ts";
import { aroundCrossover } from "./bode.ts";
import type { Drawn } from "./drawn.ts";
import type { Limits } from "../words/limits.ts";

type Curve = "S_abs" | "T_abs" | "CS_abs";

export function sensitivityFrame(drawn: Drawn[], limits: Limits, request: TuningRequest | undefined): Frame {
  const units = unitNames(request?.units);
  const range = aroundCrossover(drawn);
  const pane = (curve: Curve, label: string, limit: number | null, limitName: string, decades: number): Pane => {
    const traces = drawn.flatMap((item): Trace[] => {
      const frequency: FrequencyTraces | undefined = item.entry.frequency;
      return frequency ? [{ name: item.name, look: item.look, x: frequency.omega, y: frequency[curve] }] : [];
    });
    const marks: Mark[] =
      limit === null
        ? []
        : [{ kind: "level", value: limit, role: "limit", label: `${limitName} ${formatNumber(limit)}` }];
    return { y: { kind: "log", label, range: topDecades(traces, limit, decades) }, traces, marks };
  };
  return {
    title: "Sensitivities",
    description:
      drawn
        .map(
          ({ name, entry }) =>
            `${name}: Ms ${formatNumber(entry.robustness?.Ms)}, Mt ${formatNumber(entry.robustness?.Mt)}, Mks ${formatNumber(entry.robustness?.Mks)}.`,
        )
        .join(" ") || "No curve to draw.",
    x: { kind: "log", label: `ω (rad/${units.time})`, ...(range ? { range } : {}) },
    panes: [
      pane("S_abs", "|S|", limits.Ms, "limit", 2),
      pane("T_abs", "|T|", limits.Mt, "limit", 2),
      pane("CS_abs", withUnit("|CS|", quotient(units.u, units.y)), limits.Mks, "limit", 3),
    ],
    link: "omega",
    cursorLabel: `ω (rad/${units.time})`,
    cursorKind: "log",
    fileName: "sensitivities",
  };
}

/** The maximum of the data and this number of decades below it: deeper values do not concern robustness. */
function topDecades(traces: Trace[], limit: number | null, decades: number): Range {
  const [lo, hi] = extent([...traces.map((trace) => trace.y), limit === null ? [] : [limit]], "log");
  // Room for the limit's name above its line.
  const top = hi * 3.2;
  return [Math.max(lo / 1.2, top / 10 ** decades), top];
}
