// The score of a rule as text: counts, the table problem by problem, and its CSV.
import type { ProblemScore, ScoreAnswer } from "../api/score.ts";
import { DASH, formatNumber } from "../words/numbers.ts";

/** A problem as the library has it. */
export interface KnownProblem {
  /** As typed. */
  plant: string;
  structure: "pi" | "pid_tied" | "pid_fixed";
  /** Of pid_fixed. */
  Tf?: number;
  Ms: number;
  Mt: number;
  /** The IAE of the best known controller, and the proved bound. */
  upper: number;
  lower: number;
}

export interface Library {
  families: string[];
  problems: Record<string, KnownProblem>;
}

export type Status = ProblemScore["status"];

export const STATUS_WORDS: Record<Status, string> = {
  kept: "limits hold",
  "limits-broken": "limits broken",
  unstable: "unstable",
  "no-settings": "no settings",
};

export const STRUCTURE_WORDS: Record<KnownProblem["structure"], string> = {
  pi: "PI",
  pid_tied: "PID, Tf = Td/10",
  pid_fixed: "PID, Tf given",
};

export const problemCount = ({ kept, limits_broken, unstable, no_settings }: ScoreAnswer): number =>
  kept + limits_broken + unstable + no_settings;

/** The one structure of all problems; undefined if they have several. */
export function commonStructure({ problems }: ScoreAnswer, library: Library): KnownProblem["structure"] | undefined {
  const all = new Set(problems.map(({ name }) => library.problems[name]?.structure));
  return all.size === 1 ? [...all][0] : undefined;
}

export function headline(answer: ScoreAnswer): string {
  const all = problemCount(answer);
  return `${answer.name}: the limits hold on ${answer.kept} of ${all} ${all === 1 ? "problem" : "problems"}.`;
}

/** The reason why there are no settings for any problem, if it is the same for all. */
export function commonFault({ problems, no_settings }: ScoreAnswer): string {
  const reasons = new Set(problems.map(({ why }) => why ?? ""));
  return no_settings === problems.length && reasons.size === 1 ? [...reasons][0]! : "";
}

/** Label and value of each figure. */
export function scoreFacts(answer: ScoreAnswer): [label: string, value: string, aside: string][] {
  const { range } = answer;
  return [
    ["limits hold", String(answer.kept), ""],
    ["limits broken", String(answer.limits_broken), ""],
    ["unstable", String(answer.unstable), ""],
    ["no settings", String(answer.no_settings), ""],
    ["median ratio", formatNumber(answer.median_ratio), ""],
    ["worst ratio", formatNumber(answer.worst_ratio), ""],
    [
      "range of tau",
      range ? `${formatNumber(range.tau_low)} to ${formatNumber(range.tau_high)}` : DASH,
      range ? `${range.problems} ${range.problems === 1 ? "problem" : "problems"}, ratio at most ${formatNumber(range.worst_ratio)}` : "",
    ],
  ];
}

/** A problem with its answer, as a row. */
export interface ScoreRow {
  score: ProblemScore;
  /** Undefined: the page's library does not have it. */
  known: KnownProblem | undefined;
}

export interface ScoreColumn {
  id: string;
  label: string;
  meaning: string;
  value(row: ScoreRow): number | string | undefined;
}

const setting = (name: "Kp" | "Ti" | "Td"): ScoreColumn => ({
  id: name,
  label: name,
  meaning: "setting, ideal form",
  value: ({ score }) => (score.controller as Record<string, unknown> | undefined)?.[name] as number | undefined,
});

export const SCORE_COLUMNS: readonly ScoreColumn[] = [
  { id: "problem", label: "Problem", meaning: "family, parameters, structure, limit on Ms", value: ({ score }) => score.name },
  { id: "status", label: "Result", meaning: "whether both limits hold", value: ({ score }) => STATUS_WORDS[score.status] },
  { id: "ratio", label: "Ratio", meaning: "IAE over the proved bound", value: ({ score }) => score.ratio },
  { id: "tau", label: "tau", meaning: "L/(L + T) of the first-order reduction", value: ({ score }) => score.tau },
  { id: "Ms", label: "Ms", meaning: "largest |S|", value: ({ score }) => score.Ms },
  { id: "Mt", label: "Mt", meaning: "largest |T|", value: ({ score }) => score.Mt },
  { id: "limit", label: "Limit", meaning: "on Ms and Mt", value: ({ known }) => known?.Ms },
  { id: "IAE", label: "IAE", meaning: "after a unit load step", value: ({ score }) => score.IAE },
  { id: "best", label: "Best known", meaning: "IAE of the best known controller", value: ({ known }) => known?.upper },
  { id: "lower", label: "Proved bound", meaning: "no controller within the limits has a smaller IAE", value: ({ known }) => known?.lower },
  setting("Kp"),
  setting("Ti"),
  setting("Td"),
];

export interface ScoreOrder {
  column: string;
  falling: boolean;
}

/** Rows without a value come last. */
export function sortScores(rows: readonly ScoreRow[], { column, falling }: ScoreOrder): ScoreRow[] {
  const { value } = SCORE_COLUMNS.find(({ id }) => id === column) ?? SCORE_COLUMNS[0]!;
  const sign = falling ? -1 : 1;
  return [...rows].sort((a, b) => {
    const [x, y] = [value(a), value(b)];
    if (x === undefined || y === undefined) return Number(x === undefined) - Number(y === undefined);
    if (typeof x === "number" && typeof y === "number") return sign * (x - y);
    return sign * String(x).localeCompare(String(y), "en", { numeric: true });
  });
}

export const scoreRows = ({ problems }: ScoreAnswer, library: Library): ScoreRow[] =>
  problems.map((score) => ({ score, known: library.problems[score.name] }));

/** The table as cells of a CSV, with every digit. */
export const scoreCells = (rows: readonly ScoreRow[]): (string | number | null)[][] => [
  [...SCORE_COLUMNS.map(({ id }) => id), "why"],
  ...rows.map((row) => [...SCORE_COLUMNS.map(({ value }) => value(row) ?? null), row.score.why ?? null]),
];
