// The address of Start that holds a whole request: model, units, controller, today's settings and options.
import type { Plant, TuningRequest } from "../api/types.ts";
import type { Route } from "../routes.ts";
import { exactText } from "../words/numbers.ts";
import { equationsAddress, writeEquations } from "./equations.ts";
import { formOf } from "./plant.ts";
import { typedSettings } from "./product_settings.ts";
import { asksForAll } from "./tuning_request.ts";

const json = (value: object): string => (Object.keys(value).length > 0 ? JSON.stringify(value) : "");
const span = (ends: readonly number[] | undefined): string => (ends ? ends.map(exactText).join("..") : "");

function plantTexts(plant: Plant): { plant: string; values: Record<string, string> } | null {
  const equations = writeEquations(plant);
  if (equations) return { plant: "nonlinear", values: equationsAddress(equations) };
  const form = formOf(plant);
  return form && { plant: form.id, values: Object.fromEntries(form.fields.map(({ name, write }) => [name, write(plant[name])])) };
}

/** Names as those of the fields on Start. */
function todayTexts(baseline: TuningRequest["baseline"]): Record<string, string> {
  if (!baseline || baseline === "from-record") return {};
  if (baseline.product !== undefined) {
    const settings = Object.entries(typedSettings(baseline.settings));
    return { "today.form": "own", ...Object.fromEntries(settings.map(([name, text]) => [`today.set.${name}`, text])) };
  }
  const { form, product: _product, delta_r, filter, ...others } = baseline as Record<string, unknown>;
  const names = form === "parallel" ? ["Kp", "Ki", "Kd"] : ["Kp", "Ti", "Td"];
  const text = (value: unknown): string => (typeof value === "number" ? exactText(value) : "");
  const { Tf, type } = (filter ?? {}) as { Tf?: number; type?: string };
  const usual = filter === undefined || filter === null || (type === "derivative" && Tf !== undefined);
  const rest = Object.entries({ ...others, ...(usual ? {} : { filter }) }).filter(([name]) => !names.includes(name));
  return {
    "today.form": form === "ideal" ? "" : String(form),
    ...Object.fromEntries(names.map((name, index) => [`today.${index + 1}`, text(others[name])])),
    "today.delta_r": text(delta_r),
    "today.Tf": usual ? text(Tf) : "",
    "today.rest": json(Object.fromEntries(rest)),
  };
}

function methodTexts(tune: TuningRequest["tune"]): Record<string, string> {
  if (!Array.isArray(tune) || asksForAll(tune)) return {};
  const options = tune.map(({ method, ...others }) => [`how.${method}`, json(others)] as const);
  return { how: tune.map(({ method }) => method).join(" "), ...Object.fromEntries(options) };
}

/** Null: a record, Ku and Pu alone, or a plant without fields; their link is that of a job. */
export function linkOf(request: TuningRequest): Extract<Route, { screen: "new" }> | null {
  const { name, units, plant, record, identify: _identify, ultimate, tune, baseline, implement, ...others } = request;
  const described = plant && !record && !ultimate ? plantTexts(plant) : null;
  if (!described) return null;
  const { product = "", y_span, u_span, sample_time, ...built } = implement ?? {};
  const values: Record<string, string> = {
    ...described.values,
    "loop.name": name ?? "",
    "loop.time": units?.time ?? "",
    "loop.u": units?.u ?? "",
    "loop.y": units?.y ?? "",
    controller: product,
    "controller.y": span(y_span),
    "controller.u": span(u_span),
    "controller.sample_time": sample_time === undefined ? "" : exactText(sample_time),
    ...todayTexts(baseline),
    ...methodTexts(tune),
    rest: json({ ...others, ...(Object.keys(built).length > 0 ? { implement: built } : {}) }),
  };
  const given = Object.entries(values).filter(([, text]) => text !== "");
  return { screen: "new", plant: described.plant, values: Object.fromEntries(given) };
}
