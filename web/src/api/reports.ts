// What methods tell beside their controllers, as entries carry it: one type a report.
import type { Complex, Controller, Figures, Plant, Response, Robustness, WhyNull } from "./types.ts";

/** What an entry of the method rimc adds: figures of its PID on the model that it was designed for. */
export interface Rimc {
  lambda: number;
  Ms?: number | null;
  /** Of y per unit of load, signed. */
  disturbance_peak?: number | null;
  dead_time_error?: number | null;
  stability_limit?: number | null;
  /** With the option `curve`. */
  disturbance_peak_curve?: { lambda_over_tau: number[]; DP_over_kp: (number | null)[]; Ms: (number | null)[] };
  /** The controller that the PID approximates. */
  full_controller?: {
    robustness?: Partial<Robustness>;
    load?: Figures;
    responses?: { setpoint?: Response; load?: Response };
  };
  why_null?: WhyNull;
}

/** Servo against regulation. Indices are normalised by the model's K and T; Deg is 1 - I_perf. */
export interface TradeoffFigures {
  J_r: number | null;
  J_d: number | null;
  J_rd: number | null;
  J_r_opt: number | null;
  J_d_opt: number | null;
  I_perf: number | null;
  Deg: number | null;
  Ms: number | null;
  why_null?: WhyNull;
}

/** A point of what the rule does on the model, by what it was asked for. */
export type TradeoffPoint = Omit<TradeoffFigures, "J_r_opt" | "J_d_opt"> & {
  Ms_design?: number;
  degradation?: number;
};

export interface Tradeoff {
  /** On the first-order model that the design rests on. */
  model?: TradeoffFigures;
  plant?: TradeoffFigures;
  profile?: { by_Ms: TradeoffPoint[]; by_degradation: TradeoffPoint[] };
  why_null?: WhyNull;
}

/** A response beside that of the nonlinear controller; absolute values at the times of their scenario. */
export interface Followed {
  t?: number[];
  y?: (number | null)[];
  u?: (number | null)[];
}

export interface EmulationScenario extends Followed {
  setpoint_step: number;
  initial?: Record<string, number>;
  parameters?: Record<string, number>;
  y_rest: number;
  u_rest: number;
  t: number[];
  y_nl: (number | null)[];
  u_nl: (number | null)[];
  /** A limit of the input clipped the nonlinear controller's u. */
  limited?: boolean;
  /** Why the PID's run ended early. */
  ended?: string;
}

/** Settings of the first level: a classical rule on a simulated test or on the linear model. */
export interface LevelOne extends Followed {
  method: string;
  test?: string;
  title?: string;
  model?: Plant | null;
  controller?: Controller | null;
  /** Why there are no settings. */
  error?: string;
  /** Why its run ended before the horizon. */
  ended?: string;
  J?: number | null;
  why_null?: WhyNull;
}

export type Tuned = "Kp" | "Ti" | "Td" | "Tf";
export type Spreads = Partial<Record<Tuned, number | null>>;

/** What an entry of the method emulation adds: how well its PID follows the nonlinear controller. */
export interface Emulation {
  formulation?: string;
  J: number | null;
  /** Without their weights: J = wy J_y + wu J_u. */
  J_y?: number | null;
  J_u?: number | null;
  weights?: { wy: number; wu: number };
  horizon?: number;
  active_bounds?: { parameter: Tuned; bound: "low" | "high"; value: number }[];
  bounds?: Partial<Record<Tuned, [number, number]>>;
  /** By how much each may move until J has grown by 5 %: the others follow, or stay. */
  flatness?: Spreads & { why_null?: WhyNull };
  flatness_alone?: Spreads & { why_null?: WhyNull };
  relative_degree?: number;
  zero_dynamics_stable?: boolean;
  zeros?: Complex[];
  target?: { beta?: number[] };
  fit?: { u_left?: number | null; y_left?: number | null; adequate?: boolean; sentence?: string };
  level1?: LevelOne[];
  scenarios?: EmulationScenario[];
  t?: number[];
  y_nl?: (number | null)[];
  u_nl?: (number | null)[];
  why_null?: WhyNull;
}

/** The reports that an entry may have. */
export interface FrontPoint {
  /** The limit. */
  Ms: number;
  controller: Controller;
  load_IAE: number | null;
  overshoot_percent: number | null;
  Mks: number | null;
  achieved: { Ms: number | null; Mt: number | null };
}

export interface Front {
  points: FrontPoint[];
  /** The lowest limit that is met, where lower ones were asked for. */
  infeasible_below: number | null;
}

export interface Reports {
  rimc?: Rimc;
  tradeoff?: Tradeoff;
  emulation?: Emulation;
  frontier?: Front;
}
