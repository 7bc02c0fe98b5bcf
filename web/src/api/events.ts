// The progress of a job while it runs, as server-sent events: without its request, which may have megabytes.
import { ApiError, notConnected } from "./client.ts";
import { currentKey } from "./key.ts";
import type { Progress } from "./types.ts";

export interface ServerEvent {
  name: string;
  data: string;
}

/** The events that a text holds whole, and its rest. */
export function eventsIn(text: string): { events: ServerEvent[]; rest: string } {
  const parts = text.split("\n\n");
  const rest = parts.pop() ?? "";
  const events = parts.flatMap((part) => {
    const lines = part.split("\n");
    const valueOf = (field: string): string[] =>
      lines.flatMap((line) => (line.startsWith(`${field}: `) ? [line.slice(field.length + 2)] : []));
    const [name] = valueOf("event");
    return name ? [{ name, data: valueOf("data").join("\n") }] : [];
  });
  return { events, rest };
}

/** Reports the progress of a job, and resolves when it has ended. Rejects if the connection breaks before. */
export async function untilEnd(id: string, onProgress: (progress: Progress) => void, signal: AbortSignal): Promise<void> {
  const key = currentKey();
  const response = await fetch(`v1/jobs/${encodeURIComponent(id)}/events`, {
    headers: { Accept: "text/event-stream", ...(key === null ? {} : { Authorization: `Bearer ${key}` }) },
    signal,
  });
  if (!response.ok || !response.body) throw new ApiError({}, response.status);
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (;;) {
    const { done, value } = await reader.read();
    if (done) throw notConnected();
    const { events, rest } = eventsIn(text + value);
    text = rest;
    for (const { name, data } of events) {
      if (name === "done") return void reader.cancel().catch(() => undefined);
      if (name === "progress") onProgress(JSON.parse(data) as Progress);
    }
  }
}
