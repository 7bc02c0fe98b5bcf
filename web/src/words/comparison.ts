// The comparison as data: its rows in order, its columns with their figures. No DOM.
import type { Entry, Result, WhyNull } from "../api/types.ts";
import { limitNote } from "./figures.ts";
import type { ExplainedName } from "./explained.ts";
import { figureUnit } from "./figure_units.ts";
import { formatNumber, formatPercent, withUnit } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";
import { running } from "./running.ts";

export interface ComparisonRow {
  /** Position of the entry in the result. */
  index: number;
  name: string;
  entry: Entry;
  /** From 1, among the methods that hold their limits; null for others and for today's settings. */
  rank: number | null;
  /** The reason why there is no rank, or "". */
  why: string;
}

export interface ComparisonFigure {
  value: number | null;
  /** As displayed; "" if there is no number. */
  text: string;
  /** The reason why there is no number, or "". */
  why: string;
}

export interface ComparisonColumn {
  id: string;
  label: string;
  meaning: string;
  /** Its longer explanation. */
  about: ExplainedName;
  /** Among the columns that are shown at first. */
  main: boolean;
  figure(entry: Entry): ComparisonFigure;
}

export interface ComparisonOrder {
  /** A column's id, "rank" or "method". */
  column: string;
  falling: boolean;
}

type Part = { why_null?: WhyNull } | undefined;

const NOT_GIVEN = "The service gave no figure.";

function figureOf(part: Part, name: string, absent: string, format = (value: number) => formatNumber(value)) {
  const value = (part as Record<string, unknown> | undefined)?.[name];
  if (typeof value === "number" && Number.isFinite(value)) return { value, text: format(value), why: "" };
  return { value: null, text: "", why: part?.why_null?.[name] ?? absent };
}

/** True if the service compared a design with the optimum: else the load IAE ranks them. */
export const isCompared = ({ controllers }: Result): boolean =>
  controllers.some(({ optimum_at_Ms }) => typeof optimum_at_Ms?.excess_percent === "number");

/** "+12.3"; the optimum itself, within the accuracy of its search, is "0". */
export function excessText(percent: number): string {
  const text = formatPercent(percent);
  return percent > 0 && text !== "0" ? `+${text}` : text;
}

const stable = (entry: Entry): boolean => entry.robustness?.stable === true;
/** True if both responses settle at their targets. */
export const settles = (entry: Entry): boolean => entry.standing?.settles ?? stable(entry);

/** The explanations of columns with an id of their own. */
const ABOUT = {
  phase_margin: "phase_margin_deg",
  load_IAE: "IAE",
  load_peak: "peak",
  load_TV: "TV",
  setpoint_IAE: "IAE",
  overshoot: "overshoot_percent",
  settling: "settling_time",
} as const satisfies Record<string, ExplainedName>;

