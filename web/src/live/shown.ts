// A modified design: one request with one member changed, and its result. No element of the page.
import { settingsOf } from "../api/evaluate.ts";
import { designBody, withHeldPoints } from "../api/live.ts";
import type { DesignAnswer } from "../api/live.ts";
import type { Entry, GivenController, Result, TuneEntry, TuningRequest } from "../api/types.ts";
import { asksForAll, isGiven, rowsOf, tuneEntryOf, withGiven, withImplement, withTune } from "../form/tuning_request.ts";
import type { Point } from "./point.ts";

/** A job's entry that is modified. */
export interface Modifiable {
  request: TuningRequest;
  result: Result;
  index: number;
}

export interface Shown {
  /** The request of a job for it. */
  request: TuningRequest;
  /** Index of the modified entry in the result of such a job. */
  kept: number;
  result: Result;
  /** Index of the modified entry. */
  index: number;
  /** For each entry here, its index in the result of the modified job. */
  origin: number[];
  /** Duration of the computation that follows the slider, ms. */
  cost: number;
  /** False: statements over all entries, and comparisons of their figures, are delayed until the slider is released. */
  whole: boolean;
}

/** The job's request with the one member changed that a slider moves. A design over the record's region stays one. */
export function alteredBy({ request, result, index }: Modifiable, tune: TuneEntry): TuningRequest {
  const held = result.controllers[index]?.over_region && rowCount(request) === 1;
  return { ...withTune(request, result, index, tune), ...(held ? { uncertainty: "identified" } : {}) };
}

/** Rows of the request; a single one is computed completely while a slider is held. */
const rowCount = (request: TuningRequest): number => (Array.isArray(request.tune) ? request.tune.length : 1);

/** The body for POST /v1/design; `held`: only the modified row, with few samples. */
export function questionOf(from: Modifiable, tune: TuneEntry, held: boolean): Record<string, unknown> {
  const body = designBody(alteredBy(from, tune), from.result);
  if (!held) return body;
  const { controllers: _given, ...others } = withHeldPoints(body);
  const { certify: _certify, ...quick } = tune;
  return { ...others, tune: [quick] };
}

/** The entries of the job made by the same row of its request. */
function rowMates({ request, result, index }: Modifiable): number[] {
  const rows = rowsOf(request, result);
  return rows.flatMap((row, at) => (row === rows[index] && row >= 0 ? [at] : []));
}

const todaysOf = (entries: readonly Entry[]): Entry | undefined => entries.find((entry) => entry.method === "baseline");

/** The index of the modified entry among a row's new ones: the one with limits over the region comes first. */
const sameKind = (modified: Entry, made: readonly Entry[]): number =>
  Math.max(0, made.findIndex((entry) => Boolean(entry.over_region) === Boolean(modified.over_region)));

/** Without statements over all entries. */
function withoutComparison(result: Result): Result {
  const { verdict: _verdict, ranking: _ranking, ranking_by: _by, rank_limits: _limits, proposed: _proposed, request_hash: _hash, ...kept } = result;
  return kept;
}

/** An answer for the modified row only, combined with the job's other entries, which are unchanged. */
function amongOthers(from: Modifiable, answer: DesignAnswer): Pick<Shown, "result" | "index" | "origin"> {
  const { result, index } = from;
  const mates = rowMates(from);
  const made = answer.controllers.filter((entry) => !isGiven(entry));
  const today = todaysOf(answer.controllers);
  const first = mates[0] ?? index;
  const before = result.controllers.slice(0, first);
  const after = result.controllers.slice(first + Math.max(1, mates.length));
  const controllers = [...before, ...made, ...after].map((entry) => (entry.method === "baseline" && today ? today : entry));
  const origin = [
    ...before.keys(),
    ...made.map((_, at) => mates[at] ?? mates.at(-1) ?? index),
    ...after.map((_, at) => result.controllers.length - after.length + at),
  ];
  const alone = before.length === 0 && after.every((entry) => entry.method === "baseline");
  const kept = withoutComparison(result);
  return {
    result: { ...kept, ...(alone ? answer : {}), controllers },
    index: first + sameKind(result.controllers[index]!, made),
    origin,
  };
}

