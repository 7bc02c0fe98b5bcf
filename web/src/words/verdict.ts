// The verdict in words, from the figures of an entry. Used where the service sends none.
import type { Entry, TuningRequest } from "../api/types.ts";
import { limitsOf } from "./limits.ts";
import { formatNumber, product, unitNames } from "./numbers.ts";

export type Level = "good" | "warn" | "bad";

export interface Verdict {
  level: Level;
  head: string;
  sentences: string[];
}

/** Above this Ms a loop has little margin left, and above the second it is too sharp. */
const LITTLE_MARGIN_MS = 1.7;
const TOO_SHARP_MS = 2;
/** A limit counts as reached within this relative distance. */
const REACHED = 2e-3;
/** Worth a sentence: a difference of indices of this factor. */
const WORTH_SAYING = 1.15;

const figure = (entry: Entry | undefined, kind: "setpoint" | "load", name: string): number | null => {
  const value = entry?.performance?.[kind]?.[name];
  return typeof value === "number" ? value : null;
};

/** What to say of `entry`; `today` is the evaluation of the settings in use, if given. */
export function verdictOf(entry: Entry, today: Entry | undefined, request: TuningRequest | undefined): Verdict {
  if (entry.error) {
    return {
      level: "bad",
      head: "This method has no answer here.",
      sentences: [entry.error.detail ?? entry.error.title ?? "It gave no reason."],
    };
  }
  const robustness = entry.robustness;
  if (!robustness || !robustness.stable) {
    const first = entry.warnings?.[0]?.detail;
    return {
      level: "bad",
      head: "This loop is unstable.",
      sentences: ["With these settings the loop runs away: do not enter them.", ...(first ? [first] : [])],
    };
  }
  const units = unitNames(request?.units);
  return {
    ...builtHeading(entry, regionHeading(entry, heading(entry))),
    sentences: [
      ...builtSentences(entry),
      ...limitSentences(entry, units.time),
      ...nonlinearSentences(entry),
      ...regionSentences(entry),
      ...toleranceSentences(entry, units.time),
      ...costSentences(entry, today, units),
      ...deadTimeSentences(entry, request, units.time),
    ],
  };
}

/** Judged by what runs: the loop as it is built, where that is known. */
function heading(entry: Entry): Pick<Verdict, "level" | "head"> {
  const runs = entry.implemented?.robustness ?? entry.robustness;
  const Ms = runs?.Ms ?? null;
  if (Ms === null) return { level: "warn", head: "Stable, with an unknown margin." };
  if (Ms > TOO_SHARP_MS * (1 + 1e-6)) return { level: "bad", head: "Too sharp for a plant that changes." };
  if (Ms > LITTLE_MARGIN_MS * (1 + 1e-6)) return { level: "warn", head: "Fast, with little margin left." };
  if (entry.method !== "baseline" && reached(entry, runs).length > 0)
    return { level: "good", head: "Robust, limited by the margin you asked for." };
  return { level: "good", head: entry.method === "baseline" ? "Today's settings are robust." : "Robust." };
}

/** A loop that is unstable on some of the plants it must serve is no good, however the nominal one fares. */
function regionHeading(entry: Entry, nominal: Pick<Verdict, "level" | "head">): Pick<Verdict, "level" | "head"> {
  const stable = entry.region?.stable_fraction;
  return typeof stable === "number" && stable < 1
    ? { level: "bad", head: "Unstable on a part of what the plant may be." }
    : nominal;
}

/** What is typed is what runs: no margin of the ideal loop helps where the built one runs away. */
function builtHeading(entry: Entry, ideal: Pick<Verdict, "level" | "head">): Pick<Verdict, "level" | "head"> {
  return entry.implemented?.robustness.stable === false
    ? { level: "bad", head: "Unstable on your controller as it is built." }
    : ideal;
}

function builtSentences(entry: Entry): string[] {
  const { robustness, performance } = entry.implemented ?? {};
  if (!robustness) return [];
  if (!robustness.stable) return ["Only the ideal loop is stable: sample faster, or design for your controller."];
  const IAE = performance?.load?.["IAE"];
  const cost = typeof IAE === "number" ? ` and a load disturbance costs ${formatNumber(IAE)}` : "";
  return [`On your controller as it is built Ms is ${formatNumber(robustness.Ms)}${cost}; what follows is the ideal loop's.`];
}

function regionSentences(entry: Entry): string[] {
  const { stable_fraction: stable, worst_Ms: worst } = entry.region ?? {};
  if (typeof stable !== "number") return [];
  if (stable >= 1)
    return [
      `It is stable on every plant that this one may be${typeof worst === "number" ? `, with Ms ${formatNumber(worst)} at worst` : ""}.`,
    ];
  return [
    `It is stable on ${percent(stable)} % of the plants that this one may be. Record a better test, or lower Ms.`,
  ];
}

/** Never 100 for less than all, never 0 for more than nothing. */
export const percent = (fraction: number): string =>
  String(fraction > 0 ? Math.max(0.1, Math.floor(1000 * fraction + 1e-9) / 10) : 0);

