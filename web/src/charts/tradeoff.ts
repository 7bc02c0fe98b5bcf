// Servo against regulation: the cost of robustness for a controller, compared with the tuning rule of Arrieta et al. on
// this plant.
import type { Tradeoff, TradeoffFigures, TradeoffPoint } from "../api/types.ts";
import { extent } from "../plot/axis.ts";
import type { Range } from "../plot/axis.ts";
import type { Frame, Mark, Trace } from "../plot/frame.ts";
import { formatNumber, withUnit } from "../words/numbers.ts";

export interface TradeoffItem {
  name: string;
  tradeoff: Tradeoff | undefined;
}

type Profile = NonNullable<Tradeoff["profile"]>;
type Name = "J_r" | "J_d" | "J_rd" | "I_perf" | "Deg" | "Ms" | "Ms_design" | "degradation";

const at = (point: TradeoffPoint, name: Name): number | null => (point as Partial<Record<Name, number>>)[name] ?? null;

const column = (points: TradeoffPoint[], name: Name): (number | null)[] => points.map((point) => at(point, name));

/** The figures for the curves: of the first-order model; of the plant itself if there is no model. */
export const figuresOf = (item: TradeoffItem): TradeoffFigures | undefined =>
  item.tradeoff?.model ?? item.tradeoff?.plant;

const hasIndices = (figures: TradeoffFigures | undefined): boolean =>
  typeof figures?.J_r === "number" || typeof figures?.J_d === "number";

/** True if it has data to show. */
export const isKnown = ({ tradeoff }: TradeoffItem): boolean =>
  hasIndices(tradeoff?.model) || hasIndices(tradeoff?.plant);

/** The reason why an answer has no indices; "" if it has, or if none were asked for. */
export function whyUnknown(item: TradeoffItem): string {
  const { tradeoff } = item;
  if (!tradeoff || isKnown(item)) return "";
  const reasons = [tradeoff.model, tradeoff.plant].flatMap((part) => Object.values(part?.why_null ?? {}));
  return reasons[0] ?? "There is no trade-off of this controller.";
}

/** The rule's behaviour, from any entry that has it. */
export const profileOf = (items: TradeoffItem[]): Profile | null =>
  items.map((item) => item.tradeoff?.profile).find((profile) => profile !== undefined) ?? null;

/** A point for each controller whose figures are numbers. */
function points(items: TradeoffItem[], x: keyof TradeoffFigures, y: keyof TradeoffFigures): Mark[] {
  return items.flatMap((item): Mark[] => {
    const [a, b] = [figuresOf(item)?.[x], figuresOf(item)?.[y]];
    return typeof a === "number" && typeof b === "number" ? [{ kind: "point", x: a, y: b, label: item.name }] : [];
  });
}

function rangeOf(traces: Trace[], marks: Mark[], axis: "x" | "y", margin: number): Range {
  const marked = marks.flatMap((mark) => (mark.kind === "point" ? [mark[axis]] : []));
  return extent([...traces.map((trace) => trace[axis]), marked], "linear", margin);
}

/** J_d over J_r: the rule's curve, the controllers, and the corner that no controller reaches in both at once. */
export function tradeoffFrame(items: TradeoffItem[], time: string): Frame | null {
  const profile = profileOf(items);
  const known = items.map(figuresOf).find((figures) => figures !== undefined);
  if (!known) return null;
  const traces: Trace[] = profile
    ? [
        curve("rule over Ms", 1, profile.by_Ms, "J_r", "J_d", "Ms"),
        curve("rule over degradation", 3, profile.by_degradation, "J_r", "J_d", "Ms"),
      ]
    : [];
  const controllers = points(items, "J_r", "J_d");
  const { J_r_opt, J_d_opt } = known;
  const corner: Mark[] =
    typeof J_r_opt === "number" && typeof J_d_opt === "number"
      ? [
          { kind: "upright", value: J_r_opt, role: "limit" },
          { kind: "level", value: J_d_opt, role: "limit" },
          { kind: "point", x: J_r_opt, y: J_d_opt, label: "best of both" },
        ]
      : [];
  const marks = [...corner, ...controllers];
  const spoken = items.map((item) => {
    const figures = figuresOf(item);
    return `${item.name}: J_r ${formatNumber(figures?.J_r)}, J_d ${formatNumber(figures?.J_d)}.`;
  });
  return {
    title: "Servo against regulation",
    description: `${spoken.join(" ")} At best J_r is ${formatNumber(J_r_opt)}, J_d ${formatNumber(J_d_opt)}.`,
    x: { kind: "linear", label: withUnit("J_r, set-point step", time), range: rangeOf(traces, marks, "x", 0.12) },
    panes: [
      {
        y: { kind: "linear", label: withUnit("J_d, load step", time), range: rangeOf(traces, marks, "y", 0.12) },
        traces,
        marks,
      },
    ],
    ownLegend: true,
    link: "tradeoff-Ms",
    cursorLabel: "Ms",
    cursorKind: "linear",
    fileName: "servo-regulation",
  };
}

