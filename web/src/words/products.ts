// Controllers as they are built, in words: what a search finds, the rows to type, the loop beside the ideal one, evidence.
import type { AsEntered, Evidence, Implemented, Need, Product, ProductSummary } from "../api/products.ts";
import type { Entry, Notice } from "../api/types.ts";
import { DASH, formatNumber, formatParameter, formatPercent } from "./numbers.ts";

/** Lower case, without what separates words in names. */
const plain = (text: string): string => text.toLowerCase().replaceAll(/[^a-z0-9]+/g, " ");

/** Those that have every typed word in maker, name, id or parameters; where the name begins with it first, then by maker. */
export function findProducts(products: readonly ProductSummary[], typed: string): ProductSummary[] {
  const wanted = plain(typed).split(" ").filter(Boolean);
  const ranked = products.flatMap((product) => {
    const name = plain(`${product.maker} ${product.name}`);
    const all = `${name} ${plain(product.id)} ${plain(product.parameters.join(" "))}`;
    if (!wanted.every((word) => all.includes(word))) return [];
    const inName = wanted.every((word) => ` ${name}`.includes(` ${word}`));
    return [{ product, rank: inName ? 0 : wanted.every((word) => name.includes(word)) ? 1 : 2 }];
  });
  const order = (a: ProductSummary, b: ProductSummary): number =>
    a.maker.localeCompare(b.maker) || a.name.localeCompare(b.name);
  return ranked.sort((a, b) => a.rank - b.rank || order(a.product, b.product)).map(({ product }) => product);
}

/** "Emerson DeltaV PID, FORM Series"; a maker that its product is named after is not said twice. */
export const productTitle = ({ maker, name }: Pick<ProductSummary, "maker" | "name">): string =>
  plain(name).startsWith(plain(maker).trim()) ? name : `${maker} ${name}`;

const NEED_WORDS: Record<Need, string> = {
  y_span: "the range of the measurement",
  u_span: "the range of the output",
  sample_time: "the sample time",
};

/** What is still to be given, and why; "" for nothing. */
export function needSentence(missing: readonly Need[]): string {
  if (missing.length === 0) return "";
  const list = missing.map((need) => NEED_WORDS[need]).join(" and ");
  const why = missing.includes("sample_time")
    ? "its parameters count in them"
    : "its gain is in percent or counts of them";
  return `Give ${list}: ${missing.length === 1 ? why.replace("them", "it") : why}. Until then designs are made for an ideal controller.`;
}

/** A setting as it is typed. */
export interface TypedRow {
  name: string;
  label: string;
  value: string;
  unit: string;
  /** Range, step and remark, for those who wonder. */
  about: string;
}

/** In the order of the product's own list; what else is set, such as the direction, after it. */
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

/** What "Copy all" puts on the clipboard. */
export const typedText = (title: string, rows: readonly TypedRow[]): string =>
  [title, ...rows.map(({ label, value, unit }) => `${label} = ${value}${unit ? ` ${unit}` : ""}`)].join("\n");

/** Beyond this share the loop as built is another one. */
const WORTH_SAYING_PERCENT = 2;

export interface BuiltRow {
  label: string;
  ideal: string;
  built: string;
  difference: string;
  /** More than 2 % away. */
  far: boolean;
}

/** Ms, load IAE and overshoot of the loop as built beside the ideal one's. */
export function builtRows(ideal: Pick<Entry, "robustness" | "performance">, built: Implemented): BuiltRow[] {
  const row = (label: string, before: unknown, after: unknown, percent: number | null): BuiltRow => ({
    label,
    ideal: formatNumber(before as number | null),
    built: formatNumber(after as number | null),
    difference: percent === null ? DASH : `${signed(percent)} %`,
    far: worthSaying(percent),
  });
  const { Ms_percent, load_IAE_percent } = built.difference;
  return [
    row("Ms", ideal.robustness?.Ms, built.robustness.Ms, Ms_percent),
    row("Load IAE", ideal.performance?.load?.["IAE"], built.performance.load?.["IAE"], load_IAE_percent),
    ...overshootRow(ideal, built),
  ];
}

const overshootOf = ({ performance }: Pick<Entry, "performance">): number | null => {
  const percent = performance?.setpoint?.["overshoot_percent"];
  return typeof percent === "number" ? percent : null;
};

