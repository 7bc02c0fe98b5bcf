// The part of the HTTP contract that the page uses. Quantities that are infinite or undefined are null; their object says why.
import type { AsEntered, Implement, Implemented, SettingValue, Span } from "./products.ts";
import type { RangeContent } from "./range.ts";
import type { Reports } from "./reports.ts";

export type WhyNull = Record<string, string>;

export interface Units {
  time?: string;
  u?: string;
  y?: string;
}

export type Complex = number | [number, number];

export type Plant = { type: string; L?: number } & Record<string, unknown>;

export interface RecordedTest {
  t?: number[] | string[];
  dt?: number;
  u?: number[];
  y?: number[];
  /** Set point, where the record has one. */
  r?: number[];
  /** Measured disturbances. */
  d?: { name: string; values: number[] }[];
  csv?: string;
  /** Headings, or numbers from 1. */
  columns?: { t?: string | number; u?: string | number; y?: string | number; r?: string | number; d?: (string | number)[] };
  /** Of the times in the csv, where it does not say or says it wrongly. */
  time_unit?: string;
  kind?: string;
  u0?: number;
  y0?: number;
  /** The step of u in a record without it: from one value to the other at the first sample. */
  u_step?: [number, number];
  /** The run of a csv whose times begin again, from 1. */
  run?: number;
  /** The ends of the actuator: low, high. */
  u_limits?: [number, number];
  /** The part that counts, in its own times. */
  from?: number;
  to?: number;
}

/** What POST /v1/identify takes. */
export interface IdentifyRequest {
  name?: string;
  units?: Units;
  record: RecordedTest;
  identify?: Record<string, unknown>;
}

/** Today's settings: a controller in some form, or as they stand in a product. */
export type Baseline = ({ form: string; product?: undefined } & Record<string, unknown>) | TypedBaseline;

export interface TypedBaseline {
  product: string;
  settings: Record<string, SettingValue>;
  y_span?: Span;
  u_span?: Span;
  sample_time?: number;
}

export type TuneEntry = { method: string } & Record<string, unknown>;

export interface TuningRequest {
  name?: string;
  units?: Units;
  plant?: Plant;
  record?: RecordedTest;
  identify?: Record<string, unknown>;
  tune?: TuneEntry[] | string;
  baseline?: Baseline;
  /** The user's own controller. */
  implement?: Implement;
  evaluate?: {
    setpoint_step?: number;
    load_step?: number;
    rank_limits?: { Ms?: number };
    actuator?: { min?: number | null; max?: number | null };
    [key: string]: unknown;
  };
  [key: string]: unknown;
}

export interface Notice {
  code: string;
  detail: string;
  level?: "warning" | "bad";
}

/** A conclusion of the service: its sentence, and the numbers of that by name. */
export interface Finding {
  code: string;
  level: "good" | "note" | "warning" | "bad";
  text: string;
  figures?: Record<string, number | null>;
}

export interface FieldError {
  pointer: string;
  detail: string;
}

export interface Problem {
  type?: string;
  title?: string;
  status?: number;
  detail?: string;
  errors?: FieldError[];
  /** Options of the method with which it would be possible. */
  cure?: { text: string; options: Record<string, number> };
  /** A record that was read, but determines no model. */
  record?: { t: number[]; u: (number | null)[]; y: (number | null)[] };
}

export interface Filter {
  type: string;
  Tf?: number | null;
  N?: number | null;
}

export interface Controller {
  form: string;
  Kp: number;
  Ti: number | null;
  Td: number | null;
  /** Gains of the parallel form. */
  Ki?: number | null;
  Kd?: number | null;
  b?: number;
  c?: number;
  /** Of the nonlinear form: errors far beyond it do not feed the integral. */
  delta_r?: number | null;
  action?: string;
  filter?: Filter;
  /** What the set point passes first. */
  setpoint_filter?: { T: number };
  why_null?: WhyNull;
}

export interface Equivalent {
  Kp?: number | null;
  Ki?: number | null;
  Kd?: number | null;
  Ti?: number | null;
  Td?: number | null;
  b?: number;
  b_equivalent?: number | null;
  why_null?: WhyNull;
}

export interface Robustness {
  stable: boolean;
  Ms: number | null;
  omega_Ms: number | null;
  Mt: number | null;
  omega_Mt: number | null;
  Mks: number | null;
  gain_margin: number | null;
  gain_margin_low: number | null;
  phase_margin_deg: number | null;
  delay_margin: number | null;
  gain_crossover: number | null;
  phase_crossover: number | null;
  binding?: string | null;
  tolerates?: { gain?: [number | null, number | null] | null; extra_dead_time?: number | null };
  why_null?: WhyNull;
}

export type Figures = { why_null?: WhyNull } & Record<string, number | null | WhyNull | undefined>;

export interface Response {
  t: number[];
  y: (number | null)[];
  u: (number | null)[];
}

export interface FrequencyTraces {
  omega: number[];
  L: { re: (number | null)[]; im: (number | null)[]; phase_deg?: (number | null)[] };
  S_abs: (number | null)[];
  T_abs: (number | null)[];
  CS_abs: (number | null)[];
}

/** The load IAE of the best PID at an entry's own Ms, and how far the entry lies above it. */
export interface OptimumAtMs {
  IAE: number | null;
  excess_percent: number | null;
  why_null?: WhyNull;
}

/** The steady state that everything on a nonlinear plant is a deviation from. */
export interface OperatingPoint {
  states: Record<string, number>;
  u: number;
  y: number;
}

