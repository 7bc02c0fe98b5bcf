// The figures of an entry, with their names and units, in display order.
import type { Entry, Figures, WhyNull } from "../api/types.ts";
import type { ExplainedName } from "./explained.ts";
import { figureUnit } from "./figure_units.ts";
import { formatNumber, formatPercent, formatShare, withUnit } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

export interface FigureRow<T = Entry> {
  label: string;
  /** Explanation of the quantity for readers who do not know it. */
  meaning: string;
  /** Its longer explanation, if there is one. */
  about: ExplainedName | null;
  value(entry: T): FigureValue;
}

export interface FigureValue {
  text: string;
  /** The reason why there is no number; "" if there is one. */
  why: string;
}

export interface FigureGroup<T = Entry> {
  title: string;
  /** Shown directly, or under "all figures". */
  main: boolean;
  rows: FigureRow<T>[];
}

type Part = { why_null?: WhyNull } | undefined;

const missing = (why: string): FigureValue => ({ text: "", why });

/** A number of one of the entry's objects, with that object's reason if it is null. */
export function numeric(part: Part, name: string, absent: string): FigureValue {
  const value = (part as Record<string, unknown> | undefined)?.[name];
  if (typeof value === "number" && Number.isFinite(value)) {
    return { text: name.endsWith("_percent") ? formatPercent(value) : formatNumber(value), why: "" };
  }
  return missing(part?.why_null?.[name] ?? absent);
}

export const NOT_GIVEN = "The service gave no figure.";

/** "12.5 (asked 5.00)" if the loop exceeds the limit of its design. */
function overshoot(entry: Entry): FigureValue {
  const reached = numeric(entry.performance?.["setpoint"], "overshoot_percent", NOT_GIVEN);
  return { ...reached, text: reached.text && reached.text + limitNote(entry) };
}

/** The design's limit on the overshoot, in percent, if the verdict says that the loop exceeds it. */
function missedOvershoot(entry: Entry): { who: "asked" | "design"; percent: number } | null {
  const figures = entry.verdict?.find(({ code }) => code === "overshoot")?.figures ?? {};
  for (const who of ["asked", "design"] as const) {
    const percent = figures[`${who}_percent`];
    if (typeof percent === "number") return { who, percent };
  }
  return null;
}

export const missesOvershoot = (entry: Entry): boolean => missedOvershoot(entry) !== null;

/** " (asked 5.00)" after an overshoot above the limit of the request, " (design 5.00)" above the method's own; else "". */
export function limitNote(entry: Entry): string {
  const missed = missedOvershoot(entry);
  return missed === null ? "" : ` (${missed.who} ${formatNumber(missed.percent)})`;
}

export function filterWords(type: string | undefined): string {
  switch (type) {
    case undefined:
    case "none":
      return "none";
    case "derivative":
      return "on the derivative";
    case "measurement_first_order":
      return "1st order on y";
    case "measurement_second_order":
      return "2nd order on y";
    default:
      return type.replaceAll("_", " ");
  }
}

/** `region`: includes the figures of controllers for more than one plant; `nonlinear`: includes those of nonlinear
    ones. */
