// The entries that are drawn, and their look in all plots.
import type { Entry, Result } from "../api/types.ts";
import type { Look } from "../plot/frame.ts";

export interface Drawn {
  index: number;
  name: string;
  look: Look;
  entry: Entry;
}

export const MAX_DRAWN = 4;

const GIVEN_NAMES: Record<string, string> = { baseline: "today", given: "by hand" };

/** Short names of the entries: the method, numbered where it occurs twice. */
export function entryNames(entries: Entry[]): string[] {
  const base = entries.map(({ method }) => GIVEN_NAMES[method] ?? method.replaceAll("_", " "));
  const distinguishing = base.map((name, index) => {
    if (base.filter((other) => other === name).length < 2) return name;
    const twins = entries.filter((_, at) => base[at] === name);
    const variants = twins.map(variantOf);
    if (variants.every((variant, at) => variant !== "" && variants.indexOf(variant) === at))
      return `${name} ${variantOf(entries[index]!)}`;
    const options = entries[index]!.options ?? {};
    const telling = Object.entries(options).find(
      ([key, value]) =>
        (typeof value === "number" || typeof value === "string") && twins.some((twin) => twin.options?.[key] !== value),
    );
    return telling ? `${name} ${telling[0]} ${String(telling[1])}` : name;
  });
  return distinguishing.map((name, index) => {
    const earlier = distinguishing.slice(0, index).filter((other) => other === name).length;
    return earlier === 0 ? name : `${name} #${earlier + 1}`;
  });
}

/** The text in the last brackets of a title: the variant of the method. */
const variantOf = (entry: Entry): string => /\(([^()]*)\)$/.exec(entry.title ?? "")?.[1] ?? "";

export const drawable = (entry: Entry | undefined): boolean =>
  Boolean(entry && !entry.error && (entry.responses || entry.frequency));

/** Entries to draw, the best first: one that oscillates without settling only if none settles. */
function worthDrawing(result: Result): number[] {
  const every = [...new Set([...(result.ranking ?? []), ...result.controllers.keys()])];
  const drawn = every.filter((index) => drawable(result.controllers[index]));
  const calm = drawn.filter((index) => result.controllers[index]!.standing?.settles !== false);
  return calm.length > 0 ? calm : drawn;
}

/** The entry that is shown first, according to the answer; for an older answer the one that its verdict names, or
    the first without an error. */
export const proposedEntry = ({ proposed, verdict, controllers }: Result): number =>
  proposed ?? verdict?.[0]?.figures?.["entry"] ?? Math.max(0, controllers.findIndex((entry) => !entry.error));

/** The best of the ranking and today's settings, at most four, in the order of the entries. */
export function defaultDrawn(result: Result): number[] {
  const entries = result.controllers;
  const today = entries.findIndex((entry) => entry.method === "baseline");
  const chosen = new Set<number>(today >= 0 && drawable(entries[today]) ? [today] : []);
  for (const index of worthDrawing(result)) {
    if (chosen.size >= MAX_DRAWN) break;
    chosen.add(index);
  }
  return [...chosen].sort((a, b) => a - b);
}

/** The two best of the ranking, or the best and today's settings. */
export function defaultOverlay(result: Result): number[] {
  const best = worthDrawing(result);
  const today = best.find((index) => result.controllers[index]!.method === "baseline");
  const others = best.filter((index) => index !== today);
  const chosen = today === undefined ? others.slice(0, 2) : [today, ...others.slice(0, 1)];
  return chosen.sort((a, b) => a - b);
}

/** Looks: today's settings are always series 2; the others take 1, 3, 4 (and 2 if it is free) in order. */
export function drawnEntries(result: Result, indices: number[]): Drawn[] {
  const names = entryNames(result.controllers);
  const shown = indices.filter((index) => drawable(result.controllers[index])).slice(0, MAX_DRAWN);
  const hasToday = shown.some((index) => result.controllers[index]!.method === "baseline");
  const free: Look[] = hasToday ? [1, 3, 4] : [1, 2, 3, 4];
  return shown.map((index) => {
    const entry = result.controllers[index]!;
    return { index, name: names[index]!, entry, look: entry.method === "baseline" ? 2 : free.shift()! };
  });
}