export interface Entry extends Reports {
  method: string;
  title?: string;
  source?: string;
  options?: Record<string, unknown>;
  warnings?: Notice[];
  /** The first says what the loop is. */
  verdict?: Finding[];
  error?: Problem;
  /** Limits hold over the record's confidence region, not on its model alone. */
  over_region?: boolean;
  /** Its load IAE over that of the design on the model alone. */
  region_cost?: number;
  reduced_model?: Plant;
  controller?: Controller;
  equivalents?: { parallel?: Equivalent | null; series?: Equivalent | null; why_null?: WhyNull };
  robustness?: Robustness;
  performance?: { setpoint?: Figures; load?: Figures; noise?: Figures };
  responses?: { setpoint?: Response; load?: Response };
  frequency?: FrequencyTraces;
  verification?: Record<string, unknown>;
  region?: Region;
  optimum_at_Ms?: OptimumAtMs;
  standing?: Standing;
  /** On a nonlinear plant, whose own figures and responses stand above: those of the linearised loop. */
  linear?: Pick<Entry, "performance" | "responses">;
  /** Of the nonlinear form: what can be said of errors of every size. */
  nonlinear?: { statement?: string };
  /** What to type into the product that the request names, and the loop as that computes it. */
  as_entered?: AsEntered;
  implemented?: Implemented;
  /** Keeps Ms within 5 %. */
  longest_sample_time?: number | null;
  compute_ms?: number;
  partial?: boolean;
}

/** How an entry stands in a comparison: what the service ranks by. */
export interface Standing {
  group?: "holds" | "above_limit" | "not_settled" | "unstable";
  /** Place, from 1, without a limit on the Ms of all. */
  order?: number;
  /** The least such limit with which it holds; null: none. */
  least_limit?: number | null;
  /** Both responses come to rest where they should. */
  settles: boolean;
  /** On the worst plant, in the user's own controller. */
  Ms: number | null;
  /** The limit on Ms that was asked of this entry holds. */
  within: boolean;
  excess_percent: number | null;
  /** Why it stands behind those that hold; left out where it holds. */
  why?: string;
  why_null?: WhyNull;
}

export interface Candidate {
  plant: Plant;
  fit_percent: number | null;
  criterion?: number | null;
  standard_errors?: Record<string, number | null>;
  /** Its free run at the times of the model's fit, where the request asked for traces. */
  y_model?: (number | null)[];
}

export interface UltimatePoint {
  Ku: number | null;
  Pu: number | null;
}

/** The steady oscillation of a relay test. */
export interface LimitCycle {
  Pu: number;
  Au: number;
  /** In rad, (-2 pi, 0]. */
  phi_u: number;
  periods: number;
  shift?: { sigma: number; A: number; phi: number };
  fit_rms?: number | null;
  describing_function?: UltimatePoint;
}

export interface FrequencyPoint {
  omega: number;
  re: number;
  im: number;
  std: number | null;
}

/** How much of an identified region a controller stabilises. */
export interface Region {
  stable_fraction?: number | null;
  worst_Ms?: number | null;
  /** The plant of that Ms, or one whose loop is unstable. */
  worst_plant?: Plant;
  why_null?: WhyNull;
}

export interface Model {
  plant: Plant;
  fit_percent: number | null;
  /** How far the service relies on it. */
  grade?: "good" | "usable" | "doubtful";
  /** Why it is doubtful: it explains too little, or a warning says that it may be another plant. */
  grade_reason?: "fit" | "warning";
  candidates?: Candidate[];
  choice_reason?: string;
  limit_cycle?: LimitCycle;
  frequency_points?: FrequencyPoint[];
  ultimate_point?: UltimatePoint | null;
  /** Where the request asked for traces. */
  fit?: { t: number[]; y: (number | null)[]; y_model: (number | null)[]; u?: (number | null)[] };
  standard_errors?: Record<string, number | null>;
  covariance?: { names: string[]; matrix: number[][] };
  /** Fits of other structures, which the region has too. Older results have none. */
  alternatives?: Plant[];
  /** The effect of the measured disturbances on y. */
  disturbances?: { name: string; plant: Plant; share: number | null }[];
  excited_band?: { omega_low: number; omega_high: number };
  data_quality?: Record<string, unknown>;
  warnings?: Notice[];
  why_null?: WhyNull;
}

export interface Result {
  model?: Model;
  /** Of a nonlinear plant. */
  operating_point?: OperatingPoint;
  linear_model?: Plant;
  controllers: Entry[];
  /** Of a job about an operating range, which has this in the place of controllers. */
  range?: RangeContent;
  /** Over all entries: which to take. */
  verdict?: Finding[];
  ranking?: number[];
  ranking_by?: string;
  rank_limits?: { Ms: number };
  /** The entry to show first. */
  proposed?: number;
  partial?: boolean;
  version?: string;
  request_hash?: string;
}

export interface Progress {
  fraction: number | null;
  stage?: string;
  message?: string;
  best?: Record<string, unknown> | null;
}

export type JobStatus = "queued" | "running" | "succeeded" | "failed" | "cancelled";

export interface Job {
  id: string;
  name?: string;
  status: JobStatus;
  progress?: Progress;
  created_at?: string;
  started_at?: string | null;
  finished_at?: string | null;
  request?: TuningRequest;
  result?: Result;
  error?: Problem;
}

export type { Method, OptionSlider, Schema } from "./method.ts";

export interface Example {
  id: string;
  title: string;
  description?: string;
  source?: string;
  request: TuningRequest;
}

export const isFinal = (status: JobStatus): boolean =>
  status === "succeeded" || status === "failed" || status === "cancelled";
