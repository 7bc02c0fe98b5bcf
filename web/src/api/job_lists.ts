// Lists of jobs, and batches: many jobs that were posted at once.
import { call, getText } from "./client.ts";
import type { TextFile } from "./client.ts";
import { getJob } from "./jobs.ts";
import type { Batch, JobList, ListedJob, TuningRequest } from "./types.ts";
import { isFinal } from "./types.ts";

const PAGE = 200;
const batchPath = (id: string): string => `v1/batches/${encodeURIComponent(id)}`;

export const hasEnded = (batch: Batch): boolean => batch.status === "ended";

/** The first page of the newest jobs that have this text in their name, id or method; "" is every job. */
export async function listJobs(text: string): Promise<JobList> {
  const q = text === "" ? "" : `&q=${encodeURIComponent(text)}`;
  return (await call("GET", `v1/jobs?limit=50${q}`)).data as JobList;
}

export const nextJobs = async (address: string): Promise<JobList> => (await call("GET", address)).data as JobList;

export async function listBatches(): Promise<Batch[]> {
  return ((await call("GET", "v1/batches?limit=20")).data as { batches: Batch[] }).batches;
}

/** One of its jobs, which says of which kind all are; undefined if there is none yet. */
export const newestOfBatch = async (id: string): Promise<ListedJob | undefined> =>
  (await nextJobs(`v1/jobs?batch=${encodeURIComponent(id)}&limit=1`)).jobs[0];

export const getBatch = async (id: string): Promise<Batch> => (await call("GET", batchPath(id))).data as Batch;

/** The jobs of a batch in their order, at most `max`. */
export async function jobsOfBatch(id: string, max: number): Promise<ListedJob[]> {
  const found: ListedJob[] = [];
  let address: string | null = `v1/jobs?batch=${encodeURIComponent(id)}&limit=${PAGE}`;
  while (address !== null && found.length < max) {
    const page: JobList = await nextJobs(address);
    found.push(...page.jobs);
    address = page.next;
  }
  return found.reverse();
}

export async function cancelBatch(id: string): Promise<void> {
  await call("POST", `${batchPath(id)}/cancel`);
}

/** Deletes a batch that has ended, with its jobs. */
export async function deleteBatch(id: string): Promise<void> {
  await call("DELETE", batchPath(id));
}

export const batchCsv = (id: string): Promise<TextFile> => getText(`${batchPath(id)}/results?format=csv`);

/** A CSV with one loop per line. `options`: of the method, and the batch's name. */
export async function postLoops(file: Blob, options: Record<string, string>): Promise<Batch> {
  const query = new URLSearchParams(options).toString();
  return (await call("POST", `v1/batches?${query}`, file, { "Content-Type": "text/csv" })).data as Batch;
}

/** The jobs of a batch that failed or were cancelled, as a new batch; jobs without a request are left out. */
export async function postAgain(batch: Batch, rows: ListedJob[]): Promise<Batch | null> {
  const requests: TuningRequest[] = [];
  for (const row of rows) {
    if (!isFinal(row.status) || row.status === "succeeded") continue;
    const request = (await getJob(row.id)).request;
    if (request) requests.push(request);
  }
  if (requests.length === 0) return null;
  const name = batch.name ? { name: batch.name } : {};
  return (await call("POST", "v1/batches", { ...name, jobs: requests })).data as Batch;
}
