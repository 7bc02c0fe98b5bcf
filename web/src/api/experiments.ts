// Tests of a plant: what a relay test on it would show, and the model that a recorded test gives. Both are answered at once.
import { call } from "./client.ts";
import type { IdentifyRequest, LimitCycle, Model, Notice, Plant, RecordedTest, Units } from "./types.ts";

export interface RelaySettings {
  u_plus?: number;
  u_minus?: number;
  hysteresis?: number;
  noise_std?: number;
  relay_sample_time?: number;
  record_interval?: number;
  cycles?: number;
  seed?: number;
}

export interface RelayPlan {
  u_plus?: number;
  u_minus?: number;
  hysteresis?: number;
  amplitude?: number;
  expected_period?: number;
  cycles?: number;
  duration?: number;
  record_interval?: number;
  reason?: string;
}

export interface RelayRequest {
  units?: Units;
  plant: Plant;
  relay: RelaySettings;
}

export interface RelayAnswer {
  /** Ready to be identified as it is. */
  record: RecordedTest & { t: number[]; u: number[]; y: number[] };
  limit_cycle: LimitCycle;
  /** The relay acts on -y, because the plant's gain is negative. */
  reversed?: boolean;
  plan?: RelayPlan;
  warnings?: Notice[];
}

export async function simulateRelay(request: RelayRequest): Promise<RelayAnswer> {
  return (await call("POST", "v1/experiments/relay", request)).data as RelayAnswer;
}

interface AboutRecord {
  record?: RecordedTest;
  identify?: Record<string, unknown>;
}

/** The request, with the traces of the models if it is about a record: the page draws the record beside its models. */
export function withTraces<Request extends AboutRecord>(request: Request): Request {
  return request.record ? { ...request, identify: { ...request.identify, traces: true } } : request;
}

/** The model that the service finds in the record, with its traces. */
export async function identify(request: IdentifyRequest): Promise<Model> {
  return ((await call("POST", "v1/identify", withTraces(request))).data as { model: Model }).model;
}
