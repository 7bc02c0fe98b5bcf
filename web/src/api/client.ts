// Calls to the service. Every failure becomes an ApiError with a sentence that can be shown as it is.
import { currentKey, otherKey } from "./key.ts";
import type { Problem } from "./types.ts";

export class ApiError extends Error {
  constructor(
    readonly problem: Problem,
    readonly status: number,
    readonly retryAfter: number | null = null,
  ) {
    super(problem.detail || problem.title || "The service refused the request.");
  }
}

export interface Reply {
  status: number;
  data: unknown;
  etag: string | null;
}

/** Asks for the service's key where it wants one, and calls again. */
export async function call(
  method: string,
  path: string,
  body?: unknown,
  headers: Record<string, string> = {},
): Promise<Reply> {
  let key = currentKey();
  let { response, text } = await send(method, path, body, headers, key);
  while (response.status === 401) {
    key = await otherKey(key);
    if (key === null) break;
    ({ response, text } = await send(method, path, body, headers, key));
  }
  const etag = response.headers.get("ETag");
  if (response.status === 304) return { status: 304, data: null, etag };
  const data = parse(text);
  if (response.ok && data !== undefined) return { status: response.status, data, etag };
  if (response.ok && text === "") return { status: response.status, data: null, etag };
  throw new ApiError(problemOf(data, response.status), response.status, retryAfter(response));
}

/** Addresses are relative to the page, so that a prefix before it does not matter. */
async function send(
  method: string,
  path: string,
  body: unknown,
  headers: Record<string, string>,
  key: string | null,
): Promise<{ response: Response; text: string }> {
  try {
    const response = await fetch(path.replace(/^\//, ""), {
      method,
      headers: {
        Accept: "application/json, application/problem+json",
        ...(body === undefined ? {} : { "Content-Type": "application/json" }),
        ...(key === null ? {} : { Authorization: `Bearer ${key}` }),
        ...headers,
      },
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
    return { response, text: response.status === 304 ? "" : await response.text() };
  } catch {
    throw new ApiError(
      { type: "not-connected", detail: "Not connected to the service. Nothing is lost; try again when it is back." },
      0,
    );
  }
}

function parse(text: string): unknown {
  try {
    return JSON.parse(text) as unknown;
  } catch {
    return undefined;
  }
}

function problemOf(data: unknown, status: number): Problem {
  if (typeof data === "object" && data !== null) return data as Problem;
  return { status, title: "Unexpected answer", detail: `The service answered ${status} without an explanation.` };
}

function retryAfter(response: Response): number | null {
  const seconds = Number(response.headers.get("Retry-After") ?? "");
  return Number.isFinite(seconds) && seconds > 0 ? seconds : null;
}
