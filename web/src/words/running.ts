// The loop that runs: that of the user's own controller where it is known, else the ideal one.
import type { Entry } from "../api/types.ts";

/** The entry with the figures and responses of the loop that runs; its curves over frequency remain the ideal loop's. */
export function running(entry: Entry): Entry {
  const { implemented } = entry;
  if (!implemented) return entry;
  const { robustness, performance, responses, region } = implemented;
  const { responses: _responses, region: _region, ...rest } = entry;
  return { ...rest, robustness, performance, ...(responses ? { responses } : {}), ...(region ? { region } : {}) };
}
