// Tuning requests that the page makes from answers: for a candidate of Identify, for the same request with another
// lambda for one of its entries, and for the same subject with every method.
import type { Candidate, Entry, GivenController, IdentifyRequest, Implement, Method, Model, OwnStep, Plant, Result, TuneEntry, TuningRequest, TypedSettings } from "../api/types.ts";

/** Without the members that are undefined. */
export const defined = <T extends object>(values: T): T =>
  Object.fromEntries(Object.entries(values).filter(([, value]) => value !== undefined)) as T;

/** The subject for a candidate that was chosen on Identify: its record if that leads to the same model again, else
    its plant. */
export type TuneSubject =
  /** `uncertainty` "identified": limits hold for every model consistent with the record. */
  (Pick<IdentifyRequest, "record" | "identify"> & { uncertainty?: "identified" | undefined }) | { plant: Plant };

const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** Index of the candidate that the service chose; -1 if it lists none. */
export function serviceChoice(model: Model): number {
  return (model.candidates ?? []).findIndex((candidate) => same(candidate.plant, model.plant));
}

/** The name in `identify.model` that asks for this structure. */
export function structureOf(plant: Plant): string {
  if (plant.type === "ipdt") return typeof plant["T"] === "number" && plant["T"] !== 0 ? "ipdt_lag" : "ipdt";
  return plant.type === "transfer_function" ? "sopdt_zero" : plant.type;
}

export function tuneSubject(request: IdentifyRequest, model: Model, chosen: Candidate | null): TuneSubject {
  const { record, identify } = request;
  if (!chosen || same(chosen.plant, model.plant)) return { record, ...(identify ? { identify } : {}) };
  const structure = structureOf(chosen.plant);
  const alone = (model.candidates ?? []).filter((item) => structureOf(item.plant) === structure).length === 1;
  return alone ? { record, identify: { ...identify, model: structure } } : { plant: chosen.plant };
}

/** The same request for the user's own controller; null: for an ideal one. */
export function withImplement(request: TuningRequest, implement: Implement | null): TuningRequest {
  const { implement: before, ...rest } = request;
  if (!implement) return rest;
  // Members without a field on the page, such as a computation delay, belong to that product.
  const { y_span: _y, u_span: _u, sample_time: _time, ...others } = before ?? {};
  return { ...rest, implement: before?.product === implement.product ? { ...others, ...implement } : implement };
}

/** The same request with the user's own step. */
export const withOwnStep = (request: TuningRequest, own_step: OwnStep): TuningRequest => ({
  ...request,
  evaluate: { ...request.evaluate, own_step },
});

/** Today's settings as the request has them; undefined if it has none, or has them found in the record. */
export const givenBaseline = ({ baseline }: TuningRequest): GivenController | undefined =>
  baseline === "from-record" ? undefined : baseline;

/** The same request with today's settings. */
export const withBaseline = (request: TuningRequest, baseline: TypedSettings): TuningRequest => ({
  ...request,
  baseline,
});

/** True if the entry follows the one that holds on the record's region, made by the same row of the request. */
function isSibling(entry: Entry, before: Entry | undefined): boolean {
  return Boolean(before?.over_region) && before?.method === entry.method && same(before?.options, entry.options);
}

/** The method of every row of the request: as sent, or the expansion of "all". */
function rowsAsked(request: TuningRequest, result: Result): TuneEntry[] {
  const all = request.tune === undefined || asksForAll(request.tune);
  return all ? everyMethod(result) : (request.tune as TuneEntry[]);
}

/** True for settings that the request gives: no method made them. */
export const isGiven = ({ method }: Entry): boolean => method === "baseline" || method === "given";

/** The row of the request for every entry; -1 for settings that it gives. */
export function rowsOf(request: TuningRequest, result: Result): number[] {
  const asked = rowsAsked(request, result);
  let row = -1;
  return result.controllers.map((entry, index) => {
    if (isGiven(entry)) return -1;
    if (isSibling(entry, result.controllers[index - 1])) return row;
    // A job that was stopped early has no entries for some rows.
    const next = asked.findIndex((tune, at) => at > row && tune.method === entry.method);
    if (next >= 0) row = next;
    return next;
  });
}