/** Every column except rank, method and notes, in their order. */
export function comparisonColumns(units: UnitNames): ComparisonColumn[] {
  const gain = figureUnit("IdealController", "Kp", units);
  const error = figureUnit("LoadPerformance", "IAE", units);
  const column = (
    id: ExplainedName | keyof typeof ABOUT,
    label: string,
    meaning: string,
    main: boolean,
    figure: (entry: Entry) => ComparisonFigure,
  ): ComparisonColumn => ({ id, label, meaning, about: id in ABOUT ? ABOUT[id as keyof typeof ABOUT] : (id as ExplainedName), main, figure });
  const of = (part: (entry: Entry) => Part, name: string, absent = NOT_GIVEN, format?: (value: number) => string) => {
    return (entry: Entry): ComparisonFigure =>
      !entry.error && !stable(entry) && absent === NOT_GIVEN
        ? { value: null, text: "", why: part(entry)?.why_null?.[name] ?? "The loop is unstable." }
        : figureOf(part(entry), name, absent, format);
  };
  const controller = (entry: Entry): Part => entry.controller as Part;
  const robustness = (entry: Entry): Part => running(entry).robustness;
  const loadStep = (entry: Entry): Part => running(entry).performance?.load;
  const setpoint = (entry: Entry): Part => running(entry).performance?.setpoint;
  return [
    column("Kp", withUnit("Kp", gain), "proportional gain", true, of(controller, "Kp", "no proportional action")),
    column("Ti", withUnit("Ti", units.time), "integral time", true, of(controller, "Ti", "no integral action")),
    column("Td", withUnit("Td", units.time), "derivative time", true, of(controller, "Td", "no derivative action")),
    column("Tf", withUnit("Tf", units.time), "filter time constant", false, filterTime),
    column("Ms", "Ms", "peak of |S|: the smaller, the more robust", true, of(robustness, "Ms")),
    column("Mt", "Mt", "peak of |T|", true, of(robustness, "Mt")),
    column("gain_margin", "Gain margin", "the loop gain may grow by this factor", true, of(robustness, "gain_margin")),
    column("phase_margin", "Phase margin (°)", "smallest of all crossings", true, of(robustness, "phase_margin_deg")),
    column(
      "delay_margin",
      withUnit("Delay margin", units.time),
      "the loop is stable with this much more dead time",
      false,
      of(robustness, "delay_margin"),
    ),
    column(
      "load_IAE",
      withUnit("IAE load", error),
      "integrated absolute error after a load step",
      true,
      of(loadStep, "IAE"),
    ),
    column(
      "excess",
      "+% over optimum*",
      "of the load IAE over that of the robust PID whose limits on Ms and Mt are both this row's Ms",
      true,
      (entry) => figureOf(entry.optimum_at_Ms, "excess_percent", "It was not compared with the optimum.", excessText),
    ),
    column("load_peak", withUnit("Load peak", units.y), "largest deviation, signed", false, of(loadStep, "peak")),
    column("load_TV", withUnit("TV load", units.u), "total movement of u after a load step", false, of(loadStep, "TV")),
    column(
      "setpoint_IAE",
      withUnit("IAE set point", error),
      "integrated absolute error after a set-point step",
      true,
      of(setpoint, "IAE"),
    ),
    column(
      "overshoot",
      "Overshoot (%)",
      "of the set-point step; in brackets the limit",
      true,
      (entry) => {
        const reached = of(setpoint, "overshoot_percent", NOT_GIVEN, formatPercent)(entry);
        return { ...reached, text: reached.text && reached.text + limitNote(entry) };
      },
    ),
    column(
      "settling",
      withUnit("Settling", units.time),
      "last time outside 2 % of the set-point step",
      false,
      of(setpoint, "settling_time"),
    ),
    column("TV", withUnit("TV", units.u), "total movement of u after a set-point step", true, of(setpoint, "TV")),
    column("Mks", withUnit("Mks", gain), "peak of |CS|: how much noise may reach u", true, of(robustness, "Mks")),
  ];
}

function filterTime(entry: Entry): ComparisonFigure {
  const { filter, Td } = entry.controller ?? {};
  const value =
    typeof filter?.Tf === "number"
      ? filter.Tf
      : typeof filter?.N === "number" && filter.N > 0 && typeof Td === "number"
        ? Td / filter.N
        : null;
  return value === null ? { value, text: "", why: "no filter" } : { value, text: formatNumber(value), why: "" };
}

/** Names in the table: the method's title with its variant, without an earlier text in brackets. */
export function comparisonNames(entries: Entry[]): string[] {
  const full = entries.map((entry) =>
    entry.method === "baseline" ? "Today's settings" : entry.title || entry.method.replaceAll("_", " "),
  );
  const short = full.map((title) => title.replace(/ \([^()]*\)(?= \([^()]*\)$)/, ""));
  const titles = short.map((title, index) =>
    short.indexOf(title) === short.lastIndexOf(title) ? title : full[index]!,
  );
  return titles.map((title, index) => {
    const earlier = titles.slice(0, index).filter((other) => other === title).length;
    return earlier === 0 ? title : `${title} #${earlier + 1}`;
  });
}

/** True if the entry ranks under this limit on Ms; null: the limit of its own answer. */
function holds(entry: Entry, limit: number | null): boolean {
  const { standing, error } = entry;
  const { least_limit: least, group } = standing ?? {};
  if (limit === null || least === undefined) return !error && (group ? group === "holds" : stable(entry) && !standing?.why);
  return least !== null && least <= limit;
}

