// A program in one of the languages: read, copied and saved; and the fields from which it is made.
import type { TextFile } from "../api/client.ts";
import { ApiError, sentenceOf } from "../api/client.ts";
import { latest } from "../api/latest.ts";
import type { Language } from "../api/products.ts";
import type { FieldError } from "../api/types.ts";
import { h } from "../dom.ts";
import { textField } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
import { parseNumber } from "../form/number.ts";
import { tabs } from "../form/tabs.ts";
import { download } from "../plot/export.ts";
import { copyButton } from "../views/copy.ts";

const LANGUAGES: readonly (readonly [Language, string])[] = [
  ["st", "Structured Text"],
  ["c", "C"],
  ["python", "Python"],
  ["arduino", "Arduino"],
];

export interface SourceText<Question> {
  elements: HTMLElement[];
  language(): Language;
  /** Asks for the text, unless it is the one that was asked for last. `faults`: of the fields; then nothing is asked. */
  ask(question: Question, faults: FieldError[]): void;
  dispose(): void;
}

/** `onLanguage`: another one was chosen. */
export function sourceText<Question>(
  fetchText: (question: Question) => Promise<TextFile>,
  errors: FormErrors,
  onLanguage: () => void,
  announce: (sentence: string) => void,
): SourceText<Question> {
  let file: TextFile | null = null;
  let asked = "";
  const text = h("code", {});
  const block = h("pre", { class: "code", tabindex: 0, role: "region", "aria-label": "Source text" }, text);
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const copy = copyButton({ label: "Copy the text", text: () => file?.text ?? null }, announce);
  const save = h("button", { type: "button", onclick: saveFile }, "Download");
  const shelf = tabs(
    LANGUAGES.map(([id, label]) => ({ id, label })),
    { label: "Language", panel: [block, h("div", { class: "actions" }, copy, save)], onSelect: onLanguage },
  );

  const calls = latest<Question, TextFile>(fetchText, {
    onBusy: (busy) => block.setAttribute("aria-busy", String(busy)),
    onAnswer(answer) {
      file = answer;
      text.textContent = answer.text;
      save.textContent = answer.name ? `Download ${answer.name}` : "Download";
      trouble.hidden = true;
      shelf.element.hidden = false;
    },
    onError(error) {
      const listed = error instanceof ApiError ? (error.problem.errors ?? []) : [];
      const others = errors.mark("", listed);
      const said = listed.length > 0 ? others.map((item) => item.detail) : [sentenceOf(error)];
      trouble.textContent = said.join(" ");
      trouble.hidden = said.length === 0;
      file = null;
      asked = "";
      shelf.element.hidden = said.length > 0;
    },
  });

  function saveFile(): void {
    if (file) download(new Blob([file.text], { type: "text/plain" }), file.name || "controller.txt");
  }

  return {
    elements: [trouble, shelf.element],
    language: () => shelf.selected() as Language,
    ask(question, faults) {
      errors.mark("", faults);
      const key = JSON.stringify(question);
      if (faults.length > 0 || key === asked) return;
      asked = key;
      calls.send(question);
    },
    dispose: calls.drop,
  };
}

export interface OptionalNumber {
  element: HTMLElement;
  setUnit(unit: string): void;
  /** Empty: undefined. A text that is no number is added to the faults. */
  read(faults: FieldError[]): number | undefined;
  write(value: number | undefined): void;
}

/** A member of the question that may be left out. */
export function optionalNumber(label: string, name: string, hint: string, errors: FormErrors, onChange: () => void): OptionalNumber {
  const field = textField({ label, hint, pointer: () => `/${name}` }, errors);
  field.input.addEventListener("change", onChange);
  return {
    element: field.element,
    setUnit: field.setUnit,
    read(faults) {
      if (field.input.value.trim() === "") return undefined;
      const parsed = parseNumber(field.input.value, label);
      if (parsed.ok) return parsed.value;
      faults.push({ pointer: `/${name}`, detail: parsed.sentence });
      return undefined;
    },
    write(value) {
      field.input.value = value === undefined ? "" : String(value);
    },
  };
}
