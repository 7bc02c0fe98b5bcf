// The recorded test that is being looked at outlives a reload of its tab, if the browser has room for it.
import type { IdentifyRequest } from "./api/types.ts";

const STORED_AS = "tunewright-record";
/** Browsers give a page about 5 MB. */
const MAX_CHARACTERS = 2_000_000;

export function rememberTest(test: IdentifyRequest | null): void {
  try {
    sessionStorage.removeItem(STORED_AS);
    const text = JSON.stringify(test);
    if (test && text.length <= MAX_CHARACTERS) sessionStorage.setItem(STORED_AS, text);
  } catch {
    // A browser without storage, or without room, forgets the record; nothing else depends on it.
  }
}

export function rememberedTest(): IdentifyRequest | null {
  try {
    return readTest(JSON.parse(sessionStorage.getItem(STORED_AS) ?? "null"));
  } catch {
    return null;
  }
}

const isObject = (value: unknown): value is Record<string, unknown> => typeof value === "object" && value !== null;

/** What stands in the storage may be an older page's, or anybody's. */
export function readTest(data: unknown): IdentifyRequest | null {
  return isObject(data) && isObject(data["record"]) ? (data as unknown as IdentifyRequest) : null;
}
