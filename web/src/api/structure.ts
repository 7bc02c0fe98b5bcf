// Loops around the loop: a request and its answer, synchronously, and the jobs about one.
import { ApiError, call } from "./client.ts";
import type { CascadeAnswer, Conclusion, FeedforwardAnswer, InteractionAnswer, LevelAnswer, PredictorAnswer } from "./contract.gen.ts";
import { cancelJob, getJob } from "./jobs.ts";
import { isFinal } from "./types.ts";
import type { Job, Units } from "./types.ts";

export type { Conclusion };
export type StructureAnswer = CascadeAnswer | FeedforwardAnswer | LevelAnswer | InteractionAnswer | PredictorAnswer;
export type StructureId = StructureAnswer["structure"];
export type AnswerOf<Id extends StructureId> = Extract<StructureAnswer, { structure: Id }>;

export const STRUCTURES: readonly StructureId[] = ["cascade", "feedforward", "level", "interaction", "predictor"];

export const isStructure = (id: unknown): id is StructureId => (STRUCTURES as readonly unknown[]).includes(id);

export interface StructureRequest {
  name?: string;
  units?: Units;
  [key: string]: unknown;
}

export interface StructureQuestion {
  id: StructureId;
  request: StructureRequest;
}

export type StructureJobRequest = StructureRequest & { structure: StructureId };
export type StructureJob = Omit<Job, "request" | "result"> & { request?: StructureJobRequest; result?: StructureAnswer };

/** The same criterion as the service's for requests of POST /v1/jobs. */
export const isStructureRequest = (request: unknown): request is StructureJobRequest =>
  typeof request === "object" && request !== null && isStructure((request as StructureRequest)["structure"]);

export const postStructure = async ({ id, request }: StructureQuestion): Promise<StructureJob> =>
  (await call("POST", "v1/jobs", { structure: id, ...request }, { Prefer: "wait=1" })).data as StructureJob;

const LOOK_AGAIN_MS = 500;

/** Resolves when the job has ended; an abort cancels it. */
export async function endedStructure(job: StructureJob, signal?: AbortSignal): Promise<StructureJob> {
  while (!isFinal(job.status)) {
    await new Promise((over) => setTimeout(over, LOOK_AGAIN_MS));
    if (signal?.aborted) await cancelJob(job.id);
    job = (await getJob(job.id)) as unknown as StructureJob;
  }
  if (!job.result) throw new ApiError(job.error ?? { detail: "The design was stopped." }, 422);
  return job;
}

/** An answer, and the job that computed it if the service did not answer at once. */
export interface Designed {
  answer: StructureAnswer;
  job: string | null;
}

/** Answered within a call; what takes longer than a call may is a job. */
export async function designStructure(question: StructureQuestion, signal?: AbortSignal): Promise<Designed> {
  const { id, request } = question;
  try {
    return { answer: (await call("POST", `v1/${id}`, request, {}, signal)).data as StructureAnswer, job: null };
  } catch (error) {
    if (!(error instanceof ApiError) || !error.problem.type?.endsWith("timeout")) throw error;
    const { id: job, result } = await endedStructure(await postStructure(question), signal);
    return { answer: result!, job };
  }
}
