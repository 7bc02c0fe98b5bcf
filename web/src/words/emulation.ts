// Two-level tuning in words: the settings of both levels, the cost of the optimum and its curvature.
import type { EmulatedScenario, Emulation, Entry, LevelOneRow, Tuned } from "../api/types.ts";
import { rootWords } from "./linear_model.ts";
import { formatNumber, formatParameter, formatSetting, quotient } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

export interface LevelRow {
  title: string;
  /** The source of its model, or "". */
  origin: string;
  /** Index in level1; null for the tuned settings themselves. */
  level1: number | null;
  settings: Partial<Record<Tuned, number | null>>;
  J: number | null;
  /** The reason why there are no settings or no J; "" if there are. */
  why: string;
  /** Has responses to draw. */
  drawable: boolean;
}

const ORIGINS: Record<string, string> = {
  step: "on a simulated step test",
  relay: "on a simulated relay test",
  linear: "on the linear model",
};

function levelOneRow(item: LevelOneRow, index: number): LevelRow {
  const { controller } = item;
  const why = item.error || item.ended || item.why_null?.["J"] || "There is no J of these settings.";
  return {
    title: item.title ?? item.method.replaceAll("_", " "),
    // Titles that end in brackets contain it already.
    origin: item.title?.endsWith(")") ? "" : (ORIGINS[item.test ?? ""] ?? ""),
    level1: index,
    settings: controller ? { Kp: controller.Kp, Ti: controller.Ti, Td: controller.Td ?? 0 } : {},
    J: item.J ?? null,
    why: typeof item.J === "number" ? "" : why,
    drawable: Boolean(item.y && item.u),
  };
}

/** The classical settings, and last the optimum. */
export function levelRows(entry: Entry): LevelRow[] {
  const { emulation, controller } = entry;
  if (!emulation) return [];
  return [
    ...(emulation.level1 ?? []).map(levelOneRow),
    {
      title: "Emulation",
      origin: emulation.formulation === "remark6" ? "least squares of Remark 6" : "minimum of J within the bounds",
      level1: null,
      settings: controller
        ? { Kp: controller.Kp, Ti: controller.Ti, Td: controller.Td ?? 0, Tf: controller.filter?.Tf ?? null }
        : {},
      J: emulation.J,
      why: typeof emulation.J === "number" ? "" : (emulation.why_null?.["J"] ?? "There is no J."),
      drawable: true,
    },
  ];
}

/** The tuned parameters: those with bounds, else those that the controller has. */
export function tunedParameters(emulation: Emulation): Tuned[] {
  const every: Tuned[] = ["Kp", "Ti", "Td", "Tf"];
  const bounded = every.filter((name) => emulation.bounds?.[name]);
  return bounded.length > 0 ? bounded : ["Kp", "Ti", "Td"];
}

/** "at its lower bound"; "" inside. */
export function boundWords(emulation: Emulation, name: Tuned): string {
  const active = emulation.active_bounds?.find(({ parameter }) => parameter === name);
  return active ? `at its ${active.bound === "low" ? "lower" : "upper"} bound` : "";
}

/** "Kp may move by ±0.46, Ti by ±0.026 before J grows by 5 %, ..." */
export function flatnessWords(emulation: Emulation): string {
  const listed = (spreads: Emulation["flatness"]): string =>
    tunedParameters(emulation)
      .flatMap((name) => {
        const width = spreads?.[name];
        return typeof width === "number" ? [`${name} by ±${formatNumber(width)}`] : [];
      })
      .join(", ");
  const [together, alone] = [listed(emulation.flatness), listed(emulation.flatness_alone)];
  if (!together && !alone) return "";
  if (!together) return `${alone.replace(" by", " may move by")}, each alone, before J grows by 5 %.`;
  const first = `${together.replace(" by", " may move by")} before J grows by 5 %, with the others re-optimised`;
  return alone ? `${first}; alone ${alone}.` : `${first}.`;
}

/** Name and value of the facts about the optimum. */
export function emulationFacts(emulation: Emulation, units: UnitNames): [string, string][] {
  const facts: [string, string][] = [];
  const { J, J_y, J_u, weights, horizon, relative_degree, zeros, target } = emulation;
  const { wy = 1, wu = 1 } = weights ?? {};
  const parts = [
    typeof J_y === "number" ? `${formatParameter(wy)} × ${formatNumber(J_y)} of y` : "",
    typeof J_u === "number" ? `${formatParameter(wu)} × ${formatNumber(J_u)} of u` : "",
  ].filter(Boolean);
  facts.push(["J", [formatNumber(J, 4), parts.join(" + ")].filter(Boolean).join(" = ")]);
  if (typeof J_y !== "number" && emulation.why_null?.["J_y"]) facts.push(["y in J", emulation.why_null["J_y"]]);
  if (typeof horizon === "number") facts.push(["Horizon", `${formatParameter(horizon)} ${units.time}`]);
  const flat = flatnessWords(emulation);
  if (flat) facts.push(["Flatness", flat]);
  if (typeof relative_degree === "number") facts.push(["Relative degree", String(relative_degree)]);
  if (target?.beta) facts.push(["Target", targetWords(target.beta)]);
  if (typeof emulation.zero_dynamics_stable === "boolean")
    facts.push([
      "Zero dynamics",
      [
        emulation.zero_dynamics_stable ? "stable" : "unstable: the internal states grow",
        zeros && zeros.length > 0 ? `zeros ${rootWords(zeros)}` : "",
      ]
        .filter(Boolean)
        .join("; "),
    ]);
  return facts;
}

const ORDINALS = ["y", "y′", "y″", "y‴"];

/** beta_r y^(r) + ... + y = set point. */
export function targetWords(beta: number[]): string {
  const terms = beta.map((value, order) => {
    const derivative = ORDINALS[order] ?? `y^(${order})`;
    return value === 1 ? derivative : `${formatParameter(value)} ${derivative}`;
  });
  return `${terms.reverse().join(" + ")} = set point`;
}

/** "set point +10, T from 380". */
export function scenarioWords(scenario: EmulatedScenario): string {
  const signed =
    scenario.setpoint_step > 0 ? `+${formatSetting(scenario.setpoint_step)}` : formatSetting(scenario.setpoint_step);
  const others = [
    ...Object.entries(scenario.initial ?? {}).map(([name, value]) => `${name} from ${formatSetting(value)}`),
    ...Object.entries(scenario.parameters ?? {}).map(([name, value]) => `${name} ${formatSetting(value)}`),
  ];
  return [`set point ${signed}`, ...others].join(", ");
}

/** Special features of a scenario's run, in sentences; "" for none. */
export function scenarioNotes(scenario: EmulatedScenario): string {
  return [
    scenario.limited ? "A limit of the input clips the nonlinear controller here." : "",
    scenario.ended ? `The PID's run ends early: ${scenario.ended}` : "",
  ]
    .filter(Boolean)
    .join(" ");
}

export const unitOf = (name: Tuned, units: UnitNames): string =>
  name === "Kp" ? quotient(units.u, units.y) : units.time;
