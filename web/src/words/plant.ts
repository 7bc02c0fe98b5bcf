// A plant in one line of words.
import type { Plant } from "../api/types.ts";
import { formatParameter, quotient } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

const TITLES: Record<string, string> = {
  fopdt: "first order with dead time",
  sopdt: "second order with dead time",
  ipdt: "integrating with dead time",
  transfer_function: "transfer function",
  zpk: "zeros, poles and gain",
  state_space: "state space",
  nonlinear: "nonlinear equations",
};

export const plantTitle = (type: string): string => TITLES[type] ?? type.replaceAll("_", " ");

export interface PlantInput {
  name: string;
  nominal: number;
  min?: number | null;
  max?: number | null;
}

/** The manipulated input of a plant given by equations. */
export function inputOf(plant: Plant | undefined): PlantInput | null {
  const input = plant?.["input"] as Partial<PlantInput> | undefined;
  return typeof input?.nominal === "number" ? { name: "u", ...input, nominal: input.nominal } : null;
}

/** The name of an identified model: its structure, and its special features. */
export function structureTitle(plant: Plant): string {
  const T = plant["T"];
  if (plant.type === "fopdt" && typeof T === "number" && T < 0) return "unstable first order with dead time";
  if (plant.type === "ipdt" && typeof T === "number" && T !== 0) return "integrating with lag and dead time";
  if (plant.type === "sopdt" && plant["zeta"] !== undefined) return "second order that oscillates";
  if (plant.type === "transfer_function") return rationalTitle(plant);
  return plantTitle(plant.type);
}

const ORDERS = ["", "first", "second", "third", "fourth", "fifth"];

function rationalTitle(plant: Plant): string {
  const degree = (name: "num" | "den"): number => ((plant[name] as unknown[] | undefined)?.length ?? 1) - 1;
  const order = ORDERS[degree("den")];
  if (!order) return plantTitle(plant.type);
  const zeros = ["", " with a zero"][degree("num")] ?? " with zeros";
  return `${order} order${zeros}`;
}

/** Parameter name -> unit. */
export function parameterUnit(plant: Plant, name: string, units: UnitNames): string {
  if (name === "K") {
    const gain = quotient(units.y, units.u);
    return plant.type === "ipdt" ? (gain ? `${gain}/${units.time}` : `1/${units.time}`) : gain;
  }
  return name === "zeta" ? "" : units.time;
}

/** "K 1.25 °C/%, T 40 s, L 8 s"; the plant's kind if it has no such parameters. */
export function plantWords(plant: Plant, units: UnitNames): string {
  if (plant.type === "nonlinear") return equationWords(plant, units);
  const parts = ["K", "T", "T1", "T2", "zeta", "L"].flatMap((name) => {
    const value = plant[name];
    if (typeof value !== "number" || (name === "L" && value === 0)) return [];
    const unit = parameterUnit(plant, name, units);
    return [`${name} ${formatParameter(value)}${unit ? ` ${unit}` : ""}`];
  });
  return parts.length > 0 ? parts.join(", ") : plantTitle(plant.type);
}

/** The measured quantity: the state, or "y" for an expression. */
export const outputName = (plant: Plant | undefined): string => {
  const output = plant?.["output"];
  return typeof output === "string" && /^\w+$/.test(output) ? output : "y";
};

function equationWords(plant: Plant, units: UnitNames): string {
  // A list of jobs has only the kind.
  if (plant["states"] === undefined) return "nonlinear plant";
  const states = Object.keys(plant["states"] as object).length;
  const parts = [
    `${states} ${states === 1 ? "state" : "states"}`,
    `from ${inputOf(plant)?.name ?? "u"} to ${outputName(plant)}`,
  ];
  if (plant.L) parts.push(`L ${formatParameter(plant.L)} ${units.time}`);
  return parts.join(", ");
}
