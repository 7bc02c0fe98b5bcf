// What is asked while a hand moves: one design, one controller's figures, the front of robust optima. Nothing of it is kept.
import { call } from "./client.ts";
import { settingsOf } from "./evaluate.ts";
import { deleteJob, postJobAndWait } from "./jobs.ts";
import type { Front } from "./reports.ts";
import type { Controller, Entry, Plant, TuneEntry, TuningRequest } from "./types.ts";

/** What stays the same while settings move. */
export interface LiveSubject {
  plant: Plant;
  /** Units, steps, actuator, the user's own controller and today's settings are those of the request. */
  request: TuningRequest;
  /** Today's settings in the ideal form, where they could be read so. */
  today: Controller | null;
}

/** While a slider is held half the samples are enough; let go, the request's own number is answered. */
const HELD_POINTS = 200;

const evaluateOf = ({ request }: LiveSubject, held: boolean): Record<string, unknown> =>
  held ? { ...request.evaluate, points: HELD_POINTS } : { ...request.evaluate };

/** The entry first, then today's settings where there are any. */
export async function designOf(
  subject: LiveSubject,
  tune: TuneEntry,
  held: boolean,
  signal: AbortSignal,
): Promise<Entry[]> {
  const { units, implement, baseline } = subject.request;
  const body = {
    plant: subject.plant,
    tune: [tune],
    ...(units ? { units } : {}),
    ...(implement ? { implement } : {}),
    ...(baseline ? { baseline } : {}),
    evaluate: evaluateOf(subject, held),
  };
  return ((await call("POST", "v1/design", body, {}, signal)).data as { controllers: Entry[] }).controllers;
}

/** The same for settings that are given. */
export async function entriesOf(
  subject: LiveSubject,
  controller: Controller,
  held: boolean,
  signal: AbortSignal,
): Promise<Entry[]> {
  const { units, implement } = subject.request;
  const body = {
    plant: subject.plant,
    controllers: [controller, ...(subject.today ? [subject.today] : [])].map(settingsOf),
    ...(units ? { units } : {}),
    ...(implement ? { implement } : {}),
    evaluate: evaluateOf(subject, held),
  };
  return ((await call("POST", "v1/evaluate", body, {}, signal)).data as { controllers: Entry[] }).controllers;
}

export interface FrontTerms {
  controller: "PI" | "PID";
  /** The limit on Mt, or as that on Ms. */
  Mt: number | "tied";
  filter?: unknown;
}

/** The least load IAE under each limit on Ms. */
export async function frontOf(plant: Plant, terms: FrontTerms, signal: AbortSignal): Promise<Front> {
  return (await call("POST", "v1/frontier", { plant, ...terms }, {}, signal)).data as Front;
}

const LONGEST_WAIT_S = 20;

/**
 * Fronts that the plant may not have, each null then, and every rule's entry where they are wanted. The job that finds them
 * out leaves no trace.
 */
export async function besideOf(
  plant: Plant,
  fronts: readonly FrontTerms[],
  rules: boolean,
): Promise<{ fronts: (Front | null)[]; rules: Entry[] }> {
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
