// Loops around the loop in words: conclusions, names of controllers, inputs and curves, and what to type.
import type { Conclusion, StructureAnswer } from "../api/structure.ts";
import type { Controller, Finding } from "../api/types.ts";
import { formatNumber, formatSetting, formatShare, plainSetting, quotient, withUnit } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

/**
 * Sentences with {names} of figures; {wrong%} is one in percent, and { y} a unit after a blank. A sentence with a figure
 * that is not known is replaced by the reason. The report has the same words: api/report/structure/structure_words.cpp.
 */
const SENTENCES: Record<string, readonly [Finding["level"], string]> = {
  unstable: ["bad", "The loops are not stable together, so there are no other figures."],
  "cascade-pays": ["good", "The cascade pays. A single loop has {gain_inner} times its IAE after a load at the valve, {gain_outer} times after a load on the outer plant, and {gain_setpoint} times after a set-point step."],
  "cascade-gains-little": ["warning", "The cascade gains little. A single loop has {gain_inner} times its IAE after a load at the valve, {gain_outer} times after a load on the outer plant, and {gain_setpoint} times after a set-point step."],
  "inner-too-slow": ["warning", "The inner loop is only {speed_ratio} times as fast as the outer one; it should be at least {at_least} times as fast."],
  "inner-peak-above": ["bad", "Ms of the inner loop is {Ms}, above its limit of {limit}."],
  "outer-peak-above": ["bad", "Ms of the outer loop is {Ms}, above its limit of {limit}."],
  "valve-peak-above": ["bad", "Ms at the valve is {Ms}, above its limit of {limit}."],
  "near-lowest-rate": ["good", "The outflow moves about as slowly as it can. Its largest rate is {rate_over_bound} times the lowest that any controller can reach with this room for the level."],
  "level-above-room": ["bad", "The level rises by {highest}{ y}, above the allowed {allowed}{ y}."],
  "flow-loop-too-slow": ["warning", "The flow loop is slow for this level loop: with it Ms is {Ms}, above {limit}. Make it faster, or allow the level more room."],
  "flow-loop-unstable": ["bad", "With this flow loop the level is not stable."],
  "feedforward-exact": ["good", "The compensator is exact: the disturbance does not move y."],
  "feedforward-pays": ["good", "Feedforward pays. Without it the IAE after the disturbance is {gain} times as large."],
  "feedforward-worse-than-none": ["bad", "Feedforward does harm. Without it the IAE after the disturbance is {gain} times as large."],
  "feedforward-gains-little": ["warning", "Feedforward gains little. Without it the IAE after the disturbance is {gain} times as large."],
  "gain-alone-worse-than-none": ["warning", "A gain alone would be worse than no feedforward: its IAE is {IAE}, without feedforward {IAE_none}."],
  "peak-unavoidable": ["note", "The valve acts later than the disturbance, so y reaches {peak_bound}{ y} with any compensator; without feedforward it reaches {peak}{ y}."],
  "wrong-model-worse-than-none": ["warning", "If a gain or dead time is wrong by {wrong%} %, the IAE can be {IAE}, above the {IAE_none} without feedforward."],
  "pid-does-as-well": ["note", "A PID with the same Ms does as well. After a load its IAE is {IAE_pid}, that of the predictor {IAE}."],
  "predictor-pays": ["good", "The predictor pays. After a load its IAE is {IAE}, that of a PID with the same Ms {IAE_pid}."],
  "limited-by-dead-time-error": ["note", "The error that the dead time may have limits this design, not Ms, which is {Ms}."],
  "narrow-dead-time-window": ["bad", "The loop is stable only while the dead time is known to {window}{ time}; {at_least}{ time} are advisable."],
  "controller-unstable": ["warning", "The controller by itself is not stable. It must not run without its feedback, as with the valve at a limit."],
  "pairing-impossible": ["bad", "This pairing cannot be used with integral action. Its lowest relative gain is {relative_gain}. Its Niederlinski index is {niederlinski}."],
  "other-pairing-better": ["warning", "Another pairing is better: its lowest relative gain is {other}, that of this one {relative_gain}."],
  "hardly-interacting": ["good", "The loops hardly disturb each other and can be tuned one by one: all relative gains are near 1."],
  "mu-above": ["bad", "The peak mu of all loops is {mu}, above its limit of {limit}."],
  "subsets-unstable": ["warning", "Some loops are not stable while others are in manual: {count} sets of them."],
  "better-than-blt": ["good", "Luyben's BLT tuning has {gain} times the weighted IAE after loads."],
  "decoupler-worse-than-none": ["warning", "The decoupler does harm after loads. Without it the weighted IAE is {gain} times as large at the same limit."],
  "decoupler-fragile": ["warning", "The decoupler needs an exact model: a gain of the plant that is wrong by {wrong%} % raises the peak mu much, or makes the loops unstable. The largest relative gain is {relative_gain}."],
  "decoupler-helps": ["note", "Without a decoupler the weighted IAE after loads is {gain} times as large at the same limit."],
};

