// Calls during the movement of a slider: a design, one controller's figures, the frontier of robust optima. They store
// nothing.
import { call } from "./client.ts";
import { settingsOf } from "./evaluate.ts";
import { deleteJob, postJobAndWait } from "./jobs.ts";
import type { Controller, Entry, Frontier, Implement, Model, OwnStep, Plant, Result, TuneEntry, TuningRequest } from "./types.ts";

/** The subject of a call: a plant, or the model of a record with its region, so that the record is not identified
    again. */
export type CallSubject = { plant: Plant } | { model: Partial<Model> };

/** Members of a model on which a design depends. */
const SENT_BACK = [
  "plant",
  "fit_percent",
  "standard_errors",
  "covariance",
  "alternatives",
  "limit_cycle",
  "excited_band",
  "warnings",
] as const;

/** The model in the form for a request; null if it comes from a service that does not return all of its region. */
function sentBack(model: Model | undefined): Partial<Model> | null {
  if (!model?.alternatives) return null;
  return Object.fromEntries(SENT_BACK.flatMap((name) => (model[name] === undefined ? [] : [[name, model[name]]])));
}

/** Null if there is no plant. */
export function callSubject(request: TuningRequest, result: Result): CallSubject | null {
  const model = sentBack(result.model);
  if (model) return { model };
  const plant = result.model?.plant ?? request.plant;
  return plant ? { plant } : null;
}

/** A proof takes long, and a design that follows a slider has none. */
function withoutCertificates(request: TuningRequest): TuningRequest {
  const { tune } = request;
  if (!Array.isArray(tune) || !tune.some((entry) => "certify" in entry)) return request;
  return { ...request, tune: tune.map(({ certify: _certify, ...entry }) => entry as TuneEntry) };
}

/** The body of POST /v1/design for a job's request: without the terms on which a job is run, and with its record's
    model and settings. */
export function designBody(request: TuningRequest, result: Result): Record<string, unknown> {
  const { timeout_s: _timeout, priority: _priority, notify: _notify, ...asked } = withoutCertificates(request);
  const model = asked.record ? sentBack(result.model) : null;
  if (!model) return asked;
  const { record: _record, identify: _identify, baseline, ...rest } = asked;
  const today = result.controllers.find((entry) => entry.method === "baseline")?.controller;
  const found = today ? { baseline: settingsOf(today) } : {};
  return { ...rest, ...(baseline === "from-record" ? found : baseline ? { baseline } : {}), model };
}

/** The body of POST /v1/evaluate for given controllers on the subject of the request. */
export function evaluateBody(
  request: TuningRequest,
  subject: CallSubject,
  controllers: readonly Controller[],
): Record<string, unknown> {
  const { name, units, implement, evaluate } = request;
  return {
    ...(name ? { name } : {}),
    ...(units ? { units } : {}),
    ...subject,
    controllers: controllers.map(settingsOf),
    ...(implement ? { implement } : {}),
    ...(evaluate ? { evaluate } : {}),
  };
}

/** While a slider is held half the samples are sufficient; after its release the request's own number is used. */
const HELD_POINTS = 200;

export const withHeldPoints = (body: Record<string, unknown>): Record<string, unknown> => ({
  ...body,
  evaluate: { ...(body["evaluate"] as object | undefined), points: HELD_POINTS },
});

/** Members of a job's result that depend on its controllers. */
export type DesignAnswer = Pick<Result, "controllers" | "verdict" | "ranking" | "ranking_by" | "rank_limits" | "proposed">;

export const designOf = async (body: unknown, signal: AbortSignal): Promise<DesignAnswer> =>
  (await call("POST", "v1/design", body, {}, signal)).data as DesignAnswer;

export const entriesOf = async (body: unknown, signal?: AbortSignal): Promise<Entry[]> =>
  ((await call("POST", "v1/evaluate", body, {}, signal)).data as { controllers: Entry[] }).controllers;

/** A step for these controllers of a loop, in the units of its request. */
export interface StepQuestion {
  plant: Plant;
  implement: Implement | undefined;
  units: TuningRequest["units"];
  step: OwnStep;
  controllers: readonly Controller[];
}

/** The controllers' entries with the user's own step: its hold is common to them. */
export const ownStepsOf = ({ plant, controllers, step, implement, units }: StepQuestion, signal: AbortSignal): Promise<Entry[]> =>
  entriesOf(
    evaluateBody({ ...(units ? { units } : {}), ...(implement ? { implement } : {}), evaluate: { own_step: step } }, { plant }, controllers),
    signal,
  );

/** Evaluates a controller on the user's own product, with the steps of its request. */
export async function evaluateAsBuilt(
  subject: CallSubject,
  controller: Controller,
  implement: Implement,
  request: TuningRequest,
): Promise<Entry> {
  const body = evaluateBody({ ...request, implement }, subject, [controller]);
  return (await entriesOf(body))[0]!;
}

export interface FrontTerms {
  controller: "PI" | "PID";
  /** The limit on Mt; "tied": the same as on Ms. */
  Mt: number | "tied";
  filter?: unknown;
}

/** The least load IAE under each limit on Ms. */
export async function frontOf(plant: Plant, terms: FrontTerms, signal: AbortSignal): Promise<Frontier> {
  return (await call("POST", "v1/frontier", { plant, ...terms }, {}, signal)).data as Frontier;
}

const LONGEST_WAIT_S = 20;

/**
 * Frontiers, each null if the plant has none, and every rule's entry if they are wanted. The job for them is deleted.
 */
export async function referenceOf(
  plant: Plant,
  fronts: readonly FrontTerms[],
  rules: boolean,
): Promise<{ fronts: (Frontier | null)[]; rules: Entry[] }> {
  const asked = fronts.map((terms) => ({ method: "frontier", ...terms }));
  const tune = [...asked, ...(rules ? [{ method: "all" }] : [])];
  const job = await postJobAndWait({ plant, tune, evaluate: { points: 0 } }, LONGEST_WAIT_S);
  void deleteJob(job.id).catch(() => undefined);
  const entries = job.result?.controllers ?? [];
  return {
    fronts: fronts.map((_, index) => entries[index]?.frontier ?? null),
    rules: entries.slice(fronts.length),
  };
}
