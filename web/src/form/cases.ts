// A list of cases on one line: "10; -5 initial.T 380; 10 parameters.k0 5e8" is three objects, each beginning with a
// number.
import { parseNumber } from "./number.ts";
import type { Parsed } from "./number.ts";

type Case = Record<string, unknown>;

/** `lead`: the member for the leading number. Others follow as name and number, nested members with a point. */
export function parseCases(text: string, name: string, lead: string): Parsed<Case[]> {
  const cases: Case[] = [];
  for (const part of text.split(/[;\n]/)) {
    const words = part.trim().split(/\s+/).filter(Boolean);
    if (words.length === 0) continue;
    const first = parseNumber(words[0]!, lead);
    const pairs = first.ok ? words.slice(1) : words;
    const entry: Case = first.ok ? { [lead]: first.value } : {};
    const bad = (): Parsed<Case[]> => ({
      ok: false,
      sentence: `${name}: "${part.trim()}" cannot be read. Write ${lead} first, then names with their numbers: 10; 10 initial.x 0.5 for example.`,
    });
    if (pairs.length % 2 === 1) return bad();
    for (let at = 0; at < pairs.length; at += 2) {
      const value = parseNumber(pairs[at + 1]!, pairs[at]!);
      if (!value.ok || !/^[A-Za-z_]/.test(pairs[at]!)) return bad();
      place(entry, pairs[at]!.split("."), value.value);
    }
    cases.push(entry);
  }
  return { ok: true, value: cases };
}

/** The cases as typed. */
export function writeCases(value: unknown, lead: string): string {
  if (!Array.isArray(value)) return "";
  return value
    .map((entry: Case) => [entry[lead], ...pairsOf(entry, lead)].filter((word) => word !== undefined).join(" "))
    .join("; ");
}

function pairsOf(entry: Case, lead: string, above = ""): string[] {
  return Object.entries(entry).flatMap(([name, value]): string[] => {
    if (above === "" && name === lead) return [];
    if (typeof value === "object" && value !== null) return pairsOf(value as Case, lead, `${above}${name}.`);
    return value === undefined || value === null ? [] : [`${above}${name} ${String(value)}`];
  });
}

/** Puts a value at its path; undefined is not put. */
export function place(target: Record<string, unknown>, path: string[], value: unknown): void {
  if (value === undefined) return;
  let at = target;
  for (const key of path.slice(0, -1)) {
    if (typeof at[key] !== "object" || at[key] === null) at[key] = {};
    at = at[key] as Record<string, unknown>;
  }
  at[path[path.length - 1]!] = value;
}

/** The value at a path, or undefined. */
export function pick(source: unknown, path: string[]): unknown {
  return path.reduce<unknown>(
    (at, key) => (typeof at === "object" && at !== null ? (at as Record<string, unknown>)[key] : undefined),
    source,
  );
}
