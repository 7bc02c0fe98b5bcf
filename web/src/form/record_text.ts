// The text of a record, to paste and to edit; of a long one only the beginning is laid out, which takes no time.
import type { FieldError } from "../api/types.ts";
import { h } from "../dom.ts";
import { areaField } from "./controls.ts";
import type { ControlOptions } from "./controls.ts";
import type { FormErrors } from "./errors.ts";

/** What the service says of the columns of a record stands at its text. */
export const atRecordText = (errors: FieldError[]): FieldError[] =>
  errors.map((error) => (/^\/record\/[tuyr](\/|$)/.test(error.pointer) ? { ...error, pointer: "/record/csv" } : error));

export interface RecordText {
  element: HTMLElement;
  /** All of it, whatever is shown. */
  read(): string;
  write(text: string): void;
  /** What is pasted or edited, once it is complete. */
  onChange(act: () => void): void;
}

const MAX_SHOWN = 100_000;
const LINES_SHOWN = 30;

export function recordText(options: ControlOptions, errors: FormErrors): RecordText {
  const { value = "", ...others } = options;
  const field = areaField(others, errors);
  const { input } = field;
  const words = h("span", {});
  const clear = h("button", { type: "button", class: "quiet", onclick: () => empty() }, "Remove it");
  const note = h("p", { class: "hint", hidden: true }, words, " ", clear);
  let whole: string | null = null;
  let changed = (): void => undefined;

  function write(text: string): void {
    whole = text.length > MAX_SHOWN ? text : null;
    input.readOnly = whole !== null;
    note.hidden = whole === null;
    if (whole === null) {
      input.value = text;
      return;
    }
    const lines = text.split("\n");
    input.value = lines.slice(0, LINES_SHOWN).join("\n");
    words.textContent = `The first ${LINES_SHOWN} of ${lines.length} lines; all of them are used.`;
  }

  function empty(): void {
    write("");
    input.focus();
    changed();
  }

  write(value);
  return {
    element: h("div", {}, field.element, note),
    read: () => whole ?? input.value,
    write,
    onChange(act) {
      changed = act;
      input.addEventListener("change", act);
    },
  };
}
