// Parsing of a typed plant, with its formula; simulation of a relay test on a plant; identification from a recorded
// test.
import { call } from "./client.ts";
import type { IdentifyRequest, Model, Plant, PlantAnswer, PlantQuestion, RecordedTest, RelayAnswer, RelayRequest } from "./types.ts";

/** A fault is a normal answer here, because the text is mostly unfinished while the user types. */
export async function parsePlant(question: PlantQuestion): Promise<PlantAnswer> {
  return (await call("POST", "v1/plants/parse", { ...question, unfinished: true })).data as PlantAnswer;
}

const KEPT = 100;
const known = new Map<string, Promise<string | undefined>>();

/** The MathML of a plant, requested once; undefined if it has none. */
export function formulaText(plant: Plant): Promise<string | undefined> {
  const key = JSON.stringify(plant);
  let formula = known.get(key);
  if (!formula) {
    formula = parsePlant({ plant }).then((answer) => answer.formula);
    // Without a formula the page shows the plant in words; a later request may succeed.
    formula.catch(() => known.delete(key));
    if (known.size >= KEPT) known.clear();
    known.set(key, formula);
  }
  return formula;
}

export async function simulateRelay(request: RelayRequest): Promise<RelayAnswer> {
  return (await call("POST", "v1/experiments/relay", request)).data as RelayAnswer;
}

interface AboutRecord {
  record?: RecordedTest;
  identify?: Record<string, unknown>;
}

/** The request, with the traces of the models if it is about a record: the page draws the record with its models. */
export function withTraces<Request extends AboutRecord>(request: Request): Request {
  return request.record ? { ...request, identify: { ...request.identify, traces: true } } : request;
}

/** The model that the service identifies from the record, with its traces. */
export async function identify(request: IdentifyRequest): Promise<Model> {
  return ((await call("POST", "v1/identify", withTraces(request))).data as { model: Model }).model;
}