export interface StructureFinding {
  code: string;
  level: Finding["level"];
  text: string;
}

/** A code that is newer than the page is shown as it is. */
export function conclusionWords({ code, figures }: Conclusion, units: UnitNames): StructureFinding {
  const [level, template] = SENTENCES[code] ?? (["note", `${code.replaceAll("-", " ")}.`] as const);
  const { why_null = {}, ...known } = figures as Record<string, number | null> & { why_null?: Record<string, string> };
  const filled = (form: string): string =>
    form.replace(/\{( ?)(\w+)(%?)\}/g, (_, blank: string, name: string, percent: string) => {
      if (blank) return units[name as keyof UnitNames] && ` ${units[name as keyof UnitNames]}`;
      return percent ? formatShare(known[name] ?? NaN) : formatNumber(known[name]);
    });
  const sentences = template.split(/(?<=\.) /).map((form) => {
    const unknown = Object.keys(why_null).find((name) => form.includes(`{${name}}`));
    return unknown ? why_null[unknown]! : filled(form);
  });
  return { code, level, text: [...new Set(sentences)].join(" ") };
}

const OF: Record<string, string> = {
  single: "single loop",
  baseline: "today",
  none: "no feedforward",
  no_decoupler: "without decoupler",
  static: "gain alone",
  guzman_hagglund: "Guzmán and Hägglund",
  optimum: "least IAE",
  pid: "PID",
  program: "call by call, with limits",
  blt: "BLT",
  detuned: "detuned",
  static_decoupler: "static decoupler",
  simplified_decoupler: "simplified decoupler",
};

/** A controller, or what it is compared with. */
export const nameOfDesign = (of: string): string => OF[of] ?? of.replaceAll("_", " ");

const INPUTS: Record<string, string> = {
  setpoint: "Set-point step",
  inner_load: "Load at the valve",
  outer_load: "Load on the outer plant",
  disturbance: "Step of the disturbance",
  inflow: "Largest step of the inflow",
  load: "Load at the plant input",
};

/** "load_2" is the second one; "setpoint of 5" a step of that size. */
export function nameOfInput(input: string): string {
  const [step = input, size] = input.split(" of ");
  if (size !== undefined) return `${nameOfInput(step)}, size ${size}`;
  const [, kind = input, number = ""] = /^(.*?)_?(\d+)?$/.exec(input) ?? [];
  return [INPUTS[input] ?? INPUTS[kind] ?? kind.replaceAll("_", " "), number].filter(Boolean).join(" ");
}

const LOOPS: Record<string, string> = {
  inner: "inner loop",
  outer: "outer loop",
  valve: "at the valve",
  mu: "mu of all loops",
};

export const nameOfLoop = (loop: string): string => LOOPS[loop] ?? loop.replace("_", " ");

/** A setting to type: `exact` is for the clipboard. */
export interface StructureSetting {
  name: string;
  unit: string;
  text: string;
  exact: string;
  /** Missing for a transfer function. */
  value?: number;
}

/** The settings of one block of the diagram. */
export interface BlockSettings {
  block: string;
  title: string;
  settings: StructureSetting[];
}

const setting = (name: string, value: number | null | undefined, unit = ""): StructureSetting[] =>
  typeof value === "number" ? [{ name, unit, text: formatSetting(value), exact: plainSetting(value), value }] : [];

function pidSettings({ Kp, Ti, Td, b, filter }: Controller, time: string, gain = ""): StructureSetting[] {
  return [
    ...setting("Kp", Kp, gain),
    ...setting("Ti", Ti, time),
    ...(Td ? setting("Td", Td, time) : []),
    ...(filter?.Tf ? setting("Tf", filter.Tf, time) : []),
    ...(typeof b === "number" && b !== 1 ? setting("b", b) : []),
  ];
}

/** An element of a decoupler, for the output of another controller; times of 0 are left out. */
const elementSettings = ({ Kf, Tz, Tp, Lf }: { Kf: number; Tz: number; Tp: number; Lf: number }, from: string, time: string): StructureSetting[] => [
  ...setting(`Kf from ${from}`, Kf),
  ...([["Tz", Tz], ["Tp", Tp], ["Lf", Lf]] as const).flatMap(([name, value]) => (value ? setting(`${name} from ${from}`, value, time) : [])),
];

