// The three facts next to a verdict: robustness, load, set point; of the implemented loop where it is known.
import type { Entry, Figures } from "../api/types.ts";
import type { ExplainedName } from "./explained.ts";
import { limitNote } from "./figures.ts";
import { figureUnit } from "./figure_units.ts";
import { formatNumber, formatPercent, withUnit } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";
import { running } from "./running.ts";

export interface Fact {
  label: string;
  /** Its explanation. */
  about: ExplainedName;
  value: string;
  /** The reference of the value: a limit, or today's; "" if there is none. */
  reference: string;
}

const numberOf = (part: unknown, name: string): number | null => {
  const value = (part as Figures | undefined)?.[name];
  return typeof value === "number" && Number.isFinite(value) ? value : null;
};

/** Facts without a figure are left out. `today`: the entry of today's settings. */
export function factsOf(entry: Entry, today: Entry | undefined, units: UnitNames): Fact[] {
  const { robustness, performance, region } = running(entry);
  const worst = numberOf(region, "worst_Ms");
  const load = numberOf(performance?.load, "IAE");
  const before = today && today !== entry ? numberOf(running(today).performance?.load, "IAE") : null;
  const overshoot = numberOf(performance?.setpoint, "overshoot_percent");
  const facts: { label: string; about: ExplainedName; number: number | null; text: (value: number) => string; reference: string }[] = [
    { label: worst === null ? "Ms" : "Worst Ms", about: worst === null ? "Ms" : "worst_Ms", number: worst ?? numberOf(robustness, "Ms"), text: formatNumber, reference: "" },
    {
      label: withUnit("Load IAE", figureUnit("LoadPerformance", "IAE", units)),
      about: "IAE",
      number: load,
      text: formatNumber,
      reference: before === null ? "" : `today ${formatNumber(before)}`,
    },
    { label: "Overshoot (%)", about: "overshoot_percent", number: overshoot, text: formatPercent, reference: limitNote(entry).replaceAll(/[()]/g, "").trim() },
  ];
  return facts.flatMap(({ label, about, number, text, reference }) => (number === null ? [] : [{ label, about, value: text(number), reference }]));
}
