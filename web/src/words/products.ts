// Products in words: results of a search, the rows to type, the implemented loop next to the ideal one, evidence.
import type { AsEntered, Entry, Evidence, Implemented, Need, Notice, Product, ProductSummary } from "../api/types.ts";
import type { ExplainedName } from "./explained.ts";
import { explanationOfParameter } from "./explanation_of.ts";
import { plainText, searchText, searchWords } from "./search_text.ts";
import { DASH, formatNumber, formatParameter, formatPercent } from "./numbers.ts";

/** Products with every typed word in maker, name, family, id or parameters; first those whose name begins with it, then by
    maker. */
export function findProducts(products: readonly ProductSummary[], typed: string): ProductSummary[] {
  const wanted = searchWords(typed);
  const ranked = products.flatMap((product) => {
    const name = searchText(`${product.maker} ${product.name}`);
    const known = name + searchText(product.families.join(" "));
    const all = known + searchText(product.id) + searchText(product.parameters.join(" "));
    const ranks = [
      wanted.every((word) => name.includes(` ${word}`)),
      wanted.every((word) => known.includes(` ${word}`)),
      wanted.every((word) => known.includes(word)),
      wanted.every((word) => all.includes(word)),
    ];
    const rank = ranks.indexOf(true);
    return rank < 0 ? [] : [{ product, rank }];
  });
  const order = (a: ProductSummary, b: ProductSummary): number =>
    a.maker.localeCompare(b.maker) || a.name.localeCompare(b.name);
  return ranked.sort((a, b) => a.rank - b.rank || order(a.product, b.product)).map(({ product }) => product);
}

/** "Emerson DeltaV PID, FORM Series"; a maker whose name is part of the product's is not repeated. */
export const productTitle = ({ maker, name }: Pick<ProductSummary, "maker" | "name">): string =>
  plainText(name).startsWith(plainText(maker)) ? name : `${maker} ${name}`;

const NEED_WORDS: Record<Need, string> = {
  y_span: "the range of the measurement",
  u_span: "the range of the output",
  sample_time: "the sample time",
};

const RANGE_WORDS = " A range is the lowest and the highest value that the controller is set up for, such as 0 to 200 °C and 0 to 100 %.";

/** The missing facts, and the reason for each; "" for none. */
export function needSentence(missing: readonly Need[]): string {
  if (missing.length === 0) return "";
  const list = missing.map((need) => NEED_WORDS[need]).join(" and ");
  const why = missing.includes("sample_time")
    ? "its parameters use them"
    : "its gain is in percent or counts of them";
  return `Give ${list}: ${missing.length === 1 ? why.replace("them", "it") : why}. Until then designs are made for an ideal controller.${missing.some((need) => need !== "sample_time") ? RANGE_WORDS : ""}`;
}

/** A setting as typed. */
export interface TypedRow {
  name: string;
  label: string;
  value: string;
  unit: string;
  /** Range, step and remark, as details. */
  about: string;
  /** The explanation of its meaning, if there is one. */
  explains: ExplainedName | undefined;
}

/** In the order of the product's own list; other settings, such as the direction, after it. */
export function typedRows(product: Product, entered: AsEntered): TypedRow[] {
  const names = [
    ...product.parameters.map((parameter) => parameter.name).filter((name) => name in entered.as_typed),
    ...Object.keys(entered.as_typed).filter((name) => !product.parameters.some((item) => item.name === name)),
  ];
  return names.map((name) => {
    const parameter = product.parameters.find((item) => item.name === name);
    return {
      name,
      label: parameter?.label || name,
      value: entered.as_typed[name]!,
      unit: entered.units[name] ?? parameter?.unit ?? "",
      about: [parameter ? rangeWords(parameter) : (product.action.text ?? ""), parameter?.remark].filter(Boolean).join("; "),
      explains: parameter ? explanationOfParameter(parameter) : name === product.action.name ? "action" : undefined,
    };
  });
}

/** "0 to 1000, step 0.01". */
export function rangeWords({ low, high, resolution }: Pick<Product["parameters"][number], "low" | "high" | "resolution">): string {
  const range =
    low !== null && high !== null
      ? `${formatParameter(low)} to ${formatParameter(high)}`
      : low !== null
        ? `at least ${formatParameter(low)}`
        : high !== null
          ? `at most ${formatParameter(high)}`
          : "";
  return [range, resolution === null ? "" : `step ${formatParameter(resolution)}`].filter(Boolean).join(", ");
}

/** The text of "Copy all" for the clipboard. */
export const typedText = (title: string, rows: readonly TypedRow[]): string =>
  [title, ...rows.map(({ label, value, unit }) => `${label} = ${value}${unit ? ` ${unit}` : ""}`)].join("\n");

export interface BuiltRow {
  label: string;
  ideal: string;
  built: string;
  difference: string;
  /** The difference is so large that it is a different loop. */
  far: boolean;
}

const FIGURES = ["Ms", "load_IAE", "overshoot"] as const;
type BuiltFigure = (typeof FIGURES)[number];

const LABELS: Record<BuiltFigure, [label: string, name: string]> = {
  Ms: ["Ms", "Ms"],
  load_IAE: ["Load IAE", "the load IAE"],
  overshoot: ["Overshoot (%)", "the overshoot"],
};

