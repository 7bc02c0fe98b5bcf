// The robustness limits that a result was designed for.
import type { Entry } from "../api/types.ts";

export interface Limits {
  Ms: number | null;
  Mt: number | null;
  Mks: number | null;
}

const above = (value: unknown, floor: number): number | null =>
  typeof value === "number" && Number.isFinite(value) && value > floor ? value : null;

/** What the entry's method was asked to hold; `robust` holds 1.4 by default. */
export function limitsOf(entry: Entry | undefined): Limits {
  const options = entry?.options ?? {};
  const standard = entry?.method === "robust" ? 1.4 : null;
  return {
    Ms: above(options["Ms"], 1) ?? standard,
    Mt: above(options["Mt"], 1) ?? standard,
    Mks: above(options["Mks"], 0),
  };
}

/** The limits of the first entry that has any. */
export function commonLimits(entries: Entry[]): Limits {
  const limited = entries
    .map(limitsOf)
    .find((limits) => limits.Ms !== null || limits.Mt !== null || limits.Mks !== null);
  return limited ?? { Ms: null, Mt: null, Mks: null };
}