export function figureGroups(units: UnitNames, region = false, nonlinear = false): FigureGroup[] {
  const controller = (name: ExplainedName, meaning: string, absent: string): FigureRow => ({
    label: withUnit(name, figureUnit("NonlinearController", name, units)),
    meaning,
    about: name,
    value: (entry) => numeric(entry.controller as Figures | undefined, name, absent),
  });
  const robustness = (label: string, name: ExplainedName, meaning: string): FigureRow => ({
    label: withUnit(label, figureUnit("Robustness", name, units)),
    meaning,
    about: name,
    value: (entry) => numeric(entry.robustness, name, NOT_GIVEN),
  });
  const performance = (
    kind: "setpoint" | "load",
    label: string,
    name: ExplainedName,
    meaning: string,
  ): FigureRow => ({
    label: withUnit(label, figureUnit(kind === "load" ? "LoadPerformance" : "SetpointPerformance", name, units)),
    meaning,
    about: name,
    value: (entry) => numeric(entry.performance?.[kind], name, NOT_GIVEN),
  });
  return [
    {
      title: "Controller",
      main: false,
      rows: [
        controller("Kp", "proportional gain", NOT_GIVEN),
        controller("Ti", "integral time", "no integral action"),
        controller("Td", "derivative time", "no derivative action"),
        { label: withUnit("Tf", units.time), meaning: "filter time constant", about: "Tf", value: (entry) => filterTime(entry) },
        ...(nonlinear
          ? [controller("delta_r", "much larger errors hardly enter the integral", "a linear controller")]
          : []),
      ],
    },
    {
      title: "Robustness",
      main: true,
      rows: [
        robustness("Ms", "Ms", "peak of |S|: 1/Ms is the distance of L from −1; the smaller Ms, the more robust"),
        robustness("Mt", "Mt", "peak of |T|"),
        robustness("Gain margin", "gain_margin", "the loop gain may grow by this factor"),
        robustness("Phase margin", "phase_margin_deg", "smallest over all crossings"),
        ...(region ? regionRows() : []),
      ],
    },
    {
      title: "Load step",
      main: true,
      rows: [
        performance("load", "IAE", "IAE", "integrated absolute error: less is better"),
        performance("load", "Peak", "peak", "largest deviation, with its sign"),
      ],
    },
    {
      title: "Set-point step",
      main: true,
      rows: [
        performance("setpoint", "IAE", "IAE", "integrated absolute error"),
        { label: "Overshoot (%)", meaning: "of the step; in brackets the limit", about: "overshoot_percent", value: overshoot },
        performance("setpoint", "Settling", "settling_time", "last time outside 2 % of the step"),
        performance("setpoint", "TV of u", "TV", "total movement of the controller's output"),
      ],
    },
    {
      title: "Controller, other figures",
      main: false,
      rows: [
        {
          label: "Filter",
          meaning: "where it acts",
          about: "filter",
          value: (entry) => ({ text: filterWords(entry.controller?.filter?.type), why: "" }),
        },
        controller("b", "set-point weight of P", "1 by default"),
        controller("c", "set-point weight of D", "0 by default"),
        {
          label: withUnit("Longest sample time", units.time),
          meaning: "of a program: Ms stays within 5 %",
          about: "longest_sample_time",
          value: ({ longest_sample_time: longest }) =>
            typeof longest === "number"
              ? { text: formatNumber(longest), why: "" }
              : missing(longest === null ? "With no sample time Ms stays within 5 %." : "It is not computed for these settings."),
        },
        {
          label: "Action",
          meaning: "sign of the gain",
          about: "action",
          value: (entry) => ({ text: entry.controller?.action ?? "", why: entry.controller?.action ? "" : NOT_GIVEN }),
        },
      ],
    },
    {
      title: "Robustness, other figures",
      main: false,
      rows: [
        robustness("Mks", "Mks", "peak of |CS|: how much noise may reach u"),
        robustness("Gain margin, low", "gain_margin_low", "the loop gain may fall to this fraction"),
        robustness("Delay margin", "delay_margin", "the loop is stable with this much more dead time"),
        robustness("ω of Ms", "omega_Ms", "where |S| peaks"),
        robustness("ω of Mt", "omega_Mt", "where |T| peaks"),
        robustness("Gain crossover", "gain_crossover", "where |L| = 1"),
        robustness("Phase crossover", "phase_crossover", "where L is at −180°"),
      ],
    },
    {
      title: "Load step, other figures",
      main: false,
      rows: [
        performance("load", "ISE", "ISE", "integrated squared error"),
        performance("load", "ITAE", "ITAE", "integrated absolute error, weighted by time"),
        performance("load", "Recovery", "recovery_time", "last time outside 2 % of the peak"),
        performance("load", "TV of u", "TV", "total movement of the controller's output"),
      ],
    },
    {
      title: "Set-point step, other figures",
      main: false,
      rows: [
        performance("setpoint", "ISE", "ISE", "integrated squared error"),
        performance("setpoint", "ITAE", "ITAE", "integrated absolute error, weighted by time"),
        performance("setpoint", "Rise", "rise_time", "from 10 % to 90 %"),
        performance("setpoint", "First move of u", "first_move", "u right after the step"),
      ],
    },
  ];
}

function regionRows(): FigureRow[] {
  const alone = "There is only one plant.";
  return [
    {
      label: "Stable plants (%)",
      meaning: "of all plants: the set, the ranges or the confidence region",
      about: "stable_fraction",
      value: ({ region }) =>
        typeof region?.stable_fraction === "number"
          ? { text: formatShare(region.stable_fraction), why: "" }
          : missing(alone),
    },
    {
      label: "Worst Ms",
      meaning: "the largest of all these plants",
      about: "worst_Ms",
      value: ({ region }) => numeric(region, "worst_Ms", alone),
    },
  ];
}

function filterTime(entry: Entry): FigureValue {
  const filter = entry.controller?.filter;
  if (typeof filter?.Tf === "number") return { text: formatNumber(filter.Tf), why: "" };
  const Td = entry.controller?.Td;
  if (typeof filter?.N === "number" && typeof Td === "number" && filter.N > 0)
    return { text: formatNumber(Td / filter.N), why: "" };
  return missing("no filter");
}
