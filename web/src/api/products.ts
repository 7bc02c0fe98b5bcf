// Products: the list, the settings to type, and the effect on a loop; and a controller as source text.
import { call, getText, postText } from "./client.ts";
import type { TextFile } from "./client.ts";
import { settingsOf } from "./evaluate.ts";
import type { AsEntered, Controller, ExperimentQuestion, Implement, Product, ProductSummary, ScheduleRow, SettingValue, TypedSchedule, Units } from "./types.ts";

export async function getProducts(): Promise<ProductSummary[]> {
  const data = (await call("GET", "v1/controllers")).data as { controllers?: ProductSummary[] } | null;
  return data?.controllers ?? [];
}

const details = new Map<string, Promise<Product>>();
const known = new Map<string, Product>();

/** Requested once; a failure is not cached. */
export function getProduct(id: string): Promise<Product> {
  let detail = details.get(id);
  if (!detail) {
    detail = call("GET", `v1/controllers/${encodeURIComponent(id)}`).then((reply) => reply.data as Product);
    detail.then(
      (product) => known.set(id, product),
      () => details.delete(id),
    );
    details.set(id, detail);
  }
  return detail;
}

/** One that has arrived: for what must be shown at once. */
export const knownProduct = (id: string): Product | undefined => known.get(id);

/** The settings to type for a controller: the nearest ones if the block cannot represent it. */
export async function settingsFor(
  { product, y_span, u_span, sample_time }: Implement & { product: string },
  controller: Controller,
  units: Units | undefined,
): Promise<AsEntered> {
  const body = { controller: settingsOf(controller), y_span, u_span, sample_time, units: units ?? {}, nearest: true };
  return (await call("POST", `v1/controllers/${encodeURIComponent(product)}/settings`, body)).data as AsEntered;
}

/** The controller that settings typed into the product make. */
export async function controllerOf(
  { product, y_span, u_span, sample_time }: Implement & { product: string },
  settings: Record<string, SettingValue>,
  units: Units | undefined,
): Promise<Controller> {
  const body = { settings, y_span, u_span, sample_time, units: units ?? {} };
  const answer = await call("POST", `v1/controllers/${encodeURIComponent(product)}/controller`, body);
  return (answer.data as { controller: Controller }).controller;
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

export type Language = ExperimentQuestion["language"];

export interface CodeQuestion {
  job: string;
  /** Index of the entry in the result; "schedule": the schedule of a range; "all": every controller of a structure. */
  index: number | "schedule" | "all";
  language: Language;
  sample_time?: number | undefined;
  u_min?: number | undefined;
  u_max?: number | undefined;
}

export function codePath({ job, index, ...question }: CodeQuestion): string {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries(question)) if (value !== undefined) query.set(name, String(value));
  const part = index === "all" ? "" : index === "schedule" ? "/schedule" : `/controllers/${index}`;
  return `v1/jobs/${encodeURIComponent(job)}${part}/code?${query.toString()}`;
}

export const getCode = (question: CodeQuestion): Promise<TextFile> => getText(codePath(question));
export const getExperiment = (question: Partial<ExperimentQuestion>): Promise<TextFile> => postText("v1/experiments/code", question);
