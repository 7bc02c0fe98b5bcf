// A loop over its whole operating range: the request and the answer of POST /v1/range, and the jobs about one.
import { call } from "./client.ts";
import type { Plant, RangeContent, RecordedTest, ScheduleRow, Units } from "./types.ts";

export interface RangePoint {
  at: number;
  /** A model, or its text as typed. */
  plant?: Plant | string;
  record?: RecordedTest;
}

export type Along = "input" | "output" | "parameter";

export interface RangeWay {
  along?: Along;
  parameter?: string;
  from: number;
  to: number;
  hold_output?: boolean;
}

export interface ScheduleWish {
  controller?: string;
  Ms?: number;
  Mt?: number;
  interpolation?: string;
  allowance?: number;
  rows?: number | null;
  given?: ScheduleRow[];
  [key: string]: unknown;
}

export interface RangeRequest {
  name?: string;
  units?: Units;
  scheduling?: { name?: string; unit?: string };
  points?: RangePoint[];
  plant?: Plant;
  range?: RangeWay;
  identify?: Record<string, unknown>;
  uncertainty?: string;
  schedule?: ScheduleWish;
  runs?: boolean;
  [key: string]: unknown;
}

export interface RangeExample {
  id: string;
  title: string;
  description?: string;
  request: RangeRequest;
}

export async function designRange(request: RangeRequest, signal?: AbortSignal): Promise<RangeContent> {
  return ((await call("POST", "v1/range", request, {}, signal)).data as { range: RangeContent }).range;
}

export async function getRangeExamples(): Promise<RangeExample[]> {
  return ((await call("GET", "v1/examples")).data as { ranges?: RangeExample[] }).ranges ?? [];
}

/** The same criterion as the service's for requests of POST /v1/jobs. */
export const isRangeRequest = (request: unknown): request is RangeRequest =>
  typeof request === "object" &&
  request !== null &&
  ["points", "range", "scheduling", "schedule"].some((member) => member in request);
