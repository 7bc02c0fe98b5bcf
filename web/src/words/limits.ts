// The robustness limits that a result was designed for.
import type { Entry, Method } from "../api/types.ts";

export interface Limits {
  Ms: number | null;
  Mt: number | null;
  Mks: number | null;
}

const above = (value: unknown, floor: number): number | null =>
  typeof value === "number" && Number.isFinite(value) && value > floor ? value : null;

/** The limits for the entry's method, including defaults: the answer has them all among its options. */
export function limitsOf(entry: Entry | undefined): Limits {
  const options = entry?.options ?? {};
  return {
    Ms: above(options["Ms"], 1),
    Mt: above(options["Mt"], 1),
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

/** The value of an option that a request leaves out, from its method's description; null if it is not known. */
export function defaultOf(method: Method | undefined, option: string): number | null {
  const value = method?.options?.properties?.[option]?.default;
  return typeof value === "number" ? value : null;
}

/** The method whose limits apply by default. */
export const robustOf = (methods: readonly Method[]): Method | undefined => methods.find(({ id }) => id === "robust");
