// Notes on the figures: the methods' warnings, and how everything was computed and checked.
import type { Entry, Result } from "../api/types.ts";
import { h } from "../dom.ts";
import { formatNumber } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { plantTitle, plantWords } from "../words/plant.ts";

/** Writes the warnings of all entries; hides the card if there are none. */
export function showNotes(card: HTMLElement, entries: Entry[], names: string[]): void {
  const lines = entries.flatMap((entry, index) =>
    (entry.warnings ?? []).map((warning) => ({ name: names[index]!, warning })),
  );
  card.hidden = lines.length === 0;
  card.replaceChildren(
    h("h2", { id: "notes-title" }, lines.length === 1 ? "1 note" : `${lines.length} notes`),
    h(
      "ul",
      { class: "notes" },
      lines.map(({ name, warning }) =>
        h("li", {}, entries.length > 1 ? h("strong", {}, `${name}: `) : null, warning.detail),
      ),
    ),
  );
}

function checkWords(value: unknown): string {
  if (typeof value === "number") return formatNumber(value, 2);
  if (typeof value === "boolean") return value ? "yes" : "no";
  return String(value);
}

/** Name and value of the facts about an entry's computation. */
function factsOf(result: Result, entry: Entry, names: string[], units: UnitNames): [string, string][] {
  const facts: [string, string][] = [];
  const add = (name: string, value: string | undefined | null): void => {
    if (value) facts.push([name, value]);
  };
  add("Method", entry.title);
  add("Source", entry.source);
  const reduced = entry.reduced_model;
  if (reduced) add("Reduced model", `${plantTitle(reduced.type)}: ${plantWords(reduced, units)}`);
  add("Binding", entry.robustness?.binding);
  for (const [name, value] of Object.entries(entry.verification ?? {})) {
    if (value !== null && typeof value !== "object") add(name.replaceAll("_", " "), checkWords(value));
  }
  if (result.ranking && result.ranking.length > 1) {
    const order = result.ranking.map((index) => names[index]).join(", ");
    add("Ranking", result.ranking_by ? `${order} (${result.ranking_by})` : order);
  }
  if (typeof entry.compute_ms === "number") add("Computed in", `${formatNumber(entry.compute_ms, 2)} ms`);
  add("Version", result.version);
  add("Request hash", result.request_hash?.slice(0, 16));
  return facts;
}

export function showComputed(card: HTMLElement, result: Result, entry: Entry, names: string[], units: UnitNames): void {
  const open = card.querySelector("details")?.open ?? false;
  const facts = factsOf(result, entry, names, units).flatMap(([name, value]) => [
    h("dt", {}, name),
    h("dd", {}, value),
  ]);
  card.replaceChildren(
    h("details", { open }, h("summary", { id: "computed-title" }, "How it was computed"), h("dl", {}, facts)),
  );
}
