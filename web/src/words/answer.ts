// The settings to enter, as rows with today's values: in a textbook form, or in the user's product.
import type { AsEntered, Entry, Product, SettingValue } from "../api/types.ts";
import { formatSetting } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";
import type { ExplainedName } from "./explained.ts";
import { explanationOf } from "./explanation_of.ts";
import { typedRows } from "./products.ts";
import { settingsOf } from "./settings.ts";
import type { Setting, SettingsForm } from "./settings.ts";

/** A setting as it is typed. */
export interface AnswerRow {
  /** The setting's name in its form or product. */
  name: string;
  label: string;
  value: string;
  unit: string;
  /** Today's value; "" if it is not known. */
  today: string;
  /** Range, step and remark, as details. */
  about: string;
  /** The explanation of its meaning, if there is one. */
  explains: ExplainedName | undefined;
}

/** A part that the controller does not have, such as integral action. */
export const OFF = "off";

/** The form in which an entry is shown: a nonlinear controller has its own alone. */
export const formOf = (entry: Entry, chosen: SettingsForm): SettingsForm => (entry.controller?.form === "npid" ? "npid" : chosen);

/** The rows of a textbook form, or a sentence that says why the controller does not have that form. */
export function formRows(entry: Entry, today: Entry | undefined, form: SettingsForm, units: UnitNames): AnswerRow[] | string {
  const settings = settingsOf(entry, form, units);
  if (typeof settings === "string") return settings;
  const before = today && today !== entry ? settingsOf(today, formOf(today, form), units) : [];
  const todays = (name: string): string => {
    const setting = typeof before === "string" ? undefined : before.find((item) => item.name === name);
    return setting ? shownValue(setting) : "";
  };
  return settings.map((setting) => ({
    name: setting.name,
    label: setting.name,
    value: shownValue(setting),
    unit: setting.value === null ? "" : setting.unit,
    today: todays(setting.name),
    about: "",
    explains: explanationOf(setting.name),
  }));
}

const shownValue = ({ value }: Setting): string => (value === null ? OFF : formatSetting(value));

/** The rows of the product's own list. `today`: its settings by name. */
export const productRows = (product: Product, entered: AsEntered, today: Record<string, SettingValue>): AnswerRow[] =>
  typedRows(product, entered).map(({ name, label, value, unit, about, explains }) => ({
    name,
    label,
    value,
    unit,
    today: name in today ? String(today[name]) : "",
    about,
    explains,
  }));

/** Tab-separated, with a head: for a spreadsheet. */
export const tableText = (rows: readonly AnswerRow[]): string =>
  [["parameter", "today", "new", "unit"], ...rows.map(({ label, today, value, unit }) => [label, today, value, unit])]
    .map((cells) => cells.join("\t"))
    .join("\n");
