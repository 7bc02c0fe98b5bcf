// The names in a recorded file: the units of its columns, and the tag that they share. And the range of u that its unit
// or its values tell.
import type { Preview, PreviewColumn, RecordedTest, Span } from "../api/types.ts";

export interface RecordNames {
  /** "" if the file does not say. */
  u: string;
  y: string;
  tag: string;
}

const SEPARATOR = /[._/:\- ]/;

/** "TIC101" of "TIC101.PV" and "TIC101.OP"; "" if the headings share no such part. */
function sharedTag(headings: readonly string[]): string {
  const [first = "", ...others] = headings;
  let tag = "";
  for (let end = 1; end < first.length; end += 1)
    if (SEPARATOR.test(first[end]!) && others.every((other) => other.startsWith(first.slice(0, end + 1)))) tag = first.slice(0, end);
  return others.length > 0 ? tag.trim() : "";
}

/** What a file names. The unit of its times is left to the service. */
export function namesOf({ columns }: Pick<Preview, "columns">): RecordNames {
  const of = (guess: PreviewColumn["guess"]): PreviewColumn | undefined => columns.find((column) => column.guess === guess);
  const [u, y] = [of("u"), of("y")];
  return { u: u?.unit ?? "", y: y?.unit ?? "", tag: u && y ? sharedTag([y.heading, u.heading]) : "" };
}

/** True if it records a loop: set point, measurement and output. */
export const isOfLoop = ({ columns }: Pick<Preview, "columns">): boolean =>
  (["r", "y", "u"] as const).every((role) => columns.some((column) => column.guess === role));

/** Percent are percent of a whole range; an output without a unit that stays between 0 and 1 is a share of it. */
export function usualSpan(unit: string, values: readonly (number | null)[] = []): Span | undefined {
  if (unit === "%") return [0, 100];
  const share = values.length > 0 && values.every((value) => value === null || (value >= 0 && value <= 1));
  return unit === "" && share ? [0, 1] : undefined;
}

/** True if they have the same samples and are read in the same way. */
export function sameRecord(a: RecordedTest, b: RecordedTest): boolean {
  const { csv: first, ...read } = a;
  const { csv: second, ...other } = b;
  return first === second && JSON.stringify(read) === JSON.stringify(other);
}
