// The same tuning request with another lambda for one of its entries.
import type { Result, TuneEntry, TuningRequest } from "../api/types.ts";

/** Options that say the same as lambda in another way. */
const IN_PLACE_OF_LAMBDA = ["Ms", "disturbance_peak", "dead_time_error"];

/** `index`: of the entry in the result, whose order is that of `tune`. */
export function withLambda(request: TuningRequest, result: Result, index: number, lambda: number): TuningRequest {
  const given =
    request.tune === undefined || asksForAll(request.tune) ? everyMethod(result) : (request.tune as TuneEntry[]);
  const tune = given.map((entry, at): TuneEntry => {
    if (at !== index) return entry;
    const kept = Object.entries(entry).filter(([name]) => !IN_PLACE_OF_LAMBDA.includes(name));
    return { ...Object.fromEntries(kept), method: entry.method, lambda, curve: true };
  });
  return { ...request, tune };
}

/** "all" as the list that it stood for, each variant with its options. */
const everyMethod = (result: Result): TuneEntry[] =>
  result.controllers
    .filter((entry) => entry.method !== "baseline")
    .map((entry) => ({
      method: entry.method,
      ...Object.fromEntries(Object.entries(entry.options ?? {}).filter(([, value]) => value !== null)),
    }));

/** Whether every method was asked for, in a word or as a method among others. */
export const asksForAll = (tune: TuningRequest["tune"]): boolean =>
  typeof tune === "string" || (tune ?? []).some((entry) => entry.method === "all");

export const EVERY_METHOD: TuneEntry[] = [{ method: "all" }];

/** The same subject, tuned by every method there is. */
export const byAllMethods = (request: TuningRequest): TuningRequest => ({ ...request, tune: EVERY_METHOD });
