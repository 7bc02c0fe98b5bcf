// A loop over its whole operating range: what POST /v1/range takes and answers, and which jobs are about one.
import { call } from "./client.ts";
import type { Controller, Finding, Model, Notice, Plant, RecordedTest, Units, WhyNull } from "./types.ts";

export interface RangePoint {
  at: number;
  /** A model, or its text as somebody would write it. */
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

export interface ScheduleRow {
  at: number;
  Kp: number;
  Ti: number;
  Td: number;
  Tf: number;
  b: number;
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

export type Column = (number | null)[];

export interface RangeTraces {
  Ms: Column;
  Mt: Column;
  relative_IAE: Column;
  Kp?: Column;
  Ti?: Column;
  Td?: Column;
}

export interface RangeCurves {
  at: number[];
  K: Column;
  T: Column;
  L: Column;
  u?: Column;
  y?: Column;
  one?: RangeTraces | null;
  schedule?: RangeTraces | null;
}

export interface RangePrice {
  at: number;
  own: Controller;
  own_IAE: number;
  IAE: number | null;
  relative_IAE: number | null;
  Ms: number | null;
  Mt: number | null;
  why_null?: WhyNull;
}

export interface OneSetting {
  controller: Controller;
  worst_relative_IAE: number;
  mean_relative_IAE: number;
  worst_at: number;
  points: RangePrice[];
}

export interface Schedule {
  interpolation: string;
  hysteresis: number;
  rows: ScheduleRow[];
  holds_limits: boolean;
  within_allowance: boolean;
  worst_relative_IAE: number | null;
}

export interface WorstPlace {
  quantity: "Ms" | "Mt" | "relative_IAE";
  at: number;
  value: number | null;
  limit: number;
}

export interface RangeRun {
  y: Column;
  u: Column;
  at: Column;
  Kp: Column;
  IAE: number;
  largest_error: number;
  largest_bump: number;
  switches: number;
  limited: boolean;
  settled: boolean;
  ended?: string;
  warnings?: Notice[];
}

/** By a nonlinear controller that knows the equations. */
export interface NonlinearRun {
  y: Column;
  u: Column;
  tau: number;
  IAE: number;
  limited: boolean;
  settled: boolean;
  ended?: string;
}

export interface RangePassage {
  name: string;
  horizon: number;
  t: number[];
  target: Column;
  one?: RangeRun | null;
  schedule?: RangeRun | null;
  nonlinear?: NonlinearRun | null;
  why_null?: WhyNull;
}

export interface RangeContent {
  scheduling: { name: string; unit?: string; from: number; to: number };
  stated: string;
  points: { at: number; plant: Plant; model?: Model; u?: number | null; y?: number | null }[];
  one?: OneSetting | null;
  schedule: Schedule | null;
  curves: RangeCurves;
  worst: { one?: WorstPlace[]; schedule?: WorstPlace[] };
  /** None of a schedule that was given. */
  verdict?: Finding;
  runs?: RangePassage[];
  warnings: Notice[];
  why_null?: WhyNull;
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

/** As the service tells requests of POST /v1/jobs apart. */
export const isRangeRequest = (request: unknown): request is RangeRequest =>
  typeof request === "object" &&
  request !== null &&
  ["points", "range", "scheduling", "schedule"].some((member) => member in request);
