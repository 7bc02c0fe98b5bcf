// An operating range in words: the state of its schedule, its settings, its points, its runs.
import type { RangeRequest } from "../api/range.ts";
import type { Finding, OneSetting, RangeContent, RangeRun, WorstPlace } from "../api/types.ts";
import { DASH, formatNumber, formatSetting, product, quotient, withUnit } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

export const INTERPOLATIONS = [
  ["linear_in_gains", "linear in Kp, 1/Ti, Td"],
  ["linear_in_times", "linear in Kp, Ti, Td"],
  ["steps", "steps with hysteresis"],
] as const;

export const interpolationWords = (id: string): string => INTERPOLATIONS.find(([known]) => known === id)?.[1] ?? id;

/** A place with the name and unit of its variable: "load 60 %"; only the number for a variable without a name. */
export function placeWords(at: number, { name, unit }: RangeContent["scheduling"], digits = 3): string {
  const named = name === "" || name === "at" ? "" : `${name} `;
  return `${named}${formatSetting(Number(at.toPrecision(digits)))}${unit ? ` ${unit}` : ""}`;
}

export const counted = (count: number, what: string): string => `${count} ${what}${count === 1 ? "" : "s"}`;

type Settings = Pick<OneSetting["controller"], "Kp" | "Ti" | "Td"> & { Tf?: number | null };

export const settingsOfOne = ({ controller }: OneSetting): Settings => ({
  Kp: controller.Kp,
  Ti: controller.Ti,
  Td: controller.Td,
  Tf: controller.filter?.Tf ?? 0,
});

/** Heading and unit of a setting's column. */
export function settingHead(name: string, units: UnitNames): string {
  if (name === "Kp") return withUnit(name, quotient(units.u, units.y));
  return name === "b" ? name : withUnit(name, units.time);
}

/** "Kp 0.451, Ti 9.1 s, Td 1.2 s": a zero derivative is left out. */
export function settingWords(settings: Settings, units: UnitNames): string {
  const times = (["Ti", "Td", "Tf"] as const).flatMap((name) =>
    settings[name] ? [`${name} ${formatSetting(settings[name])} ${units.time}`] : [],
  );
  return [`Kp ${formatSetting(settings.Kp)}`, ...times].join(", ");
}

/** For results that were kept before the service judged a given schedule. */
const NOT_JUDGED: Finding = {
  code: "none",
  level: "note",
  text: "Computed by an older version: move a row for a verdict on this schedule.",
  figures: {},
};

export function verdictOf({ verdict, schedule, why_null }: RangeContent): Finding {
  if (verdict) return verdict;
  if (schedule) return NOT_JUDGED;
  return { code: "none", level: "bad", text: why_null?.["schedule"] ?? "There is no schedule for this range.", figures: {} };
}

const QUANTITIES: Record<WorstPlace["quantity"], string> = {
  Ms: "Ms",
  Mt: "Mt",
  relative_IAE: "IAE relative to the own optimum",
};

/** "Ms is largest at load 30 %: 1.40, limit 1.40." */
export function worstWords(places: WorstPlace[] | undefined, scheduling: RangeContent["scheduling"]): string[] {
  return (places ?? []).map(
    ({ quantity, at, value, limit }) =>
      `${QUANTITIES[quantity]} is largest at ${placeWords(at, scheduling)}: ${formatNumber(value)}, limit ${formatNumber(limit)}.`,
  );
}

/** The subject of a range's job, for its head. */
export function rangeWords(request: RangeRequest): string {
  const { name, unit } = request.scheduling ?? {};
  const over = name ? ` over ${withUnit(name, unit ?? "")}` : "";
  if (request.points) return `operating range${over}: ${counted(request.points.length, "point")}`;
  const way = request.range;
  return way ? `operating range${over} of equations, ${way.from} to ${way.to}` : `operating range${over}`;
}

/** Figures of a run, by name; a missing one is a dash. */
export function runFacts(run: Partial<RangeRun>, units: UnitNames): [string, string][] {
  const yes = (is: boolean | undefined): string => (is === undefined ? DASH : is ? "yes" : "no");
  return [
    [withUnit("IAE", product(units.y, units.time)), formatNumber(run.IAE)],
    [withUnit("Largest error", units.y), formatNumber(run.largest_error)],
    [withUnit("Largest bump", units.u), formatNumber(run.largest_bump)],
    ["Switches", run.switches === undefined ? DASH : String(run.switches)],
    ["Reached a limit", yes(run.limited)],
    ["Settled", run.ended ? `ended early: ${run.ended}` : yes(run.settled)],
  ];
}
