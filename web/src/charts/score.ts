// The score of a rule: its performance profile beside those of other rules, and its ratios over tau.
import type { ScoreAnswer } from "../api/score.ts";
import type { Frame, Look, Mark, Trace } from "../plot/frame.ts";
import { formatNumber } from "../words/numbers.ts";
import { STATUS_WORDS } from "../rules/words.ts";
import type { Status } from "../rules/words.ts";

/** A rule in the profile. `look`: null for one among many. */
export interface ProfiledRule {
  answer: ScoreAnswer;
  name: string;
  look: Look | null;
}

/** The highest ratio of a plot; beyond it a rule is of no use. */
const HIGHEST = 100;
const LEAST_SPAN = 2;
const HEADROOM = 1.15;

/** The steps of a profile from ratio 1 to `end`: the share jumps at each ratio. */
export function profileSteps({ profile }: ScoreAnswer, end: number): { x: number[]; y: number[] } {
  const [x, y] = [[1], [0]];
  let share = 0;
  for (const point of profile) {
    const ratio = Math.max(1, point.ratio);
    if (ratio > end) break;
    x.push(ratio, ratio);
    y.push(share, point.share);
    share = point.share;
  }
  return { x: [...x, end], y: [...y, share] };
}

/** The scored rule comes first. */
export function profileFrame(rules: readonly ProfiledRule[]): Frame {
  const worst = Math.max(LEAST_SPAN, ...rules.filter(({ look }) => look !== null).map(({ answer }) => answer.worst_ratio ?? 1));
  const end = Math.min(HIGHEST, worst * HEADROOM);
  // What is named is drawn over the others.
  const drawn = [...rules].sort((a, b) => Number(a.look !== null) - Number(b.look !== null) || Number(b === rules[0]) - Number(a === rules[0]));
  const traces = drawn.map(({ answer, name, look }): Trace => ({ name, look: look ?? "data", ...(look === null ? { quiet: true } : {}), ...profileSteps(answer, end) }));
  const sentences = rules
    .filter(({ look }) => look !== null)
    .map(({ answer, name }) => `${name} solves ${formatNumber(100 * (answer.profile.at(-1)?.share ?? 0))} % of the problems.`);
  return {
    title: "Performance profile",
    description: sentences.join(" "),
    x: { kind: "log", label: "ratio: IAE over the proved bound", range: [1, end] },
    panes: [{ y: { kind: "linear", label: "share of the problems solved within the ratio", range: [0, 1.02] }, traces }],
    ownLegend: true,
    link: "score-profile",
    cursorLabel: "ratio",
    cursorKind: "log",
    fileName: "performance-profile",
  };
}

/** The ratio of each problem over tau; broken limits have a pane of their own. Null without any. */
export function ratioFrame({ problems, name }: ScoreAnswer): Frame | null {
  const of = (status: Status): Mark[] =>
    problems
      .filter((one) => one.status === status && typeof one.ratio === "number")
      .map((one) => ({ kind: "point", x: one.tau, y: one.ratio!, label: `${one.name}: ${formatNumber(one.ratio)}`, quiet: true, ...(status === "kept" ? { look: 1 as const } : {}) }));
  const level: Mark = { kind: "level", value: 1, role: "limit", label: "proved bound" };
  const panes = (["kept", "limits-broken"] as const).flatMap((status) => {
    const points = of(status);
    if (points.length === 0) return [];
    const values = points.flatMap((mark) => (mark.kind === "point" ? [mark.y] : []));
    const range = [Math.min(0.9, ...values) / HEADROOM, Math.max(LEAST_SPAN, ...values) * HEADROOM] as const;
    return [{ y: { kind: "log" as const, label: `ratio, ${STATUS_WORDS[status]}`, range }, traces: [], marks: [level, ...points] }];
  });
  if (panes.length === 0) return null;
  return {
    title: "Ratio over tau",
    description: `${name}: the IAE over the proved bound for each problem, by tau = L/(L + T). ${problems.filter(({ status }) => status === "limits-broken").length} problems with broken limits are apart.`,
    x: { kind: "linear", label: "tau = L/(L + T)", range: [0, 1] },
    panes,
    link: "score-tau",
    cursorLabel: "tau",
    cursorKind: "linear",
    fileName: "ratio-over-tau",
  };
}
