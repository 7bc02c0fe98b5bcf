// Controllers as their makers build them: what there is, what to type into them, and what that makes of a loop; and a
// controller as source text, for who builds his own.
import { call, getText } from "./client.ts";
import type { TextFile } from "./client.ts";
import { settingsOf } from "./evaluate.ts";
import type { ScheduleRow } from "./range.ts";
import type { Controller, Figures, Notice, Response, Robustness, Units, WhyNull } from "./types.ts";

export type Span = [number, number];
export type SettingValue = number | string | boolean;
export type Need = "y_span" | "u_span" | "sample_time";

export interface ProductSummary {
  id: string;
  maker: string;
  name: string;
  form: string;
  /** What its formulas ask for beside the law. */
  needs: Need[];
  /** read, partly or unverified. */
  evidence: string;
  /** Their names. */
  parameters: string[];
}

export interface ProductParameter {
  name: string;
  /** As in the maker's software or manual. */
  label: string;
  unit: string;
  role: string;
  formula: string;
  low: number | null;
  high: number | null;
  /** Step of what can be typed; null: a floating-point number. */
  resolution: number | null;
  /** The value that means: no such part. */
  off: number | null;
  /** false: settings hold it only where it differs from its default. */
  written: boolean;
  remark?: string;
  default?: SettingValue;
  choices?: { value: SettingValue; b?: number; c?: number }[];
}

export interface Evidence {
  level: string;
  read: string[];
  unverified: string[];
  sources: string[];
}

export interface Product extends Omit<ProductSummary, "evidence" | "parameters"> {
  /** Its law over the parameters' names. */
  law: string;
  gain_basis: string;
  parameters: ProductParameter[];
  filter?: string;
  setpoint_weights: { b: number | null; c: number | null; text?: string };
  /** `name`, `direct`: of a switch, which is set for a negative gain alone. */
  action: { by: string; name?: string; direct?: SettingValue; text?: string };
  algorithm: {
    integral: string;
    derivative: string;
    form: string;
    published: boolean;
    sample_time: number | null;
    clock_fixed: boolean;
    sample_time_text?: string;
    anti_windup?: string;
    text?: string;
  };
  traps: string[];
  evidence: Evidence;
}

/** The user's own controller in a request. */
export interface Implement {
  product?: string;
  y_span?: Span;
  u_span?: Span;
  sample_time?: number;
  [key: string]: unknown;
}

/** What to type. */
export interface AsEntered {
  /** In full precision. */
  settings: Record<string, SettingValue>;
  /** In the block's resolution. */
  as_typed: Record<string, string>;
  units: Record<string, string>;
  /** What the block does with them. */
  realised: Controller;
  notes: Notice[];
}

/** The loop as the controller computes it. */
export interface Implemented {
  /** null: it counts as continuous. */
  sample_time: number | null;
  robustness: Robustness;
  performance: { setpoint?: Figures; load?: Figures; noise?: Figures };
  responses?: { setpoint?: Response; load?: Response };
  difference: {
    Ms_percent: number | null;
    load_IAE_percent: number | null;
    overshoot_points?: number | null;
    /** For these it is another loop. */
    differs?: ("Ms" | "load_IAE" | "overshoot")[];
    why_null?: WhyNull;
  };
}

export async function getProducts(): Promise<ProductSummary[]> {
  const data = (await call("GET", "v1/controllers")).data as { controllers?: ProductSummary[] } | null;
  return data?.controllers ?? [];
}

const details = new Map<string, Promise<Product>>();

/** Asked for once; a failure is not kept. */
export function getProduct(id: string): Promise<Product> {
  let detail = details.get(id);
  if (!detail) {
    detail = call("GET", `v1/controllers/${encodeURIComponent(id)}`).then((reply) => reply.data as Product);
    detail.catch(() => details.delete(id));
    details.set(id, detail);
  }
  return detail;
}

/** What to type for a controller: the nearest where the block cannot be it. */
export async function settingsFor(
  { product, y_span, u_span, sample_time }: Implement & { product: string },
  controller: Controller,
  units: Units | undefined,
): Promise<AsEntered> {
  const body = { controller: settingsOf(controller), y_span, u_span, sample_time, units: units ?? {}, nearest: true };
  return (await call("POST", `v1/controllers/${encodeURIComponent(product)}/settings`, body)).data as AsEntered;
}

/** What to type for each row of a schedule. */
export interface TypedSchedule {
  rows: { at: number; typing: AsEntered }[];
  /** How the product goes between its rows, and what is the same at all of them. */
  notes: Notice[];
}

export async function scheduleSettingsFor(
  { product, y_span, u_span, sample_time }: Implement & { product: string },
  given: readonly ScheduleRow[],
  interpolation: string,
  units: Units | undefined,
): Promise<TypedSchedule> {
  const rows = given.map(({ at, Kp, Ti, Td, Tf, b }) => ({ at, Kp, Ti, Td, Tf, b }));
  const body = { rows, interpolation, y_span, u_span, sample_time, units: units ?? {}, nearest: true };
  return (await call("POST", `v1/controllers/${encodeURIComponent(product)}/schedule`, body)).data as TypedSchedule;
}

export type Language = "st" | "c" | "python";

export interface CodeQuestion {
  job: string;
  /** Of the entry in the result; the schedule of a range. */
  index: number | "schedule";
  language: Language;
  sample_time?: number | undefined;
  u_min?: number | undefined;
  u_max?: number | undefined;
}

export function codePath({ job, index, ...question }: CodeQuestion): string {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries(question)) if (value !== undefined) query.set(name, String(value));
  const part = index === "schedule" ? index : `controllers/${index}`;
  return `v1/jobs/${encodeURIComponent(job)}/${part}/code?${query.toString()}`;
}

export const getCode = (question: CodeQuestion): Promise<TextFile> => getText(codePath(question));
