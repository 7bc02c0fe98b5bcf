// The settings of a controller in the textbook forms: as rows, as text, and with the formula of the form.
import type { Entry, WhyNull } from "../api/types.ts";
import { filterWords } from "./figures.ts";
import { formatSetting, plainSetting, quotient } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

export const TEXTBOOK_FORMS = ["ideal", "parallel", "series"] as const;
export type TextbookForm = (typeof TEXTBOOK_FORMS)[number];
export type SettingsForm = TextbookForm | "npid";

export interface Setting {
  name: string;
  unit: string;
  value: number | null;
}

/** A controller of any form. */
type EquivalentSettings = { b?: number; why_null?: WhyNull } & Partial<Record<"Kp" | "Ki" | "Kd" | "Ti" | "Td", number | null>>;

/** The settings of one form, or a sentence why that form does not exist. */
export function settingsOf(entry: Entry, form: SettingsForm, units: UnitNames): Setting[] | string {
  const controller = entry.controller;
  if (!controller) return "There is no controller to enter.";
  const gain = quotient(units.u, units.y);
  const per = gain ? `${gain}/${units.time}` : `1/${units.time}`;
  const times = gain ? `${gain} ${units.time}` : units.time;
  const filter: Setting[] =
    typeof controller.filter?.Tf === "number" ? [{ name: "Tf", unit: units.time, value: controller.filter.Tf }] : [];
  const lag = controller.setpoint_filter?.T;
  /** Parts that act on the set point only, if b is not 1. */
  const weights = (b: number | undefined): Setting[] => [
    ...(typeof b === "number" && b !== 1 ? [{ name: "b", unit: "", value: b }] : []),
    ...(typeof lag === "number" ? [{ name: "Set-point filter", unit: units.time, value: lag }] : []),
  ];
  if (form === "ideal" || form === "npid") {
    const { delta_r } = controller;
    const delta: Setting[] =
      form === "npid" && typeof delta_r === "number" ? [{ name: "delta_r", unit: units.y, value: delta_r }] : [];
    return [
      { name: "Kp", unit: gain, value: controller.Kp ?? null },
      { name: "Ti", unit: units.time, value: controller.Ti ?? null },
      { name: "Td", unit: units.time, value: controller.Td ?? 0 },
      ...delta,
      ...filter,
      ...weights(controller.b),
    ];
  }
  const equivalent: EquivalentSettings | null | undefined = entry.equivalents?.[form];
  if (!equivalent || typeof equivalent.Kp !== "number") {
    const why = equivalent?.why_null ?? entry.equivalents?.why_null;
    return (
      why?.[form] ??
      why?.["Kp"] ??
      Object.values(why ?? {})[0] ??
      `This controller has no ${form} form: its zeros are complex. Enter it in the ideal or parallel form.`
    );
  }
  if (form === "parallel") {
    return [
      { name: "Kp", unit: gain, value: equivalent.Kp },
      { name: "Ki", unit: per, value: equivalent.Ki ?? null },
      { name: "Kd", unit: times, value: equivalent.Kd ?? null },
      ...filter,
      ...weights(equivalent.b),
    ];
  }
  return [
    { name: "Kp", unit: gain, value: equivalent.Kp },
    { name: "Ti", unit: units.time, value: equivalent.Ti ?? null },
    { name: "Td", unit: units.time, value: equivalent.Td ?? null },
    ...filter,
    ...weights(equivalent.b),
  ];
}

/** The text for the clipboard. */
export function settingsText(form: SettingsForm, settings: Setting[]): string {
  const lines = settings.map(
    (setting) =>
      `${setting.name} = ${setting.value === null ? "off" : plainSetting(setting.value)}${setting.unit && setting.value !== null ? ` ${setting.unit}` : ""}`,
  );
  return [`form: ${form}`, ...lines].join("\n");
}

const FORMULAS: Record<SettingsForm, string> = {
  ideal: "Kp (1 + 1/(Ti s) + Td s)",
  parallel: "Kp + Ki/s + Kd s",
  series: "Kp (1 + 1/(Ti s)) (1 + Td s)",
  npid: "Kp (e + 1/Ti ∫ exp(−e²/(2 delta_r²)) e dt − Td dy/dt)",
};

const PARAMETERS: Record<TextbookForm, string> = { ideal: "Kp, Ti, Td", parallel: "Kp, Ki, Kd", series: "Kp, Ti, Td" };

/** "Ideal form: Kp, Ti, Td". */
export const formTitle = (form: TextbookForm): string =>
  `${form[0]!.toUpperCase()}${form.slice(1)} form: ${PARAMETERS[form]}`;

/** The law of the form, with what acts beside its parameters. */
export function formulaLine(form: SettingsForm, { controller }: Entry): string {
  const { b = 1, c = 0, filter, action } = controller ?? {};
  return `${FORMULAS[form]}; set-point weights b ${formatSetting(b)}, c ${formatSetting(c)}; filter ${filterWords(filter?.type)}${action ? `; ${action} action` : ""}.`;
}

const KEY = "tunewright-form";

export function rememberForm(form: TextbookForm): void {
  try {
    localStorage.setItem(KEY, form);
  } catch {
    // A browser without storage forgets the choice; nothing else depends on it.
  }
}

export function rememberedForm(): TextbookForm {
  try {
    const kept = localStorage.getItem(KEY);
    return TEXTBOOK_FORMS.find((form) => form === kept) ?? "ideal";
  } catch {
    return "ideal";
  }
}
