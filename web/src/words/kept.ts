// Compares a design that was kept with the one that was on the screen, and lists the differences.
import { settingsOf } from "../api/evaluate.ts";
import type { Entry, Job } from "../api/types.ts";
import { formatSetting } from "./numbers.ts";

/** Every setting by its name, including those of a filter and those to type into the product. */
function settingsByName(entry: Entry): Map<string, unknown> {
  const all = new Map<string, unknown>();
  const take = (prefix: string, values: object): void => {
    for (const [name, value] of Object.entries(values))
      if (value !== null && typeof value === "object" && !Array.isArray(value)) take(`${prefix}${name} `, value);
      else all.set(`${prefix}${name}`, value);
  };
  if (entry.controller) take("", settingsOf(entry.controller));
  if (entry.as_entered?.settings) take("typed ", entry.as_entered.settings);
  return all;
}

const shown = (value: unknown): string =>
  typeof value === "number" ? formatSetting(value) : value === undefined || value === null ? "none" : String(value);

/** "" if the job's entry has exactly the same settings, or is not there yet. */
export function keptOtherwise(before: Entry, job: Job, index: number): string {
  const after = job.result?.controllers[index];
  if (!after?.controller) return "";
  const [was, is] = [settingsByName(before), settingsByName(after)];
  const differing = [...new Set([...was.keys(), ...is.keys()])].filter((name) => was.get(name) !== is.get(name));
  if (differing.length === 0) return "";
  const words = differing.map((name) => `${name} ${shown(was.get(name))} is now ${shown(is.get(name))}`).join(", ");
  const why = job.result?.partial
    ? "the search was stopped before its end"
    : `the service, version ${job.result?.version ?? "unknown"}, recalculated it`;
  return `The kept design differs from the one shown: ${words}; ${why}. The kept design is shown now.`;
}
