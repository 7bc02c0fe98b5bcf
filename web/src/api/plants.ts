// What a typed plant means, and a plant's formula: the service reads and writes both.
import { call } from "./client.ts";
import type { Plant } from "./types.ts";

export interface PlantQuestion {
  text?: string;
  plant?: Plant;
  /** The label in which the answer's times are. */
  units?: { time?: string };
}

export interface PlantAnswer {
  plant?: Plant;
  /** MathML; none where there is a fault. */
  formula?: string;
  /** As it would be typed; "" for a plant that has no such text. */
  text?: string;
  fault?: string;
}

/** A fault is an answer here, because most of what stands in a field while somebody types is unfinished. */
export async function parsePlant(question: PlantQuestion): Promise<PlantAnswer> {
  return (await call("POST", "v1/plants/parse", { ...question, unfinished: true })).data as PlantAnswer;
}

const KEPT = 100;
const known = new Map<string, Promise<string | undefined>>();

/** The MathML of a plant, asked for once; undefined where it has none. */
export function formulaText(plant: Plant): Promise<string | undefined> {
  const key = JSON.stringify(plant);
  let formula = known.get(key);
  if (!formula) {
    formula = parsePlant({ plant }).then((answer) => answer.formula);
    // Without a formula the page says the same in words; another time it may be there.
    formula.catch(() => known.delete(key));
    if (known.size >= KEPT) known.clear();
    known.set(key, formula);
  }
  return formula;
}
