// What a search over the whole page finds, best first.
import { plainText, searchText, searchWords, spellings } from "../words/search_text.ts";

export type FindKind = "action" | "screen" | "job" | "controller" | "method" | "document";

export interface Find {
  id: string;
  kind: FindKind;
  text: string;
  /** Shown next to the text, and searched too. */
  aside: string;
  /** Further words under which users look for it. */
  words?: string;
  go(): void;
}

const ORDER: readonly FindKind[] = ["action", "screen", "job", "controller", "method", "document"];
const MAX_FINDS = 60;

/** 0: its text begins with the typed one; 1: its text has every typed word; 2: its words together have; 3: somewhere
    inside a word; -1: not found. */
function rankOf({ text, aside, words = "" }: Find, typed: string, parts: readonly string[]): number {
  const name = searchText(text);
  const all = name + searchText(aside) + searchText(words);
  if (spellings(text).some((spelling) => spelling.startsWith(typed))) return 0;
  if (parts.every((part) => name.includes(` ${part}`))) return 1;
  if (parts.every((part) => all.includes(` ${part}`))) return 2;
  return parts.every((part) => all.includes(part)) ? 3 : -1;
}

/** With nothing typed; the screen may have many actions. */
const AT_FIRST: readonly FindKind[] = ["screen", "job", "action"];

/** Finds with every typed word, best first. */
export function search(finds: readonly Find[], typed: string): Find[] {
  const whole = plainText(typed);
  const parts = searchWords(typed);
  if (parts.length === 0) return AT_FIRST.flatMap((wanted) => finds.filter(({ kind }) => kind === wanted)).slice(0, MAX_FINDS);
  return finds
    .map((find) => ({ find, rank: rankOf(find, whole, parts) }))
    .filter(({ rank }) => rank >= 0)
    .sort((a, b) => a.rank - b.rank || ORDER.indexOf(a.find.kind) - ORDER.indexOf(b.find.kind))
    .map(({ find }) => find)
    .slice(0, MAX_FINDS);
}
