// The same tuning request with another lambda for one of its entries.
import type { Result, TuneEntry, TuningRequest } from "../api/types.ts";

/** Options that say the same as lambda in another way. */
const IN_PLACE_OF_LAMBDA = ["Ms", "disturbance_peak", "dead_time_error"];

/** `index`: of the entry in the result, whose order is that of `tune`. */
export function withLambda(request: TuningRequest, result: Result, index: number, lambda: number): TuningRequest {
  const given = Array.isArray(request.tune) ? request.tune : everyMethod(result);
  const tune = given.map((entry, at): TuneEntry => {
    if (at !== index) return entry;
    const kept = Object.entries(entry).filter(([name]) => !IN_PLACE_OF_LAMBDA.includes(name));
    return { ...Object.fromEntries(kept), method: entry.method, lambda, curve: true };
  });
  return { ...request, tune };
}

/** "all" as the list that it stood for. */
const everyMethod = (result: Result): TuneEntry[] =>
  result.controllers.filter((entry) => entry.method !== "baseline").map((entry) => ({ method: entry.method }));
