// What survives a reload of its tab, if the browser has room for it: the current recorded test, and the request that a
// screen hands to the API's page.
import type { IdentifyRequest } from "./api/types.ts";

const STORED_AS = "tunewright-record";
/** Browsers allow a page about 5 MB. */
const MAX_CHARACTERS = 2_000_000;

export function rememberTest(test: IdentifyRequest | null): void {
  try {
    sessionStorage.removeItem(STORED_AS);
    // Writing a long one only to measure it would halt the page.
    if (!test || (test.record.csv?.length ?? 0) > MAX_CHARACTERS) return;
    const text = JSON.stringify(test);
    if (text.length <= MAX_CHARACTERS) sessionStorage.setItem(STORED_AS, text);
  } catch {
    // Without storage or room the record is lost on a reload; nothing else depends on it.
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

/** The stored text may come from an older page, or from elsewhere. */
export function readTest(data: unknown): IdentifyRequest | null {
  return isObject(data) && isObject(data["record"]) ? (data as unknown as IdentifyRequest) : null;
}

export interface CarriedRequest {
  /** Of its call, such as "v1/jobs". */
  path: string;
  request: unknown;
}

const CARRIED_AS = "tunewright-carried";
let carried: CarriedRequest | null = null;

export function carry(request: CarriedRequest): void {
  carried = request;
  try {
    sessionStorage.setItem(CARRIED_AS, JSON.stringify(request));
  } catch {
    // Without storage or room it is lost on a reload.
  }
}

export function carriedRequest(): CarriedRequest | null {
  try {
    carried ??= JSON.parse(sessionStorage.getItem(CARRIED_AS) ?? "null") as CarriedRequest | null;
  } catch {
    carried = null;
  }
  return typeof carried?.path === "string" ? carried : null;
}
