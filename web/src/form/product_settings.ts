// Settings of a product in the fields of its parameters: list of fields, and conversions between texts and values.
import type { FieldError, Product, ProductParameter, SettingValue } from "../api/types.ts";
import { exactText } from "../words/numbers.ts";
import { parseNumber } from "./number.ts";

export interface SettingField {
  name: string;
  label: string;
  unit: string;
  /** The allowed values; empty: a number, or a code that is typed. */
  choices: SettingValue[];
  /** The maker's default, used for an empty field; "" if it is unknown. */
  standard: string;
  /** Always shown, not folded away. */
  main: boolean;
  hint: string;
}

/** Roles of parameters that do not affect today's linear law. */
const ASIDE = ["limit", "fixed"];
/** Roles of those that every loop has, typed or not. */
const ALWAYS = ["gain", "integral", "derivative"];

/** One field per parameter, and one for the direction if a switch sets it. */
export function settingFields(product: Product): SettingField[] {
  const fields = product.parameters.map(fieldOf);
  const { by, name, direct, text } = product.action;
  if (by !== "switch" || name === undefined || direct === undefined || fields.some((field) => field.name === name))
    return fields;
  const standard = "reverse action";
  return [...fields, { name, label: name, unit: "", choices: [direct], standard, main: false, hint: text ?? "" }];
}

function fieldOf(parameter: ProductParameter): SettingField {
  const { name, label, unit, role, written, choices, remark } = parameter;
  const standard = parameter.default ?? choices?.[0]?.value;
  return {
    name,
    label: label || name,
    unit,
    // A switch that has only one position in this product is a choice among one.
    choices: choices?.map((choice) => choice.value) ?? (typeof standard === "boolean" ? [standard] : []),
    standard: standard === undefined ? "" : String(standard),
    main: ALWAYS.includes(role) || (written && !ASIDE.includes(role)),
    hint: remark ?? "",
  };
}

/** The texts of which a parameter takes one; empty: a number. A setting that is no parameter has its own text alone. */
export const choicesOf = (product: Product, name: string): string[] =>
  settingFields(product).find((field) => field.name === name)?.choices.map(String) ?? ["-"];

export interface SettingsReading {
  /** Undefined: all fields are empty. */
  settings: Record<string, SettingValue> | undefined;
  errors: FieldError[];
}

/** The typed texts by field name, as values. Empty fields get the maker's default. */
export function readSettings(product: Product, typed: Record<string, string>): SettingsReading {
  const settings: Record<string, SettingValue> = {};
  const errors: FieldError[] = [];
  for (const field of settingFields(product)) {
    const text = (typed[field.name] ?? "").trim();
    if (text === "") continue;
    const choice = field.choices.find((value) => String(value) === text);
    if (choice !== undefined) {
      settings[field.name] = choice;
      continue;
    }
    const code = product.parameters.find((parameter) => parameter.name === field.name)?.default;
    if (typeof code === "string" && field.choices.length === 0) {
      settings[field.name] = text;
      continue;
    }
    const parsed = parseNumber(text, field.label);
    if (parsed.ok) settings[field.name] = parsed.value;
    else errors.push({ pointer: `/baseline/settings/${field.name}`, detail: parsed.sentence });
  }
  return { settings: Object.keys(settings).length === 0 ? undefined : settings, errors };
}

/** Values as typed. */
export const typedSettings = (settings: Record<string, SettingValue>): Record<string, string> =>
  Object.fromEntries(Object.entries(settings).map(([name, value]) => [name, typeof value === "number" ? exactText(value) : String(value)]));
