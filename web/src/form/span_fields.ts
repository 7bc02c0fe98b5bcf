// A range as its two ends, in two fields with a common name.
import type { FieldError, Span } from "../api/types.ts";
import { h } from "../dom.ts";
import { textField } from "./controls.ts";
import type { FormErrors } from "./errors.ts";
import { parseNumber } from "./number.ts";
import type { Parsed } from "./number.ts";
import { exactText } from "../words/numbers.ts";

export interface SpanReading {
  /** Null: an end is still empty, or cannot be read. */
  span: Span | null;
  errors: FieldError[];
}

export interface SpanFields {
  element: HTMLElement;
  read(): SpanReading;
  set(span: Span | undefined): void;
  setUnit(unit: string): void;
  /** Neither end has a text. */
  isEmpty(): boolean;
  /** "0..200", as typed; "" if it is empty. */
  text(): string;
  setText(text: string): void;
}

export function spanFields(
  options: { label: string; pointer: string; onChange(): void },
  errors: FormErrors,
): SpanFields {
  const unit = h("span", { class: "unit" });
  const ends = (["from", "to"] as const).map((label, index) =>
    textField({ label, pointer: () => `${options.pointer}/${index}` }, errors),
  );
  const [low, high] = [ends[0]!, ends[1]!];
  for (const end of ends) end.input.addEventListener("change", options.onChange);
  const element = h(
    "fieldset",
    { class: "span" },
    h("legend", {}, options.label, unit),
    h("div", { class: "ends" }, low.element, high.element),
  );

  const isEmpty = (): boolean => ends.every((end) => end.input.value.trim() === "");

  return {
    element,
    read() {
      const typed = [low.input.value, high.input.value] as const;
      return readSpan(typed, options.label, options.pointer);
    },
    set(span) {
      ends.forEach((end, index) => (end.input.value = span ? exactText(span[index]!) : ""));
    },
    setUnit(text) {
      unit.textContent = text ? ` (${text})` : "";
    },
    isEmpty,
    text: () => (isEmpty() ? "" : ends.map((end) => end.input.value.trim()).join("..")),
    setText(text) {
      const typed = text.split("..");
      ends.forEach((end, index) => (end.input.value = typed[index] ?? ""));
    },
  };
}

/** The two ends as typed; an empty one is not a fault yet. */
export function readSpan(typed: readonly [string, string], label: string, pointer: string): SpanReading {
  const ends = typed.map((text, index): Parsed<number> | null =>
    text.trim() === "" ? null : parseNumber(text, `${label}, ${index === 0 ? "from" : "to"}`),
  );
  const errors = ends.flatMap((end, index) =>
    end && !end.ok ? [{ pointer: `${pointer}/${index}`, detail: end.sentence }] : [],
  );
  const [low, high] = ends;
  if (errors.length > 0 || !low?.ok || !high?.ok) return { span: null, errors };
  if (low.value < high.value) return { span: [low.value, high.value], errors };
  const detail = `${label} begins at ${typed[0].trim()}; the end must be higher.`;
  return { span: null, errors: [{ pointer: `${pointer}/1`, detail }] };
}
