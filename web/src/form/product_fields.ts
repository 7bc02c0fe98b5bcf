// Today's settings in a product's own form: its parameters as fields, with the names and units of the maker's software.
import type { Product, SettingValue } from "../api/types.ts";
import { h } from "../dom.ts";
import { choiceField, textField } from "./controls.ts";
import type { Field } from "./controls.ts";
import type { Control, FormErrors } from "./errors.ts";
import { readSettings, settingFields, typedSettings } from "./product_settings.ts";
import type { SettingField, SettingsReading } from "./product_settings.ts";

export interface ProductFields {
  element: HTMLElement;
  /** Replaces the fields for another product; the texts of those that it has not are kept for their return. */
  setProduct(product: Product | null): void;
  load(settings: Record<string, SettingValue>): void;
  isEmpty(): boolean;
  /** As typed, by the parameters' names. */
  texts(): Record<string, string>;
  setTexts(texts: Record<string, string>): void;
  read(): SettingsReading;
}

export function productFields(errors: FormErrors, active: () => boolean): ProductFields {
  let product: Product | null = null;
  /** Of fields that are not there now. */
  let others: Record<string, string> = {};
  let fields: { name: string; field: Field<HTMLInputElement> | Field<HTMLSelectElement> }[] = [];
  const main = h("div", { class: "fields" });
  const folded = h("div", { class: "fields" });
  const more = h("details", { hidden: true }, h("summary", {}, "Other parameters"), folded);
  const element = h("div", { class: "product-fields" }, main, more);

  function make(spec: SettingField): Field<Control["input"]> {
    const options = {
      label: spec.label,
      unit: spec.unit,
      hint: spec.hint,
      pointer: () => (active() ? `/baseline/settings/${spec.name}` : null),
    };
    if (spec.choices.length === 0)
      return textField({ ...options, ...(spec.standard ? { placeholder: spec.standard } : {}) }, errors);
    const empty = spec.standard ? `not set (${spec.standard})` : "not set";
    const choices = spec.choices.map((value): [string, string] => [String(value), String(value)]);
    return choiceField({ ...options, choices: [["", empty], ...choices] }, errors);
  }

  const texts = (): Record<string, string> =>
    Object.fromEntries(fields.map(({ name, field }) => [name, field.input.value]));

  function write(typed: Record<string, string>): void {
    for (const { name, field } of fields) field.input.value = typed[name] ?? "";
  }

  /** Also for fields that come later. */
  function setTexts(typed: Record<string, string>): void {
    others = typed;
    write(typed);
  }

  return {
    element,
    setProduct(next) {
      if (next?.id === product?.id) return;
      others = { ...others, ...texts() };
      product = next;
      for (const { field } of fields) errors.remove(field.control);
      const specs = next ? settingFields(next) : [];
      const made = specs.map((spec) => ({ spec, name: spec.name, field: make(spec) as (typeof fields)[number]["field"] }));
      fields = made;
      main.replaceChildren(...made.filter(({ spec }) => spec.main).map(({ field }) => field.element));
      folded.replaceChildren(...made.filter(({ spec }) => !spec.main).map(({ field }) => field.element));
      more.hidden = folded.childElementCount === 0;
      write(others);
    },
    load: (settings) => setTexts(typedSettings(settings)),
    texts,
    setTexts,
    isEmpty: () => Object.values(texts()).every((text) => text.trim() === ""),
    read: () => (product ? readSettings(product, texts()) : { settings: undefined, errors: [] }),
  };
}
