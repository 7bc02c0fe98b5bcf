// Calls to the service. Every failure becomes an ApiError with a sentence that can be shown directly.
import { currentKey, otherKey } from "./key.ts";
import { untilReleased } from "./press.ts";
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

/** The failure as a sentence for the reader. */
export const sentenceOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

const LOST_WAIT_MS = 2000;

/** The time to wait before a failed call is repeated; null if the answer would be the same. */
export function waitAfter(error: unknown): number | null {
  if (!(error instanceof ApiError)) return LOST_WAIT_MS;
  if (error.status >= 400 && error.status < 500 && error.status !== 429) return null;
  return error.retryAfter ? error.retryAfter * 1000 : LOST_WAIT_MS;
}

const isLost = (error: unknown): boolean => error instanceof ApiError && error.status === 0;

/** Calls `go` when the service answers again, if `error` is that of a call that did not reach it. */
export async function whenBack(error: unknown, go: () => void): Promise<void> {
  if (!isLost(error)) return;
  for (;;) {
    await new Promise((over) => setTimeout(over, LOST_WAIT_MS));
    const answered = await call("GET", "healthz").then(
      () => true,
      (again: unknown) => !isLost(again),
    );
    if (answered) return go();
  }
}

export interface Reply {
  status: number;
  data: unknown;
  etag: string | null;
}

/** `signal` aborts the call. */
export async function call(
  method: string,
  path: string,
  body?: unknown,
  headers: Record<string, string> = {},
  signal?: AbortSignal,
): Promise<Reply> {
  const { response, text } = await answerOf(method, path, body, headers, signal);
  const etag = response.headers.get("ETag");
  if (response.status === 304) return { status: 304, data: null, etag };
  const data = parse(text);
  if (response.ok && data !== undefined) return { status: response.status, data, etag };
  if (response.ok && text === "") return { status: response.status, data: null, etag };
  throw new ApiError(problemOf(data, response.status), response.status, retryAfter(response));
}

export interface TextFile {
  text: string;
  /** The file name that the service gives; "" if it gives none. */
  name: string;
}

/** A text file; a refusal is a problem, as with other calls. */
export const getText = (path: string): Promise<TextFile> => textOf("GET", path, undefined);
export const postText = (path: string, body: unknown): Promise<TextFile> => textOf("POST", path, body);

async function textOf(method: string, path: string, body: unknown): Promise<TextFile> {
  const { response, text } = await answerOf(method, path, body, { Accept: "text/*, application/problem+json" });
  if (!response.ok) throw new ApiError(problemOf(parse(text), response.status), response.status, retryAfter(response));
  const name = /filename="([^"]+)"/.exec(response.headers.get("Content-Disposition") ?? "")?.[1];
  return { text, name: name ?? "" };
}

interface Answer {
  response: Response;
  text: string;
}

/** The answer as it is, a refusal too. Asks for the service's key if it is required, and repeats the call. */
export async function answerOf(
  method: string,
  path: string,
  body: unknown,
  headers: Record<string, string>,
  signal?: AbortSignal,
): Promise<Answer> {
  let key = currentKey();
  let answer = await send(method, path, body, headers, key, signal);
  while (answer.response.status === 401) {
    key = await otherKey(key);
    if (key === null) break;
    answer = await send(method, path, body, headers, key, signal);
  }
  return answer;
}

/** Longer texts are written in slices: the page would not react while it writes millions of characters. */
const SLICE = 250_000;

/** The page draws and reacts in between. */
const pause = (): Promise<void> => new Promise((over) => setTimeout(over, 0));

/** JSON of a body, whose record may be a text of megabytes. */
export async function bodyOf(body: unknown): Promise<BodyInit> {
  if (body instanceof Blob) return body;
  const { record, csv: bare } = (body ?? {}) as { record?: { csv?: string }; csv?: string };
  const csv = record?.csv ?? bare;
  if (typeof csv !== "string" || csv.length <= SLICE) return JSON.stringify(body);
  // It stands last, where its beginning is known.
  const { csv: _csv, ...others } = (record ?? body) as Record<string, unknown>;
  const inside = { ...others, csv: "" };
  const { record: _record, ...around } = body as Record<string, unknown>;
  const head = JSON.stringify(record ? { ...around, record: inside } : inside);
  const parts: string[] = [head.slice(0, record ? -3 : -2)];
  for (let at = 0; at < csv.length; at += SLICE) {
    parts.push(JSON.stringify(csv.slice(at, at + SLICE)).slice(1, -1));
    await pause();
  }
  return new Blob([...parts, record ? '"}}' : '"}'], { type: "application/json" });
}

/** A text of megabytes, as `encoding` says. */
export async function decoded(bytes: ArrayBuffer, encoding: string): Promise<string> {
  const decoder = new TextDecoder(encoding);
  let text = "";
  for (let at = 0; at < bytes.byteLength; at += SLICE) {
    text += decoder.decode(new Uint8Array(bytes, at, Math.min(SLICE, bytes.byteLength - at)), { stream: true });
    if (bytes.byteLength > SLICE) await pause();
  }
  return text + decoder.decode();
}

/** Addresses are relative to the page, so that it works behind a path prefix. */
async function send(
  method: string,
  path: string,
  body: unknown,
  headers: Record<string, string>,
  key: string | null,
  signal?: AbortSignal,
): Promise<Answer> {
  try {
    const response = await fetch(path.replace(/^\//, ""), {
      method,
      headers: {
        Accept: "application/json, application/problem+json",
        ...(body === undefined ? {} : { "Content-Type": "application/json" }),
        ...(key === null ? {} : { Authorization: `Bearer ${key}` }),
        ...headers,
      },
      ...(body === undefined ? {} : { body: await bodyOf(body) }),
      ...(signal ? { signal } : {}),
    });
    const text = response.status === 304 ? "" : await response.text();
    await untilReleased();
    return { response, text };
  } catch {
    throw notConnected();
  }
}

export const notConnected = (): ApiError =>
  new ApiError(
    { type: "not-connected", detail: "Not connected to the service. Nothing is lost; try again when it is back." },
    0,
  );

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
