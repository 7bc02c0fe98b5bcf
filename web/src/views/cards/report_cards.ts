// The cards for methods' reports in addition to the controller: one line for each. A card hides itself if the entry has
// no such report.
import type { Controller, Entry, Plant, TuningRequest } from "../../api/types.ts";
import type { UnitNames } from "../../words/numbers.ts";
import { certificateCard } from "../../proof/certificate_card.ts";
import type { StoredEntry } from "../../proof/certificate_card.ts";
import { emulationCard } from "./emulation_card.ts";
import { rimcCard } from "./rimc_card.ts";
import { tradeoffCard } from "./tradeoff_card.ts";

/** An entry with the data for its reports. */
export interface ReportedEntry {
  name: string;
  entry: Entry;
  /** The linear plant that rules and robustness use. */
  model: Plant | undefined;
  request: TuningRequest | undefined;
  /** Its place in the job; null for a design that has moved away from it. */
  stored: StoredEntry | null;
  units: UnitNames;
}

export interface ReportCard {
  element: HTMLElement;
  /** Above or below the plots. */
  place: "above" | "folded" | "below";
  show(shown: ReportedEntry): void;
  dispose(): void;
}

type Announce = (sentence: string) => void;

export interface ReportEvents {
  onRetune(lambda: number): Promise<void>;
  /** Designs again, with a proof that no other is better by more than this share. */
  onProve(gap: number): Promise<void>;
  /** Settings are tried by hand; null: no longer. */
  onTry(controller: Controller | null): void;
}

const CARDS: ((announce: Announce, events: ReportEvents) => ReportCard)[] = [
  (_announce, events) => {
    const card = certificateCard(events.onProve);
    return { ...card, place: "folded", show: ({ entry, stored, units }) => card.show(entry, stored, units) };
  },
  (announce, events) => {
    const card = rimcCard(announce, events.onRetune);
    return { ...card, place: "above", show: ({ entry, model, units }) => card.show(entry, model, units) };
  },
  (announce, events) => {
    const card = emulationCard(announce, events.onTry);
    return { ...card, place: "above", show: ({ entry, request, units }) => card.show(entry, request?.plant, units) };
  },
  (announce) => {
    const card = tradeoffCard(announce);
    return { ...card, place: "below", show: ({ name, entry, model, units }) => card.show([{ name, entry }], model, units.time) };
  },
];

export const reportCards = (announce: Announce, events: ReportEvents): ReportCard[] =>
  CARDS.map((create) => create(announce, events));
