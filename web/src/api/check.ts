// Loops in operation: a check as a job, started, followed and stopped.
import { call, sentenceOf, waitAfter } from "./client.ts";
import { untilEnd } from "./events.ts";
import { newestOfBatch } from "./job_lists.ts";
import type { Batch, BatchCheck, CheckContent, CheckJob, CheckLoop, CheckRequest, CheckResult, LoopCure, Progress, Units } from "./types.ts";
import { isFinal } from "./types.ts";

/** The same criterion as the service's for requests of POST /v1/jobs. */
export const isCheckRequest = (request: unknown): request is CheckRequest =>
  typeof request === "object" && request !== null && "loops" in request;

/** `body`: the request, written. */
export const postCheck = async (body: Blob): Promise<CheckJob> => (await call("POST", "v1/jobs", body)).data as CheckJob;

export const getCheck = async (id: string, signal?: AbortSignal): Promise<CheckJob> =>
  (await call("GET", `v1/jobs/${encodeURIComponent(id)}`, undefined, {}, signal)).data as CheckJob;

/** Loops whose records are too long for one request, or in one file, as a batch: `type` says which. */
export async function postCheckBatch(body: Blob, type: "text/csv" | "application/x-ndjson", options: Record<string, string>): Promise<Batch> {
  const query = new URLSearchParams({ kind: "check", ...options }).toString();
  return (await call("POST", `v1/batches?${query}`, body, { "Content-Type": type })).data as Batch;
}

/** What the loops of a batch say together; their units are those of its jobs. `before`: an earlier batch to compare with. */
export async function checkOfBatch(id: string, before: string | null = null): Promise<CheckContent> {
  const since = before === null ? "" : `?before=${encodeURIComponent(before)}`;
  const [check, job] = await Promise.all([call("GET", `v1/batches/${encodeURIComponent(id)}/check${since}`), newestOfBatch(id)]);
  const units = job?.outline?.units;
  return { ...(check.data as BatchCheck), ...(units ? { units } : {}) };
}

/** New settings for a loop whose cause is its tuning, or the test that is missing; null if tuning is not the cause. */
export async function cureOf(loop: CheckLoop, units: Units | undefined, signal: AbortSignal): Promise<LoopCure | null> {
  const request: CheckRequest = { ...(units ? { units } : {}), loops: [loop], cluster: false, settings: true };
  const { loops } = (await call("POST", "v1/check", request, {}, signal)).data as CheckResult;
  return loops[0]?.cure ?? null;
}

const LOOK_AGAIN_MS = 1000;

export interface CheckWatcher {
  /** The job as it is found, and at its end. */
  onJob(job: CheckJob): void;
  onProgress(progress: Progress): void;
  /** Reports that the connection is lost or the job was deleted; "" when it is back. */
  onTrouble(sentence: string): void;
}

/** Reports a check until it has ended. Returns a function that stops this. */
export function followCheck(id: string, watcher: CheckWatcher): () => void {
  const stop = new AbortController();
  const stopped = (): boolean => stop.signal.aborted;

  /** The time to wait before the next look; null: it is over. */
  async function look(): Promise<number | null> {
    try {
      const job = await getCheck(id, stop.signal);
      if (stopped()) return null;
      watcher.onTrouble("");
      watcher.onJob(job);
      if (isFinal(job.status)) return null;
    } catch (error) {
      if (!stopped()) watcher.onTrouble(sentenceOf(error));
      return waitAfter(error);
    }
    // If the stream breaks, the next look finds the reason.
    return untilEnd(id, watcher.onProgress, stop.signal).then(
      () => 0,
      () => LOOK_AGAIN_MS,
    );
  }

  void (async () => {
    for (let wait = await look(); wait !== null && !stopped(); wait = await look())
      await new Promise((over) => setTimeout(over, wait));
  })();
  return () => stop.abort();
}
