// The recorded test that is being looked at outlives a reload of its tab, if the browser has room for it.
import type { IdentifyRequest } from "./api/types.ts";

const STORED_AS = "tunewright-record";
/** Browsers give a page about 5 MB. */
const MOST_CHARACTERS = 2_000_000;

export function rememberTest(test: IdentifyRequest | null): void {
  try {
    sessionStorage.removeItem(STORED_AS);
    const text = JSON.stringify(test);
    if (test && text.length <= MOST_CHARACTERS) sessionStorage.setItem(STORED_AS, text);
  } catch {
    // A browser without storage, or without room, forgets the record; nothing else depends on it.
  }
}

export function rememberedTest(): IdentifyRequest | null {
  try {
    const test: unknown = JSON.parse(sessionStorage.getItem(STORED_AS) ?? "null");
    const isTest = typeof test === "object" && test !== null && "record" in test && typeof test.record === "object";
    return isTest && test.record !== null ? (test as IdentifyRequest) : null;
  } catch {
    return null;
  }
}