/** The method and options of the entry with that index; null for settings that the request gives. */
export function tuneEntryOf(request: TuningRequest, result: Result, index: number): TuneEntry | null {
  const entry = result.controllers[index];
  if (!entry || isGiven(entry)) return null;
  return rowsAsked(request, result)[rowsOf(request, result)[index] ?? -1] ?? { method: entry.method };
}

/** The same request with other options in the row of one of its entries. Of a comparison of all methods that row alone
    remains: a request may not list as many rows, and the others would be computed again. */
export function withTune(request: TuningRequest, result: Result, index: number, tune: TuneEntry): TuningRequest {
  if (asksForAll(request.tune)) return { ...request, tune: [tune] };
  const row = rowsOf(request, result)[index];
  return { ...request, tune: rowsAsked(request, result).map((entry, at) => (at === row ? tune : entry)) };
}

/** The same request with a given controller: in place of the entry's if it is one, else after the others. Returns the
    index of its entry too. */
export function withGiven(
  request: TuningRequest,
  { controllers }: Result,
  index: number,
  given: GivenController,
): { request: TuningRequest; index: number } {
  const before = controllers.filter((entry) => entry.method !== "baseline").length;
  const at = controllers[index]?.method === "given" ? index : before;
  const list = [...(request.controllers ?? [])];
  list[at - before + list.length] = given;
  return { request: { ...request, controllers: list }, index: at };
}

/** The same request with other options of a method; null: of the only one. */
export function withOptions(request: TuningRequest, method: string | null, options: Record<string, number>): TuningRequest {
  const given = Array.isArray(request.tune) ? request.tune : [{ method: method ?? "robust" }];
  const tune = given.map((entry) => (method === null || entry.method === method ? { ...entry, ...options } : entry));
  return { ...request, tune };
}

/** `index`: of the entry in the result. Options that replace lambda are left out. */
export function withLambda(request: TuningRequest, result: Result, index: number, lambda: number, methods: readonly Method[]): TuningRequest {
  const entry = tuneEntryOf(request, result, index);
  if (!entry) return request;
  const described = methods.find(({ id }) => id === entry.method)?.options?.properties ?? {};
  const kept = Object.entries(entry).filter(([name]) => described[name]?.["x-in-place-of"] !== "lambda");
  return withTune(request, result, index, { ...Object.fromEntries(kept), method: entry.method, lambda, curve: true });
}

/** With a proof that no other controller is better by more than `gap`, a share. `index`: of the entry in the result. */
export function withCertificate(request: TuningRequest, result: Result, index: number, gap: number): TuningRequest {
  const entry = tuneEntryOf(request, result, index);
  return entry ? withTune(request, result, index, { ...entry, certify: { gap } }) : request;
}

/** "all" as an explicit list, each variant with its options. */
const everyMethod = (result: Result): TuneEntry[] =>
  result.controllers
    .filter((entry, index) => !isGiven(entry) && !isSibling(entry, result.controllers[index - 1]))
    .map((entry) => ({
      method: entry.method,
      ...Object.fromEntries(Object.entries(entry.options ?? {}).filter(([, value]) => value !== null)),
    }));

/** True if every method was requested, as a word or as one of the methods. */
export const asksForAll = (tune: TuningRequest["tune"]): boolean =>
  typeof tune === "string" || (tune ?? []).some((entry) => entry.method === "all");

export const EVERY_METHOD: TuneEntry[] = [{ method: "all" }];

/** The same subject, tuned by every method; a design's own limits on Ms and Mt hold for the comparison too. */
export function byAllMethods(request: TuningRequest): TuningRequest {
  const design = Array.isArray(request.tune) && request.tune.length === 1 ? request.tune[0]! : null;
  const limits = Object.fromEntries(
    (["Ms", "Mt"] as const).flatMap((name) => (design?.method === "robust" && typeof design[name] === "number" ? [[name, design[name]]] : [])),
  );
  return { ...request, tune: EVERY_METHOD.map((every) => ({ ...every, ...limits })) };
}