/** The difference of the implemented loop from the ideal one: in percent, for the overshoot in percentage points;
    undefined in an answer that was kept before the service compared it. */
function differenceOf({ difference }: Implemented, figure: BuiltFigure): number | null | undefined {
  if (figure === "overshoot") return difference.overshoot_points;
  return difference[`${figure}_percent`];
}

function figureText({ robustness, performance }: Pick<Entry, "robustness" | "performance">, figure: BuiltFigure): string {
  if (figure === "Ms") return formatNumber(robustness?.Ms);
  if (figure === "load_IAE") return formatNumber(performance?.load?.["IAE"] as number | null | undefined);
  const percent = performance?.setpoint?.["overshoot_percent"];
  return typeof percent === "number" ? formatPercent(percent) : DASH;
}

/** Ms, load IAE and overshoot of the implemented loop next to those of the ideal one. A block without the design's
 * set-point weight or filter may overshoot by far more, at the same Ms. */
export function builtRows(ideal: Pick<Entry, "robustness" | "performance">, built: Implemented): BuiltRow[] {
  return FIGURES.flatMap((figure) => {
    const away = differenceOf(built, figure);
    if (figure === "overshoot" && away === null) return [];
    const difference = typeof away !== "number" ? DASH : `${signed(away)}${figure === "overshoot" ? "" : " %"}`;
    const far = built.difference.differs?.includes(figure) ?? false;
    return [{ label: LABELS[figure][0], ideal: figureText(ideal, figure), built: figureText(built, figure), difference, far }];
  });
}

/** "+2.9", "−0.4", "0.0": tenths of a percent are sufficient. */
function signed(percent: number): string {
  const text = Math.abs(percent).toFixed(Math.abs(percent) >= 100 ? 0 : 1);
  return Number(text) === 0 ? text : `${percent > 0 ? "+" : "−"}${text}`;
}

/** For results that were kept before the service named the figures that differ. */
const NOT_COMPARED = "Tuned by an older version: tune again to see whether the implemented loop differs from the ideal one.";

/** The difference of the implemented loop from the ideal one, if the service says that it is a different loop; else
    "". */
export function differenceSentence({ difference, ...built }: Implemented): string {
  if (difference.differs === undefined) return NOT_COMPARED;
  const parts = difference.differs.map((figure) => {
    const away = differenceOf({ ...built, difference }, figure)!;
    const unit = figure === "overshoot" ? "percentage points" : "%";
    return `${LABELS[figure][1]} ${Math.abs(away).toFixed(1)} ${unit} ${away > 0 ? "higher" : "lower"}`;
  });
  return parts.length === 0 ? "" : `The implemented loop differs from the ideal one: ${parts.join(", ")}.`;
}

/** The warnings of an entry that leave no loop to compare: unstable as implemented, or impossible to implement. */
export const builtTroubles = (entry: Pick<Entry, "warnings">): Notice[] =>
  (entry.warnings ?? []).filter(({ code }) => code === "unstable-as-built" || code === "not-as-built");

/** Sentences on how the loop was computed, and on its longest sample time; the verdict says whether it is too long. */
export function samplingSentences(
  { implemented, longest_sample_time: longest, verdict }: Pick<Entry, "implemented" | "longest_sample_time"> & Partial<Pick<Entry, "verdict">>,
  time: string,
): string[] {
  const sentences: string[] = [];
  const period = implemented?.sample_time ?? null;
  if (implemented)
    sentences.push(
      period === null
        ? "Evaluated as continuous, because no sample time is known."
        : `Evaluated with a sample every ${formatParameter(period)} ${time}.`,
    );
  if (typeof longest !== "number") return sentences;
  sentences.push(
    verdict?.some(({ code }) => code === "sample-time")
      ? `That is slow: up to ${formatNumber(longest)} ${time} would keep Ms within 5 % of that of the ideal loop.`
      : `Sampling up to every ${formatNumber(longest)} ${time} keeps Ms within 5 %.`,
  );
  return sentences;
}

const EVIDENCE: Record<string, string> = {
  read: "Read in the maker's code or text",
  partly: "Read in part, or in documents of third parties",
  unverified: "Not verified",
};

/** The part of a product's description that was read: a few words. */
export const evidenceWords = (level: string): string => EVIDENCE[level] ?? level;

/** The evidence as a sentence, with the names of the facts that were not read. */
export function evidenceSentence({ level, unverified }: Evidence): string {
  const rest = unverified.length > 0 ? ` Not verified: ${unverified.join("; ")}.` : "";
  return `${evidenceWords(level)}.${rest}${level === "read" ? "" : " Check the settings against your manual before you use them."}`;
}

/** The rows name their own units; times in the notes are in the loop's. */
export const noteTimes = (time: string): string => `Times in these notes are in ${time}, the loop's unit of time.`;

/** The deviations of the product, and the remarks on the computation. Notes of an older answer, which are not
    separated, all come first. */
export function splitNotes(notes: AsEntered["notes"]): Record<"deviations" | "remarks", AsEntered["notes"]> {
  const remark = ({ deviation }: AsEntered["notes"][number]): boolean => deviation === false;
  return { deviations: notes.filter((note) => !remark(note)), remarks: notes.filter(remark) };
}