/** A design's answer in its displayed form. */
export function designShown(from: Modifiable, tune: TuneEntry, answer: DesignAnswer, held: boolean): Shown {
  const request = alteredBy(from, tune);
  const row = rowsOf(from.request, from.result)[from.index]!;
  const single = rowCount(request) === 1 && !request.controllers?.length;
  const ofAll = asksForAll(from.request.tune);
  if (single || held || ofAll) {
    const among = amongOthers(from, answer);
    const modified = from.result.controllers[from.index]!;
    const kept = ofAll ? sameKind(modified, answer.controllers.filter((entry) => !isGiven(entry))) : among.index;
    return { request, kept, ...among, cost: costOf(answer.controllers), whole: single || ofAll };
  }
  const { request_hash: _hash, ...kept } = from.result;
  const result: Result = { ...kept, ...answer };
  const rows = rowsOf(request, result);
  const before = rowsOf(from.request, from.result);
  const origin = rows.map((made, at) => {
    const mates = before.flatMap((other, index) => (other === made ? [index] : []));
    const place = at - rows.indexOf(made);
    return mates[place] ?? mates.at(-1) ?? from.index;
  });
  const first = rows.indexOf(row);
  const made = result.controllers.filter((_, at) => rows[at] === row);
  const at = first + sameKind(from.result.controllers[from.index]!, made);
  return { request, kept: at, result, index: at, origin, cost: costOf(made), whole: true };
}

/** The settings by hand as the request gives them: as typed, or as a law. */
const givenOf = ({ manual, typed }: Point): GivenController => typed ?? settingsOf(manual!);

/** Settings that are typed into a product are for it, whatever the job was for. */
const requestFor = ({ request }: Modifiable, { typed }: Point): TuningRequest => {
  if (!typed) return request;
  const { settings: _settings, ...implement } = typed;
  return withImplement(request, implement);
};

/** The body for POST /v1/design of settings by hand alone. They are compared with the limit on Ms of the design from
 * which they deviate. */
export function manualQuestion(from: Modifiable, point: Point): Record<string, unknown> {
  const { result, index } = from;
  const request = requestFor(from, point);
  const Ms = point.tune?.["Ms"] ?? result.controllers[index]?.options?.["Ms"];
  const evaluate = { ...request.evaluate, ...(typeof Ms === "number" ? { rank_limits: { Ms } } : {}) };
  return { ...designBody({ ...request, evaluate }, result), tune: [], controllers: [givenOf(point)] };
}

/** The request of a job for settings by hand, and their index in its result. Of a comparison of all methods only the row
    remains from which they deviate. */
function manualRequest(from: Modifiable, point: Point): { request: TuningRequest; index: number } {
  const { result, index } = from;
  const request = requestFor(from, point);
  const tune = asksForAll(request.tune) ? tuneEntryOf(request, result, index) : null;
  if (!tune) return withGiven(request, result, index, givenOf(point));
  const kept = [...rowMates(from).map((at) => result.controllers[at]!), ...result.controllers.filter(({ method }) => method === "given")];
  return withGiven({ ...request, tune: [tune] }, { ...result, controllers: kept }, 0, givenOf(point));
}

/** Settings by hand in their displayed form: the job's other entries stay, without a verdict over all of them. */
export function manualShown(from: Modifiable, point: Point, answer: DesignAnswer): Shown {
  const [entry] = answer.controllers;
  const today = todaysOf(answer.controllers);
  const whole = manualRequest(from, point);
  const kept = withoutComparison(from.result);
  const controllers = kept.controllers.map((other, at) =>
    at === from.index
      ? manualEntry(entry!, from.result.controllers[from.index]!, point)
      : other.method === "baseline" && today
        ? { ...other, ...today }
        : other,
  );
  const origin = [...controllers.keys()];
  const result = { ...kept, controllers };
  return { request: whole.request, kept: whole.index, result, index: from.index, origin, cost: costOf([entry!]), whole: true };
}

/** Settings by hand keep the name of the entry from which they were moved, and its limits for the plots. */
function manualEntry(entry: Entry, from: Entry, { tune }: Point): Entry {
  const limits = Object.entries({ ...from.options, ...tune }).filter(([name]) => name === "Ms" || name === "Mt");
  return { ...entry, method: from.method, options: Object.fromEntries(limits), title: `${from.title ?? from.method}, by hand` };
}

/** The duration of the computation of the modified row, ms, without that of a proof, which does not follow a slider. */
const costOf = (entries: readonly Entry[]): number =>
  entries.reduce((sum, entry) => sum + (entry.method === "baseline" ? 0 : Math.max(0, (entry.compute_ms ?? 0) - 1000 * (entry.certificate?.seconds ?? 0))), 0);

export const costOfRow = (from: Modifiable): number =>
  costOf(rowMates(from).map((index) => from.result.controllers[index]!));
