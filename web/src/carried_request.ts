// The request that a screen hands to the API's page; it survives a reload of its tab.

export interface CarriedRequest {
  /** Of its call, such as "v1/jobs". */
  path: string;
  request: unknown;
}

const STORED_AS = "tunewright-carried";
let carried: CarriedRequest | null = null;

export function carry(request: CarriedRequest): void {
  carried = request;
  try {
    sessionStorage.setItem(STORED_AS, JSON.stringify(request));
  } catch {
    // Without storage or room it is lost on a reload.
  }
}

export function carriedRequest(): CarriedRequest | null {
  try {
    carried ??= JSON.parse(sessionStorage.getItem(STORED_AS) ?? "null") as CarriedRequest | null;
  } catch {
    carried = null;
  }
  return typeof carried?.path === "string" ? carried : null;
}
