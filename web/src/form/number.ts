// Numbers as typed: "2,5", "1e-3", "−4". The text is never changed; a text that cannot be read gives a sentence.

export type Parsed<T> = { ok: true; value: T } | { ok: false; sentence: string };

const fail = (sentence: string): { ok: false; sentence: string } => ({ ok: false, sentence });
const NUMBER = /^[+-]?(\d+([.,]\d*)?|[.,]\d+)(e[+-]?\d+)?$/i;

const plain = (text: string): string => text.trim().replaceAll("−", "-");

/** One number. Decimal point or comma; no grouping, because "1,234" is ambiguous: it is read as 1.234. */
export function parseNumber(text: string, name: string): Parsed<number> {
  const tidy = plain(text);
  if (tidy === "") return fail(`${name} is empty. Write a number, for example 1.25.`);
  if (!NUMBER.test(tidy))
    return fail(`${name} "${text.trim()}" is not a number. Write for example 1.25, 1,25 or 1e-3.`);
  const value = Number(tidy.replace(",", "."));
  if (!Number.isFinite(value)) return fail(`${name} "${text.trim()}" is too large to be used.`);
  return { ok: true, value };
}

/** The items of a list: separated by spaces, semicolons, new lines, or commas that are followed by a space. */
function items(text: string): string[] {
  return text
    .replace(/,(?=\s)/g, " ")
    .split(/[\s;]+/)
    .filter((item) => item !== "");
}

/** A list of numbers, such as coefficients. */
export function parseNumbers(text: string, name: string): Parsed<number[]> {
  const tidy = plain(text).replace(/^\[|\]$/g, "");
  const list = items(tidy);
  if (list.length === 0) return fail(`${name} is empty. Write numbers with spaces between them, for example 1 2.5 1.`);
  if (list.length === 1 && list[0]!.includes(",")) {
    return fail(
      `${name} "${text.trim()}" may be one number or several. Put spaces between numbers, and write one number with a point.`,
    );
  }
  const values: number[] = [];
  for (const item of list) {
    const parsed = parseNumber(item, name);
    if (!parsed.ok)
      return fail(`In ${name}, "${item}" is not a number. Put spaces between numbers, for example 1 2.5 1.`);
    values.push(parsed.value);
  }
  return { ok: true, value: values };
}

/** Intervals by name, separated by semicolons: K 0.8 1.2; L 0.9 1.2. */
export function parseRanges(text: string, name: string): Parsed<Record<string, [number, number]>> {
  const ranges: Record<string, [number, number]> = {};
  for (const part of plain(text).split(/[;\n]/)) {
    const [symbol, ...numbers] = items(part);
    if (symbol === undefined) continue;
    const values = numbers.map((item) => parseNumber(item, symbol));
    const [low, high] = values;
    if (values.length !== 2 || !low?.ok || !high?.ok || !/^[A-Za-z]/.test(symbol))
      return fail(`${name}: "${part.trim()}" is not a range. Write K 0.8 1.2; L 0.9 1.2 for example.`);
    ranges[symbol] = [low.value, high.value];
  }
  return { ok: true, value: ranges };
}

/** A matrix: rows on separate lines or separated by semicolons, numbers separated by spaces. */
export function parseMatrix(text: string, name: string): Parsed<number[][]> {
  const rows = plain(text)
    .replace(/^\[|\]$/g, "")
    .split(/[;\n]/)
    .filter((row) => row.trim() !== "");
  if (rows.length === 0)
    return fail(`${name} is empty. Write its rows with semicolons between them, for example -1 0; 1 -2.`);
  const matrix: number[][] = [];
  for (const row of rows) {
    const parsed = row.trim().includes(" ") ? parseNumbers(row, name) : single(row, name);
    if (!parsed.ok) return parsed;
    matrix.push(parsed.value);
  }
  const width = matrix[0]!.length;
  const odd = matrix.findIndex((row) => row.length !== width);
  if (odd >= 0)
    return fail(
      `Row ${odd + 1} of ${name} has ${matrix[odd]!.length} numbers, the first has ${width}. Give all rows the same length.`,
    );
  return { ok: true, value: matrix };
}

function single(text: string, name: string): Parsed<number[]> {
  const parsed = parseNumber(text, name);
  return parsed.ok ? { ok: true, value: [parsed.value] } : parsed;
}

const COMPLEX = /^([+-]?[\d.,]+(?:e[+-]?\d+)?)?(?:([+-]|±)?([\d.,]*(?:e[+-]?\d+)?)[ij])?$/i;

/** Zeros or poles: "-1", "-1+2i", "-1±2i" (both of a pair). An empty text is an empty list. */
export function parseRoots(text: string, name: string): Parsed<(number | [number, number])[]> {
  const roots: (number | [number, number])[] = [];
  const tidy = plain(text)
    .replaceAll("+-", "±")
    .replace(/\s*([+±])\s*(?=[\d.,]*[ij])/gi, "$1");
  for (const item of items(tidy)) {
    const match = COMPLEX.exec(item);
    const bad = fail(`In ${name}, "${item}" is not a number. Write for example -1, -1+2i, or -1±2i for a pair.`);
    if (!match || item === "") return bad;
    const imaginaryOnly = /[ij]$/i.test(item) && match[2] === undefined && match[1] !== undefined;
    const real = imaginaryOnly ? 0 : Number((match[1] ?? "0").replace(",", "."));
    const imaginaryText = imaginaryOnly ? match[1]! : (match[3] ?? "");
    const hasImaginary = /[ij]$/i.test(item);
    const size = !hasImaginary ? 0 : imaginaryText === "" ? 1 : Number(imaginaryText.replace(",", "."));
    if (!Number.isFinite(real) || !Number.isFinite(size)) return bad;
    if (!hasImaginary || size === 0) roots.push(real);
    else if (match[2] === "±") roots.push([real, size], [real, -size]);
    else roots.push([real, match[2] === "-" ? -size : size]);
  }
  return { ok: true, value: roots };
}

/** Roots as typed. */
export const writeRoots = (value: unknown): string =>
  Array.isArray(value)
    ? value
        .map((root: unknown) =>
          Array.isArray(root)
            ? `${String(root[0])}${Number(root[1]) < 0 ? "-" : "+"}${Math.abs(Number(root[1]))}i`
            : String(root),
        )
        .join(" ")
    : "";
