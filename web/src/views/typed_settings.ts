// Settings that are typed in the card of the settings, as the controller that they make: in a textbook form or in the
// user's product.
import { settingsOf } from "../api/evaluate.ts";
import { entriesOf } from "../api/live.ts";
import type { CallSubject } from "../api/live.ts";
import { controllerOf } from "../api/products.ts";
import type { Controller, Entry, Implement, Product, TuningRequest, TypedSettings } from "../api/types.ts";
import { parseNumber } from "../form/number.ts";
import { readSettings } from "../form/product_settings.ts";
import { typedInto } from "../my_controller.ts";
import { OFF } from "../words/answer.ts";
import type { SettingsForm } from "../words/settings.ts";

/** The texts of the rows by their names. */
export type TypedTexts = Record<string, string>;

/** `typed`: as they stand in the product; missing for a form. */
export interface SettingsByHand {
  controller: Controller;
  typed?: TypedSettings;
}

/** Throws the sentence about a text that cannot be read. */
export async function controllerInProduct(
  product: Product,
  implement: Implement & { product: string },
  texts: TypedTexts,
  request: TuningRequest,
): Promise<SettingsByHand> {
  const { settings = {}, errors } = readSettings(product, texts);
  if (errors[0]) throw new Error(errors[0].detail);
  return { controller: await controllerOf(implement, settings, request.units), typed: typedInto(implement, settings) };
}

function read(texts: TypedTexts, name: string): number | null {
  const text = texts[name]!.trim();
  if (text === OFF) return null;
  const parsed = parseNumber(text, name);
  if (parsed.ok) return parsed.value;
  throw new Error(parsed.sentence);
}

/** The settings of the form with the typed values in them. */
function withTexts(before: Record<string, unknown>, texts: TypedTexts): Controller {
  const settings: Record<string, unknown> = { ...before };
  for (const name of ["Kp", "Ti", "Td", "Ki", "Kd", "b", "delta_r"]) if (name in texts) settings[name] = read(texts, name);
  if ("Tf" in texts) settings["filter"] = { ...(before["filter"] as object | undefined), Tf: read(texts, "Tf") };
  if (SETPOINT_FILTER in texts) settings["setpoint_filter"] = { T: read(texts, SETPOINT_FILTER) };
  return settings as unknown as Controller;
}

const SETPOINT_FILTER = "Set-point filter";

/** The service converts the other forms to the parallel one, whose parameters define those of the ideal form. */
export async function controllerInForm(
  entry: Entry,
  form: SettingsForm,
  texts: TypedTexts,
  subject: CallSubject,
): Promise<SettingsByHand> {
  if (form === "ideal" || form === "npid") return { controller: withTexts({ ...entry.controller! }, texts) };
  const { b_equivalent: _b, action: _action, why_null: _why, ...before } = entry.equivalents![form] as unknown as Record<string, unknown>;
  const given = withTexts(before, texts);
  const [answer] = await entriesOf({ ...subject, controllers: [settingsOf(given)], evaluate: { points: 0 } });
  const parallel = answer?.equivalents?.parallel as (Record<string, unknown> & { Kp: number; Ki: number | null; Kd: number | null }) | null | undefined;
  if (!parallel) throw new Error(answer?.error?.detail ?? `These settings have no ideal form.`);
  const { form: _form, Kp, Ki, Kd, ...others } = parallel;
  const ideal = { ...others, form: "ideal", Kp, Ti: Ki ? Kp / Ki : null, Td: (Kd ?? 0) / Kp };
  return { controller: ideal as unknown as Controller };
}