/** The degradation at each Ms. */
export function degradationFrame(items: TradeoffItem[]): Frame | null {
  const profile = profileOf(items);
  if (!profile) return null;
  const traces = [
    plain("rule over Ms", 1, profile.by_Ms, "Ms", "Deg"),
    plain("rule over degradation", 3, profile.by_degradation, "Ms", "Deg"),
  ];
  const marks = points(items, "Ms", "Deg");
  return {
    title: "Degradation against Ms",
    description: items
      .map(
        (item) => `${item.name}: Deg ${formatNumber(figuresOf(item)?.Deg)} at Ms ${formatNumber(figuresOf(item)?.Ms)}.`,
      )
      .join(" "),
    x: { kind: "linear", label: "Ms", range: rangeOf(traces, marks, "x", 0.06) },
    panes: [
      {
        y: { kind: "linear", label: "Deg = 1 − I_perf", range: rangeOf(traces, marks, "y", 0.1) },
        traces,
        marks,
      },
    ],
    ownLegend: true,
    link: "tradeoff-Ms",
    cursorLabel: "Ms",
    cursorKind: "linear",
    fileName: "degradation",
  };
}

/** The effect of each allowed degradation: the degradation itself, J_rd, Ms. */
export function levelsFrame(items: TradeoffItem[], time: string): Frame | null {
  const levels = profileOf(items)?.by_degradation ?? [];
  if (levels.length < 2) return null;
  const asked = column(levels, "degradation");
  const reached = plain("reached", 1, levels, "degradation", "Deg");
  return {
    title: "Figures by allowed degradation",
    description: levels
      .map(
        (level) =>
          `${formatNumber(level.degradation)} allowed: ${formatNumber(level.Deg)} reached, Ms ${formatNumber(level.Ms)}.`,
      )
      .join(" "),
    x: { kind: "linear", label: "allowed degradation" },
    panes: [
      {
        y: { kind: "linear", label: "Deg" },
        traces: [reached, { name: "as allowed", look: "data", x: asked, y: asked }],
      },
      {
        y: { kind: "linear", label: withUnit("J_rd", time) },
        traces: [plain("reached", 1, levels, "degradation", "J_rd")],
      },
      { y: { kind: "linear", label: "Ms" }, traces: [plain("reached", 1, levels, "degradation", "Ms")] },
    ],
    ownLegend: true,
    link: "tradeoff-levels",
    cursorLabel: "allowed degradation",
    cursorKind: "linear",
    fileName: "degradation-levels",
  };
}

const plain = (name: string, look: Trace["look"], list: TradeoffPoint[], x: Name, y: Name): Trace => ({
  name,
  look,
  x: column(list, x),
  y: column(list, y),
});

/** A parametric curve in the plane; points without the parameter are left out. */
function curve(name: string, look: Trace["look"], list: TradeoffPoint[], x: Name, y: Name, along: Name): Trace {
  const kept = list.filter((point) => at(point, along) !== null);
  return { ...plain(name, look, kept, x, y), parameter: kept.map((point) => at(point, along)!) };
}

export interface TradeoffRow {
  label: string;
  meaning: string;
  name: Exclude<keyof TradeoffFigures, "why_null">;
}

export const tradeoffRows = (time: string): TradeoffRow[] => [
  { label: withUnit("J_r", time), meaning: "IAE of a unit set-point step", name: "J_r" },
  { label: withUnit("J_d", time), meaning: "IAE of a unit load step, divided by the plant's gain", name: "J_d" },
  { label: withUnit("J_rd", time), meaning: "distance from the best of both", name: "J_rd" },
  { label: withUnit("J_r at best", time), meaning: "if only the set point mattered", name: "J_r_opt" },
  { label: withUnit("J_d at best", time), meaning: "if only the load mattered", name: "J_d_opt" },
  { label: "I_perf", meaning: "J_rd of the rule without a limit on Ms, divided by this J_rd", name: "I_perf" },
  { label: "Deg", meaning: "1 − I_perf: the cost of robustness; negative is better than that rule", name: "Deg" },
  { label: "Ms", meaning: "peak of |S|", name: "Ms" },
];