/** "40.2 s + 1". */
export function polynomial(coefficients: readonly number[]): string {
  const terms = coefficients.flatMap((value, index) => {
    const power = coefficients.length - 1 - index;
    if (value === 0) return [];
    const s = power === 0 ? "" : power === 1 ? "s" : `s^${power}`;
    const size = Math.abs(value) === 1 && s !== "" ? "" : formatSetting(Math.abs(value));
    return [{ sign: value < 0 ? "−" : "+", text: [size, s].filter(Boolean).join(" ") }];
  });
  return terms.map(({ sign, text }, index) => (index === 0 ? (sign === "−" ? `−${text}` : text) : ` ${sign} ${text}`)).join("") || "0";
}

const sixDigits = (value: number): string => String(Number(value.toPrecision(6)));

function fraction(name: string, { num, den }: { num: number[]; den: number[] }): StructureSetting {
  const text = den.length === 1 && den[0] === 1 ? polynomial(num) : `(${polynomial(num)})/(${polynomial(den)})`;
  return { name, unit: "", text, exact: `${num.map(sixDigits).join(" ")} / ${den.map(sixDigits).join(" ")}` };
}

/** What to type into each controller of the answer. */
export function settingsOfAnswer(answer: StructureAnswer, units: UnitNames): BlockSettings[] {
  const { time } = units;
  const gain = quotient(units.u, units.y);
  switch (answer.structure) {
    case "cascade":
      return [
        { block: "C1", title: "Outer controller", settings: pidSettings(answer.outer.controller, time) },
        { block: "C2", title: "Inner controller", settings: pidSettings(answer.inner.controller, time) },
      ];
    case "feedforward": {
      const best = answer.variants.find(({ kind }) => kind === "given") ?? answer.variants.find(({ kind }) => kind === "optimum");
      const { Kf, Tz, Tp, Lf } = best?.compensator ?? {};
      return [
        { block: "C", title: "Feedback controller", settings: pidSettings(answer.feedback, time, gain) },
        { block: "F", title: "Compensator", settings: [...setting("Kf", Kf), ...setting("Tz", Tz, time), ...setting("Tp", Tp, time), ...setting("Lf", Lf, time)] },
      ];
    }
    case "level":
      return [{ block: "C", title: "Level controller", settings: [...setting("Kc", answer.design.Kc, gain), ...setting("Ti", answer.design.Ti, time)] }];
    case "interaction":
      return answer.controllers.map((controller, index) => ({
        block: `C${index + 1}`,
        title: `Controller ${index + 1}: y${index + 1} by u${answer.pairing[index]}`,
        settings: [
          ...pidSettings(controller, time),
          ...(answer.decoupling?.D[index] ?? []).flatMap((element, from) => (element ? elementSettings(element, `u${answer.pairing[from]}`, time) : [])),
        ],
      }));
    case "predictor": {
      const { C, F } = answer.controller;
      const times = [...setting("lambda", answer.lambda, time), ...setting("Tf", answer.Tf, time), ...setting("beta", answer.beta, time)];
      return [
        { block: "C", title: "Controller of the model", settings: [fraction("C(s)", C), ...times] },
        { block: "F", title: "Filter", settings: [fraction("F(s)", F)] },
      ];
    }
  }
}

/** "Kp 0.648, Ti 2.84 s": to read, not to type. */
export const settingWords = (settings: readonly StructureSetting[]): string =>
  settings.map(({ name, value, text, unit }) => (value === undefined ? `${name} = ${text}` : `${name} ${formatNumber(value)}${unit ? ` ${unit}` : ""}`)).join(", ");

/** For the clipboard. */
export const settingLines = ({ title, settings }: BlockSettings): string =>
  [title, ...settings.map(({ name, exact, unit }) => `${withUnit(name, unit)} = ${exact}`)].join("\n");

/** What the design reached, by the key of the limit's field. */
export function reachedOf(answer: StructureAnswer): Record<string, number | null> {
  switch (answer.structure) {
    case "cascade":
      return { "inner.tune.Ms": answer.inner.robustness.Ms, "outer.tune.Ms": answer.outer.robustness.Ms, "limits.Ms_valve": answer.outer.robustness.Ms_valve };
    case "level":
      return { allowed: answer.design.highest };
    case "interaction":
      return { "limit.mu": answer.mu };
    case "predictor":
      return { Ms: answer.robustness.Ms };
    case "feedforward":
      return {};
  }
}