/** How much more of the step the loop as built overshoots, in percent of the step; null where one of both is unknown. */
function moreOvershoot(ideal: Pick<Entry, "performance">, built: Implemented): number | null {
  const [before, after] = [overshootOf(ideal), overshootOf(built)];
  return before === null || after === null ? null : after - before;
}

/** A block without the design's set-point weight or filter may overshoot by far more, at the same Ms. */
function overshootRow(ideal: Pick<Entry, "performance">, built: Implemented): BuiltRow[] {
  const more = moreOvershoot(ideal, built);
  if (more === null) return [];
  const text = (of: Pick<Entry, "performance">): string => formatPercent(overshootOf(of)!);
  return [{ label: "Overshoot (%)", ideal: text(ideal), built: text(built), difference: signed(more), far: worthSaying(more) }];
}

const worthSaying = (percent: number | null): boolean => percent !== null && Math.abs(percent) > WORTH_SAYING_PERCENT;

/** "+2.9", "−0.4", "0.0": tenths of a percent are as much as anybody wants to know. */
function signed(percent: number): string {
  const text = Math.abs(percent).toFixed(Math.abs(percent) >= 100 ? 0 : 1);
  return Number(text) === 0 ? text : `${percent > 0 ? "+" : "−"}${text}`;
}

/** How far the loop as built lies from the ideal one, where that is worth saying; "" where it is not. */
export function differenceSentence(ideal: Pick<Entry, "performance">, built: Implemented): string {
  const { Ms_percent, load_IAE_percent } = built.difference;
  const differences: [name: string, percent: number | null, unit: string][] = [
    ["Ms", Ms_percent, "%"],
    ["the load IAE", load_IAE_percent, "%"],
    ["the overshoot", moreOvershoot(ideal, built), "percentage points"],
  ];
  const parts = differences.flatMap(([name, percent, unit]) =>
    worthSaying(percent) ? [`${name} ${Math.abs(percent!).toFixed(1)} ${unit} ${percent! > 0 ? "higher" : "lower"}`] : [],
  );
  return parts.length === 0 ? "" : `As built it is another loop: ${parts.join(", ")} than the ideal one's.`;
}

/** Of an entry's warnings those that leave no loop to compare: unstable as built, or not to be built at all. */
export const builtTroubles = (entry: Pick<Entry, "warnings">): Notice[] =>
  (entry.warnings ?? []).filter(({ code }) => code === "unstable-as-built" || code === "not-as-built");

/** How the loop was reckoned, and how slow it may be sampled. */
export function samplingSentences(
  built: Implemented | undefined,
  longest: number | null | undefined,
  time: string,
): string[] {
  const sentences: string[] = [];
  const period = built?.sample_time ?? null;
  if (built)
    sentences.push(
      period === null
        ? "Reckoned as continuous, because no sample time is known."
        : `Reckoned with a sample every ${formatParameter(period)} ${time}.`,
    );
  if (typeof longest !== "number") return sentences;
  sentences.push(
    period !== null && period > longest
      ? `That is slow: up to ${formatNumber(longest)} ${time} would keep Ms within 5 % of the ideal loop's.`
      : `Sampling up to every ${formatNumber(longest)} ${time} keeps Ms within 5 %.`,
  );
  return sentences;
}

const EVIDENCE: Record<string, string> = {
  read: "Read in the maker's code or text",
  partly: "Read in part, or in third parties' texts",
  unverified: "Not verified",
};

/** How much of a product's description was read: a few words. */
export const evidenceWords = (level: string): string => EVIDENCE[level] ?? level;

/** The same as a sentence, with what was not read by name. */
export function evidenceSentence({ level, unverified }: Evidence): string {
  const rest = unverified.length > 0 ? ` Not verified: ${unverified.join("; ")}.` : "";
  return `${evidenceWords(level)}.${rest}${level === "read" ? "" : " Check the settings against your manual before you use them."}`;
}

/** The rows name their own units; what the notes say is reckoned in the loop's. */
export const noteTimes = (time: string): string => `Times in these notes are in ${time}, the loop's unit of time.`;

/** Notes on how it was reckoned and what to know; every other one says what the block cannot be. */
const REMARKS = ["action", "clock", "default", "discretisation", "outside-the-twin", "unverified"];

export function splitNotes(notes: readonly Notice[]): { deviations: Notice[]; remarks: Notice[] } {
  const remark = (note: Notice): boolean => REMARKS.includes(note.code);
  return { deviations: notes.filter((note) => !remark(note)), remarks: notes.filter(remark) };
}
