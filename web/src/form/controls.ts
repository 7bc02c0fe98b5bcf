// Labelled controls: text fields with unit and hint, choices, check boxes. Each can show an error sentence.
import { whenReleased } from "../api/press.ts";
import { h, uniqueId } from "../dom.ts";
import type { Control, FormErrors } from "./errors.ts";

export interface ControlOptions {
  label: string;
  hint?: string;
  unit?: string;
  value?: string;
  placeholder?: string;
  wide?: boolean;
  /** Wraps the text of the label in a button that explains it; a press on the label then does not focus the field. */
  explain?(text: HTMLElement): HTMLElement;
  /** The label is only for readers who do not see the row's heading. */
  bare?: boolean;
  rows?: number;
  pointer: () => string | null;
}

export interface Field<T extends Control["input"]> {
  element: HTMLElement;
  input: T;
  /** The field for the form's errors. */
  control: Control;
  setUnit(unit: string): void;
  setLabel(label: string): void;
}

function assemble<T extends Control["input"]>(input: T, options: ControlOptions, errors: FormErrors): Field<T> {
  input.id = uniqueId("field");
  const hint = options.hint ? h("span", { class: "hint", id: `${input.id}-hint` }, options.hint) : null;
  const error = h("span", { class: "error", id: `${input.id}-error`, hidden: true });
  const unit = h("span", { class: "unit" }, options.unit ? ` (${options.unit})` : "");
  input.setAttribute("aria-describedby", [hint?.id, error.id].filter(Boolean).join(" "));
  const control: Control = { input, error, pointer: options.pointer };
  errors.add(control);
  const label = h("span", { id: `${input.id}-label` }, options.label);
  let head: HTMLElement;
  if (options.explain) {
    // A button cannot stand inside a label element.
    unit.id = `${input.id}-unit`;
    input.setAttribute("aria-labelledby", `${label.id} ${unit.id}`);
    head = h("span", { class: "label" }, options.explain(label), unit);
  } else head = h("label", { for: input.id, class: options.bare ? "visually-hidden" : null }, label, unit);
  const element = h(
    "div",
    { class: options.wide ? "field wide" : "field" },
    head,
    input,
    error,
    hint,
  );
  return {
    element,
    input,
    control,
    // A longer label may need another line, which would move a button that is being pressed below it.
    setUnit: (text) => whenReleased(() => (unit.textContent = text ? ` (${text})` : "")),
    setLabel(text) {
      label.textContent = text;
    },
  };
}

/** A text field: numbers are text too, read by the page's own parser. */
export function textField(options: ControlOptions, errors: FormErrors): Field<HTMLInputElement> {
  const input = h("input", {
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    placeholder: options.placeholder,
    value: options.value,
  });
  return assemble(input, options, errors);
}

export function areaField(options: ControlOptions, errors: FormErrors): Field<HTMLTextAreaElement> {
  const input = h("textarea", { rows: options.rows ?? 4, spellcheck: "false", placeholder: options.placeholder });
  if (options.value) input.value = options.value;
  return assemble(input, options, errors);
}

/** A choice of [value, text] pairs. */
export function choiceField(
  options: ControlOptions & { choices: readonly (readonly [string, string])[] },
  errors: FormErrors,
): Field<HTMLSelectElement> {
  const input = h(
    "select",
    {},
    options.choices.map(([value, text]) => h("option", { value, selected: value === options.value }, text)),
  );
  return assemble(input, options, errors);
}
