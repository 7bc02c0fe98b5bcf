// Starting, following and cancelling a job.
import { call, sentenceOf, waitAfter } from "./client.ts";
import { withTraces } from "./plants.ts";
import { isFinal } from "./types.ts";
import type { Example, Job, Method, TuningRequest } from "./types.ts";

const jobPath = (id: string): string => `v1/jobs/${encodeURIComponent(id)}`;

export async function postJob(request: TuningRequest): Promise<Job> {
  return (await call("POST", "v1/jobs", withTraces(request))).data as Job;
}

/** The job when it has ended, or after this number of seconds. */
export async function postJobAndWait(request: TuningRequest, seconds: number): Promise<Job> {
  return (await call("POST", "v1/jobs", withTraces(request), { Prefer: `wait=${seconds}` })).data as Job;
}

export async function cancelJob(id: string): Promise<Job> {
  return (await call("POST", `${jobPath(id)}/cancel`)).data as Job;
}

/** Deletes a job that has ended. */
export async function deleteJob(id: string): Promise<void> {
  await call("DELETE", jobPath(id));
}

export async function getJob(id: string): Promise<Job> {
  return (await call("GET", jobPath(id))).data as Job;
}

/** A list that may be a bare array or a member with that name, as in collections with a `next` link. */
function listOf<T>(data: unknown, name: string): T[] {
  if (Array.isArray(data)) return data as T[];
  const list = (data as Record<string, unknown> | null)?.[name];
  return Array.isArray(list) ? (list as T[]) : [];
}

export async function getMethods(): Promise<Method[]> {
  return listOf<Method>((await call("GET", "v1/methods")).data, "methods");
}

export async function getExamples(): Promise<Example[]> {
  return listOf<Example>((await call("GET", "v1/examples")).data, "examples");
}

export async function getRecentJobs(limit: number): Promise<Job[]> {
  return listOf<Job>((await call("GET", `v1/jobs?limit=${limit}`)).data, "jobs");
}

export interface Watcher {
  onJob(job: Job): void;
  /** Reports that the connection is lost or the job was deleted; "" when it is back. */
  onTrouble(sentence: string): void;
}

/** Reports the job now and at every change until it has ended. Returns a function that stops it. */
export function watchJob(id: string, watcher: Watcher): () => void {
  return poll(id, watcher);
}

const FIRST_WAIT_MS = 80;
const LONGEST_WAIT_MS = 1000;

function poll(id: string, watcher: Watcher): () => void {
  let stopped = false;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let etag: string | null = null;
  let wait = FIRST_WAIT_MS;
  let troubled = false;

  const again = (milliseconds: number): void => {
    if (!stopped) timer = setTimeout(() => void step(), milliseconds);
  };
  const step = async (): Promise<void> => {
    try {
      const reply = await call("GET", jobPath(id), undefined, etag ? { "If-None-Match": etag } : {});
      if (stopped) return;
      if (troubled) watcher.onTrouble("");
      troubled = false;
      etag = reply.etag ?? etag;
      if (reply.status !== 304) {
        const job = reply.data as Job;
        watcher.onJob(job);
        if (isFinal(job.status)) return;
      }
      again(wait);
      wait = Math.min(wait * 1.5, LONGEST_WAIT_MS);
    } catch (error) {
      if (stopped) return;
      troubled = true;
      watcher.onTrouble(sentenceOf(error));
      const later = waitAfter(error);
      if (later !== null) again(later);
    }
  };
  void step();
  return () => {
    stopped = true;
    clearTimeout(timer);
  };
}
