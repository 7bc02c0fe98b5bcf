// The text of a record, for pasting and editing; only the beginning of a long one is laid out, to save time.
import type { FieldError } from "../api/types.ts";
import { h } from "../dom.ts";
import { areaField } from "./controls.ts";
import type { ControlOptions } from "./controls.ts";
import type { FormErrors } from "./errors.ts";

/** Faults of the columns of a record are shown at its text. */
export const atRecordText = (errors: FieldError[]): FieldError[] =>
  errors.map((error) => (/^\/record\/[tuyr](\/|$)/.test(error.pointer) ? { ...error, pointer: "/record/csv" } : error));

export interface RecordText {
  element: HTMLElement;
  /** The whole text, even if only a part is shown. */
  read(): string;
  write(text: string): void;
  /** Reports pasted or edited text, once it is complete. */
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
    let lines = 1;
    let end = text.length;
    for (let at = text.indexOf("\n"); at >= 0; at = text.indexOf("\n", at + 1)) {
      if (lines === LINES_SHOWN) end = at;
      lines += 1;
    }
    input.value = text.slice(0, end);
    words.textContent = `The first ${LINES_SHOWN} of ${lines} lines; all of them are used.`;
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
