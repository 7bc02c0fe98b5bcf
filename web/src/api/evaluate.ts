// Evaluates given controllers on a plant, synchronously, and a method over its whole range.
import { call } from "./client.ts";
import { deleteJob, postJobAndWait } from "./jobs.ts";
import type { Controller, Entry, Plant, Tradeoff } from "./types.ts";

/** Settings without the members that the service adds to a controller. */
export const settingsOf = ({ action: _action, ...settings }: Controller): Omit<Controller, "action"> => settings;

/** The figures and responses of one controller for this set-point step, to that horizon. */
export async function stepOf(
  plant: Plant,
  controller: Controller,
  setpoint_step: number,
  horizon: number,
): Promise<Entry> {
  const evaluate = { setpoint_step, horizon, points: SLIDER_POINTS };
  const request = { plant, controllers: [settingsOf(controller)], evaluate };
  const answer = (await call("POST", "v1/evaluate", request)).data as { controllers: Entry[] };
  return answer.controllers[0]!;
}

/** The servo/regulation trade-off of controllers, without traces, in their order. */
export async function tradeoffsOf(plant: Plant, controllers: Controller[]): Promise<(Tradeoff | undefined)[]> {
  const given = controllers.map(settingsOf);
  const request = { plant, controllers: given, evaluate: { points: 0, tradeoff: true } };
  const answer = (await call("POST", "v1/evaluate", request)).data as { controllers: Entry[] };
  return answer.controllers.map((entry) => entry.tradeoff);
}

const SLIDER_POINTS = 200;
const PROFILE_METHOD = "arrieta_ms";
const LONGEST_WAIT_S = 20;

/** The behaviour of the trade-off's tuning rule on this plant over its range. The job for it is deleted. */
export async function tradeoffProfile(plant: Plant): Promise<Tradeoff["profile"]> {
  const tune = [{ method: PROFILE_METHOD, profile: true }];
  const job = await postJobAndWait({ plant, tune, evaluate: { points: 0 } }, LONGEST_WAIT_S);
  void deleteJob(job.id).catch(() => undefined);
  const failure = job.error ?? job.result?.controllers[0]?.error;
  if (failure) throw new Error(failure.detail ?? failure.title ?? "There is no such profile.");
  return job.result?.controllers[0]?.tradeoff?.profile;
}