/** Rows in the service's order: first those that rank under this limit on Ms, then the rest, then those without an
    answer. */
export function comparisonRows(result: Result, limit: number | null): ComparisonRow[] {
  const names = comparisonNames(result.controllers);
  const ranking = result.ranking ?? [];
  const order = ({ standing }: Entry, index: number): number =>
    standing?.order ?? (ranking.includes(index) ? ranking.indexOf(index) : Infinity);
  const rows = result.controllers.map((entry, index) => ({ entry, index, held: holds(entry, limit), order: order(entry, index) }));
  rows.sort((a, b) => Number(b.held) - Number(a.held) || compare(a.order, b.order));
  let last = 0;
  return rows.map(({ entry, index, held }): ComparisonRow => {
    const ranked = held && entry.method !== "baseline";
    if (ranked) last += 1;
    return { index, name: names[index]!, entry, rank: ranked ? last : null, why: ranked ? "" : noRank(entry, held, limit) };
  });
}

function noRank({ error, standing }: Entry, held: boolean, limit: number | null): string {
  if (error) return "No answer.";
  if (held) return "Today's settings, for comparison.";
  const otherwise = limit !== null && typeof standing?.least_limit === "number";
  return otherwise ? `Ms is above ${formatNumber(limit)}.` : (standing?.why ?? "");
}

const compare = (a: number, b: number): number => (a === b ? 0 : a < b ? -1 : 1);

/** The rows with an answer, sorted by a column; rows without a number are last in either direction. */
export function sortRows(rows: ComparisonRow[], order: ComparisonOrder, columns: ComparisonColumn[]): ComparisonRow[] {
  const sign = order.falling ? -1 : 1;
  if (order.column === "rank") return order.falling ? [...rows].reverse() : rows;
  if (order.column === "method") return [...rows].sort((a, b) => sign * a.name.localeCompare(b.name, "en"));
  const column = columns.find((candidate) => candidate.id === order.column);
  if (!column) return rows;
  const value = new Map(rows.map((row) => [row, column.figure(row.entry).value]));
  return [...rows].sort((a, b) => {
    const [p, q] = [value.get(a) ?? null, value.get(b) ?? null];
    if (p === null || q === null) return p === q ? 0 : p === null ? 1 : -1;
    return sign * compare(p, q);
  });
}

/** "outside validity, no derivative": the subjects of an entry's remarks; "unstable" first. */
export function notesSummary(entry: Entry): string {
  const words = (entry.warnings ?? []).map((warning) => warning.code.replaceAll(/[-_]/g, " "));
  return [...new Set([...(entry.robustness && !stable(entry) ? ["unstable"] : []), ...words])].join(", ");
}

/** The reason why a method has no answer. */
export const reasonOf = (entry: Entry): string => entry.error?.detail ?? entry.error?.title ?? "It gave no reason.";

/** The whole table for a file: every column, all digits, remarks and reasons in words. */
export function comparisonTable(rows: ComparisonRow[], columns: ComparisonColumn[]): (string | number | null)[][] {
  const header = ["rank", "method", "title", ...columns.map((column) => column.label.replace("*", "")), "notes"];
  const notes = (entry: Entry): string =>
    entry.error ? reasonOf(entry) : (entry.warnings ?? []).map((warning) => warning.detail).join(" ");
  return [
    header,
    ...rows.map((row) => [
      row.rank,
      row.entry.method,
      row.name,
      ...columns.map((column) => (row.entry.error ? null : column.figure(row.entry).value)),
      notes(row.entry),
    ]),
  ];
}

/** The order in an address: "Ms" ascends, "-Ms" descends, "" is the ranking. */
export function orderOf(text: string): ComparisonOrder {
  const falling = text.startsWith("-");
  return { column: (falling ? text.slice(1) : text) || "rank", falling };
}

export const sortText = ({ column, falling }: ComparisonOrder): string =>
  column === "rank" && !falling ? "" : `${falling ? "-" : ""}${column}`;
