// Robustness against speed: the least load IAE under each limit on Ms, with the designs and rules as points.
import type { Entry, Frontier } from "../api/types.ts";
import type { Frame, Mark, Trace } from "../plot/frame.ts";
import { formatNumber, product, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { entryNames } from "./drawn.ts";

export interface FrontShown {
  /** Null if there is none or it is not known yet. */
  PID: Frontier | null;
  PI: Frontier | null;
  /** The design; `at`: the limit for which it was made, null for settings by hand and rules. */
  here: { entry: Entry; at: number | null };
  today: Entry | null;
  rules: Entry[];
  load: number;
}

const LOWEST_MS = 1.05;
const HIGHEST_MS = 2.6;

const IAEof = (entry: Entry): number | null => {
  const IAE = entry.performance?.load?.["IAE"];
  return typeof IAE === "number" && IAE > 0 ? IAE : null;
};

export function frontFrame(shown: FrontShown, units: UnitNames): Frame {
  const curve = (name: string, look: Trace["look"], front: Frontier | null): Trace[] =>
    front && front.points.length > 1
      ? [{ name, look, x: front.points.map((p) => p.Ms), y: front.points.map((p) => scaled(p.load_IAE, shown.load)) }]
      : [];
  const traces = [...curve("best PID", 1, shown.PID), ...curve("best PI", 3, shown.PI)];
  const here = pointOf(shown.here.entry, shown.here.at);
  const today = shown.today ? pointOf(shown.today, null) : null;
  const names = entryNames(shown.rules);
  const rules = shown.rules.flatMap((entry, index): Mark[] => {
    const at = entry.method === "baseline" || !entry.robustness?.stable ? null : pointOf(entry, null);
    return at ? [{ kind: "point", ...at, label: names[index]!, quiet: true, look: "data" }] : [];
  });
  const marks: Mark[] = [
    ...rules,
    ...(today ? [{ kind: "point" as const, ...today, label: "today", look: 2 as const }] : []),
    ...(here ? [{ kind: "point" as const, ...here, label: "", look: 1 as const, handle: shown.here.at !== null }] : []),
  ];
  const rulesSentence = rules.length === 0 ? "" : ` ${rules.length} rules are shown for comparison.`;
  return {
    title: "Robustness against speed",
    description: here
      ? `The design has Ms ${formatNumber(here.x)} and a load IAE of ${formatNumber(here.y)}.${rulesSentence}`
      : "There is no such design.",
    x: { kind: "linear", label: "Ms", range: [LOWEST_MS, HIGHEST_MS] },
    panes: [
      {
        y: { kind: "log", label: withUnit("load IAE", product(units.y, units.time)), range: rangeOf(traces, here, today) },
        traces,
        marks,
      },
    ],
    ownLegend: true,
    link: "front",
    cursorLabel: "Ms",
    cursorKind: "linear",
    fileName: "robustness-speed",
  };
}

/** Frontiers are for unit steps. */
const scaled = (IAE: number | null, load: number): number | null => (IAE === null ? null : IAE * Math.abs(load));

function pointOf(entry: Entry, at: number | null): { x: number; y: number } | null {
  const [x, y] = [at ?? entry.robustness?.Ms, IAEof(entry)];
  return typeof x === "number" && y !== null ? { x, y } : null;
}

/** The range of the curves and the two main designs; rules far above are not in view. */
function rangeOf(traces: Trace[], ...points: ({ y: number } | null)[]): [number, number] {
  const values = [
    ...traces.flatMap((trace) => trace.y.filter((y): y is number => typeof y === "number")),
    ...points.flatMap((point) => (point ? [point.y] : [])),
  ];
  const [lo, hi] = values.length > 0 ? [Math.min(...values), Math.max(...values)] : [0.1, 10];
  return [lo / 1.25, hi * 1.25];
}
