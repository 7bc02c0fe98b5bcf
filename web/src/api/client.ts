// Calls to the service. Every failure becomes an ApiError with a sentence that can be shown as it is.
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

/** Addresses are relative to the page, so that a prefix before it does not matter. */
export async function call(
  method: string,
  path: string,
  body?: unknown,
  headers: Record<string, string> = {},
): Promise<Reply> {
  let response: Response;
  let text: string;
  try {
    response = await fetch(path.replace(/^\//, ""), {
      method,
      headers: {
        Accept: "application/json, application/problem+json",
        ...(body === undefined ? {} : { "Content-Type": "application/json" }),
        ...headers,
      },
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
    text = response.status === 304 ? "" : await response.text();
  } catch {
    throw new ApiError(
      { type: "not-connected", detail: "Not connected to the service. Nothing is lost; try again when it is back." },
      0,
    );
  }
  const etag = response.headers.get("ETag");
  if (response.status === 304) return { status: 304, data: null, etag };
  const data = parse(text);
  if (response.ok && data !== undefined) return { status: response.status, data, etag };
  if (response.ok && text === "") return { status: response.status, data: null, etag };
  throw new ApiError(problemOf(data, response.status), response.status, retryAfter(response));
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
