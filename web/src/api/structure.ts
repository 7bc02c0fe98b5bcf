// Loops around the loop: a request and its answer, synchronously, and the jobs about one.
import { call } from "./client.ts";
import type { CascadeAnswer, Conclusion, FeedforwardAnswer, InteractionAnswer, LevelAnswer, PredictorAnswer } from "./contract.gen.ts";
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

export const designStructure = async ({ id, request }: StructureQuestion, signal?: AbortSignal): Promise<StructureAnswer> =>
  (await call("POST", `v1/${id}`, request, {}, signal)).data as StructureAnswer;

export type StructureJobRequest = StructureRequest & { structure: StructureId };
export type StructureJob = Omit<Job, "request" | "result"> & { request?: StructureJobRequest; result?: StructureAnswer };

/** The same criterion as the service's for requests of POST /v1/jobs. */
export const isStructureRequest = (request: unknown): request is StructureJobRequest =>
  typeof request === "object" && request !== null && isStructure((request as StructureRequest)["structure"]);

const LONGEST_WAIT_S = 20;

export const postStructure = async ({ id, request }: StructureQuestion): Promise<StructureJob> =>
  (await call("POST", "v1/jobs", { structure: id, ...request }, { Prefer: `wait=${LONGEST_WAIT_S}` })).data as StructureJob;
