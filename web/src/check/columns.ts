// The work list of a check as data: its rows in order, its columns with their figures, and which rows are shown.
import type { CheckContent, ListedLoop, LoopChange, LoopRank } from "../api/types.ts";
import type { ListView } from "../routes.ts";
import type { ExplainedName } from "../words/explained.ts";
import { orderOf } from "../words/comparison.ts";
import { sorted } from "../words/job_list.ts";
import { csvText } from "../plot/export.ts";
import { DASH, formatNumber, formatShare, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { actionWords, confidenceWords, effortWords, estimate, ownerWords, significance, verdictOrder, verdictWords } from "../words/check.ts";

/** A loop with its place in the work list. */
export interface WorkRow {
  /** Its place in the answer's loops. */
  place: number;
  /** From 1. */
  rank: number;
  loop: ListedLoop;
  standing: LoopRank;
  /** Since the earlier check; undefined: it is not compared, or the earlier check does not have it. */
  change: LoopChange | undefined;
}

export interface WorkFigure {
  text: string;
  /** The reason why there is none, or "". */
  why: string;
}

export interface WorkColumn {
  id: string;
  label: string;
  about: ExplainedName | null;
  /** Words are written from the left. */
  words: boolean;
  /** The first press sorts in descending order. */
  falls: boolean;
  figure(row: WorkRow): WorkFigure;
  /** The value for sorting; null is last in both directions. */
  value(row: WorkRow): number | string | null;
}

export function workRows({ loops, ranking, changes = [] }: CheckContent): WorkRow[] {
  const changeOf = new Map(changes.map(({ loop, change }) => [loop, change]));
  return ranking.map((standing, index) => ({ place: standing.loop, rank: index + 1, loop: loops[standing.loop]!, standing, change: changeOf.get(standing.loop) }));
}

const NO_OSCILLATION = "No regular oscillation was found.";

type Read = (row: WorkRow) => number | null | undefined;

/** A column of figures, highest first. */
function figures(
  id: string,
  label: string,
  about: ExplainedName | null,
  read: Read,
  format: (value: number) => string,
  why: (row: WorkRow) => string = () => "",
): WorkColumn {
  const value = (row: WorkRow): number | null => read(row) ?? null;
  return {
    id,
    label,
    about,
    words: false,
    falls: true,
    value,
    figure: (row) => {
      const known = value(row);
      return known === null ? { text: DASH, why: why(row) } : { text: format(known), why: "" };
    },
  };
}

function wordsColumn(id: string, label: string, text: (row: WorkRow) => string, value: WorkColumn["value"] = text): WorkColumn {
  return { id, label, about: null, words: true, falls: false, value, figure: (row) => ({ text: text(row), why: "" }) };
}

/** Healthy loops and open causes are the last ones. */
const causeOrder = ({ loop }: WorkRow): number => {
  const { verdict, confidence } = loop.cause;
  return verdictOrder(verdict) + (confidence === "sure" ? 0 : 0.5);
};

const causeText = ({ loop }: WorkRow): string =>
  `${verdictWords(loop.cause.verdict)}, ${confidenceWords(loop.cause.confidence)}`;

function recordText({ loop }: WorkRow): string {
  const { enough, remarks } = loop.quality;
  const count = remarks.length;
  if (!enough) return "not sufficient";
  return count === 0 ? "no remark" : `${count} ${count === 1 ? "remark" : "remarks"}`;
}

const recordOrder = ({ loop }: WorkRow): number => loop.quality.remarks.length + (loop.quality.enough ? 0 : 100);

const atLimit: Read = ({ loop }) => loop.service.saturated_low + loop.service.saturated_high;

/** A share as percent: never 100 for less than all. */
const share = (value: number): string => formatShare(value);
const shortNumber = (value: number): string => formatNumber(value);

const NOT_BEFORE = "The earlier check has no loop with this name.";

/** What has changed since an earlier check. */
const CHANGES: readonly WorkColumn[] = [
  wordsColumn("before", "Cause before", ({ change }) => (change ? verdictWords(change.before) : DASH), ({ change }) => (change ? verdictOrder(change.before) : null)),
  figures("error", "Error now/before", "error_change", ({ change }) => change?.variability_ratio, shortNumber, ({ change }) => (change ? (change.why_null?.["variability_ratio"] ?? "") : NOT_BEFORE)),
  { ...wordsColumn("significant", "Significant", ({ change }) => significance(change), ({ change }) => (change ? change.likelihood : null)), about: "significant" },
];

/** Whether a loop has something to say in a column. */
const SAYS = {
  automatic: ({ loop }: WorkRow) => loop.service.automatic !== null,
  limit: (row: WorkRow) => (atLimit(row) ?? 0) > 0,
  record: (row: WorkRow) => recordOrder(row) > 0,
};

/** The columns after the loop's name and its trend. Money has one if a loop has a weight; changes if `since` names an earlier check. */
export function workColumns(rows: readonly WorkRow[], units: UnitNames, since = ""): WorkColumn[] {
  const why = (name: string) => (row: WorkRow) => row.standing.why_null?.[name] ?? "";
  const weighed = rows.some(({ standing }) => typeof standing.money === "number");
  const columns: WorkColumn[] = [
    { ...wordsColumn("cause", "Cause", causeText, causeOrder), about: "cause" },
    ...(since === "" ? [] : CHANGES),
    wordsColumn("action", "What to do", ({ loop }) => actionWords(loop.action.code)),
    wordsColumn("owner", "Owner", ({ loop }) => ownerWords(loop.action.owner)),
    figures("gain", "Gain (%)", "mending_gain", ({ standing }) => standing.share, estimate, why("share")),
    ...(weighed ? [figures("money", "Money per hour", "mending_money", ({ standing }) => standing.money, shortNumber, why("money"))] : []),
    { ...figures("effort", "Effort", null, ({ standing }) => standing.effort, effortWords), words: true, falls: false },
    figures("period", withUnit("Period", units.time), "period", ({ loop }) => loop.oscillation.period, shortNumber, () => NO_OSCILLATION),
    figures("automatic", "In automatic (%)", "in_automatic", ({ loop }) => loop.service.automatic, share, ({ loop }) => loop.service.why_null?.["automatic"] ?? ""),
    figures("limit", "At a limit (%)", "at_limit", atLimit, share),
    wordsColumn("record", "Record", recordText, recordOrder),
  ];
  // A figure that no loop has, such as the share in automatic without any column of the mode, takes no room.
  const idle = (["automatic", "limit", "record"] as const).filter((id) => !rows.some((row) => SAYS[id](row)));
  return columns.filter(({ id }) => !idle.some((other) => other === id));
}

export const nameColumn = wordsColumn("loop", "Loop", ({ loop }) => loop.tag);
const rankColumn = figures("rank", "#", null, ({ rank }) => rank, String);

/** Tags are written with and without hyphens. */
const plainTag = (tag: string): string => tag.toLowerCase().replaceAll(/[^\p{L}\p{N}]/gu, "");

const isShown = ({ cause, owner, text }: ListView) => {
  const wanted = plainTag(text);
  return ({ loop }: WorkRow): boolean =>
    (cause === "" || loop.cause.verdict === cause) &&
    (owner === "" || loop.action.owner === owner) &&
    plainTag(loop.tag).includes(wanted);
};

/** The rows of a view in its order. */
export function shownRows(rows: readonly WorkRow[], columns: readonly WorkColumn[], view: ListView): WorkRow[] {
  const { column: id, falling } = orderOf(view.sort || "rank");
  const column = [...columns, nameColumn, rankColumn].find((candidate) => candidate.id === id) ?? rankColumn;
  return sorted(rows.filter(isShown(view)), column, falling);
}

/** How many loops have each code, in a given order. */
export function counts(rows: readonly WorkRow[], code: (row: WorkRow) => string, order: (code: string) => number): [code: string, count: number][] {
  const found = new Map<string, number>();
  for (const row of rows) found.set(code(row), (found.get(code(row)) ?? 0) + 1);
  return [...found].sort(([a], [b]) => order(a) - order(b));
}

/** The loop to mend before this one, or null. */
export const mendedBefore = ({ standing }: WorkRow, rows: readonly WorkRow[]): WorkRow | null =>
  rows.find(({ place }) => place === standing.after) ?? null;

/** For a spreadsheet: figures without a sign that it would not read. */
function cellText(row: WorkRow, column: WorkColumn): string {
  const value = column.value(row);
  if (column.words) return column.figure(row).text;
  return value === null ? "" : column.figure(row).text.replaceAll("−", "-");
}

/** Rows as a table for a spreadsheet; `all`: the whole list, with loops to mend before them. */
export function workCsv(rows: readonly WorkRow[], columns: readonly WorkColumn[], all: readonly WorkRow[]): string {
  const head = ["#", nameColumn.label, ...columns.map(({ label }) => label), "Mend first", "Sentence"];
  const lines = rows.map((row) => [
    String(row.rank),
    row.loop.tag,
    ...columns.map((column) => cellText(row, column)),
    mendedBefore(row, all)?.loop.tag ?? "",
    row.loop.action.detail,
  ]);
  return csvText([head, ...lines]);
}