/** The limits that the design touches. */
function reached(entry: Entry, robustness = entry.robustness): ("Ms" | "Mt" | "Mks")[] {
  const limits = limitsOf(entry);
  return (["Ms", "Mt", "Mks"] as const).filter((name) => {
    const limit = limits[name];
    const value = robustness?.[name];
    return limit !== null && typeof value === "number" && Math.abs(value / limit - 1) < REACHED;
  });
}

function limitSentences(entry: Entry, time: string): string[] {
  const robustness = entry.robustness!;
  const { Ms, Mt } = robustness;
  const active = reached(entry);
  const at = (omega: number | null): string =>
    omega === null || omega === 0 ? "" : ` at ${formatNumber(omega)} rad/${time}`;
  if (active.includes("Ms") && active.includes("Mt")) {
    return [
      `Both limits stop it: Ms = ${formatNumber(Ms)}${at(robustness.omega_Ms)} and Mt = ${formatNumber(Mt)}${at(robustness.omega_Mt)}.`,
    ];
  }
  const room = (name: string, value: number | null): string =>
    value === null ? "" : ` ${name} (${formatNumber(value)}) has room.`;
  if (active.includes("Ms"))
    return [`The limit that stops it is Ms = ${formatNumber(Ms)}${at(robustness.omega_Ms)}.${room("Mt", Mt)}`];
  if (active.includes("Mt"))
    return [`The limit that stops it is Mt = ${formatNumber(Mt)}${at(robustness.omega_Mt)}.${room("Ms", Ms)}`];
  if (active.includes("Mks"))
    return [`The limit that stops it is the noise gain Mks = ${formatNumber(robustness.Mks)}.${room("Ms", Ms)}`];
  return Ms === null
    ? []
    : [
        `The sensitivity peak Ms is ${formatNumber(Ms)}${at(robustness.omega_Ms)}${Mt === null ? "" : `, Mt is ${formatNumber(Mt)}`}.`,
      ];
}

function nonlinearSentences(entry: Entry): string[] {
  if (entry.controller?.form !== "npid") return [];
  const proof = entry.nonlinear?.statement;
  return [
    "Ms and all margins belong to its linear part, where errors are small against delta_r; the responses are those of these steps and change with their size.",
    ...(proof ? [proof] : []),
  ];
}

function toleranceSentences(entry: Entry, time: string): string[] {
  const gain = entry.robustness!.gain_margin;
  const delay = entry.robustness!.tolerates?.extra_dead_time ?? entry.robustness!.delay_margin;
  const low = entry.robustness!.gain_margin_low;
  const falls = typeof low === "number" && low > 0 ? `fall to ${formatNumber(low, 2)} of itself` : "";
  const grows = typeof gain === "number" ? `grow ${gain > 100 ? "more than 100" : formatNumber(gain, 2)}-fold` : "";
  const parts: string[] = [];
  if (falls || grows) parts.push(`the process gain may ${[falls, grows].filter(Boolean).join(" or ")}`);
  if (typeof delay === "number")
    parts.push(`the dead time ${falls || !grows ? "may grow " : ""}by ${formatNumber(delay, 2)} ${time}`);
  if (parts.length === 0) return [];
  const sentence = `${parts.join(", or ")} before the loop oscillates.`;
  return [sentence[0]!.toUpperCase() + sentence.slice(1)];
}

function costSentences(entry: Entry, today: Entry | undefined, units: ReturnType<typeof unitNames>): string[] {
  const IAE = figure(entry, "load", "IAE");
  if (IAE === null) return [];
  const unit = product(units.y, units.time);
  const before = figure(today, "load", "IAE");
  const spoken = `${formatNumber(IAE)}${unit ? ` ${unit}` : ""}`;
  if (entry.method === "baseline" || before === null || IAE <= 0)
    return [`A load disturbance costs ${spoken} of integrated error.`];
  const ratio = before / IAE;
  const change =
    ratio >= WORTH_SAYING
      ? `: ${formatNumber(ratio, 2)} times less`
      : ratio <= 1 / WORTH_SAYING
        ? `: ${formatNumber(1 / ratio, 2)} times more`
        : ": about the same";
  const sentences = [
    `A load disturbance costs ${spoken} instead of ${formatNumber(before)} with today's settings${change}.`,
  ];
  const [TV, TVbefore] = [figure(entry, "setpoint", "TV"), figure(today, "setpoint", "TV")];
  if (TV !== null && TVbefore !== null && TVbefore > 0 && TV / TVbefore > 1.5) {
    sentences.push(
      `The valve moves ${formatNumber(TV / TVbefore, 2)} times as much as today on a set-point step (TV ${formatNumber(TV, 2)} against ${formatNumber(TVbefore, 2)}). If that wears it, lower Ms or raise Tf.`,
    );
  }
  return sentences;
}

function deadTimeSentences(entry: Entry, request: TuningRequest | undefined, time: string): string[] {
  const plant = entry.reduced_model ?? request?.plant;
  const [T, L] = [plant?.["T"], plant?.L];
  if (plant?.type !== "fopdt" || typeof T !== "number" || typeof L !== "number" || T <= 0 || L / T < 2) return [];
  return [
    `Dead time is ${formatNumber(L / T, 2)} times the lag: nothing can act sooner than ${formatNumber(L)} ${time} after a disturbance. A shorter dead time would help more than any tuning.`,
  ];
}
