// What a candidate that was chosen on Identify is tuned as: its record where that leads to the same model again, else its plant.
import type { Candidate, IdentifyRequest, Model, Plant } from "../api/types.ts";

export type TuneSubject =
  /** `uncertainty` "identified": limits hold on all that the record leaves possible. */
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
