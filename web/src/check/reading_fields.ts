// How the files of a check are read: columns and unit of the times, the same for all; the preview of the first file.
import { newest } from "../api/latest.ts";
import { previewRecord } from "../api/records.ts";
import type { Preview } from "../api/types.ts";
import { h } from "../dom.ts";
import { choiceField } from "../form/controls.ts";
import type { Field } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
import { columnChoices, TIME_UNITS } from "../form/record_fields.ts";
import { previewPanel } from "../form/record_preview.ts";
import type { Reading } from "./request.ts";

export interface ReadingFields {
  element: HTMLElement;
  read(): Reading;
  /** The first file has the columns of several loops, as far as is known. */
  hasMany(): boolean;
  /** The text of the first file, which shows its columns; null: there is none. */
  offer(csv: string | null): void;
}

const COLUMNS = [
  ["t", "Time"],
  ["y", "Measurement (PV)"],
  ["u", "Controller output (OP)"],
  ["r", "Set point (SP)"],
  ["mode", "Mode"],
] as const;

/** Time, measurement, output, set point and mode of one loop. */
const OF_ONE_LOOP = 5;

/** Which column is the measurement of one loop is open, and there are more columns than one loop has. */
const isOfMany = ({ columns, problems }: Preview): boolean =>
  columns.length > OF_ONE_LOOP - 1 && problems.some(({ pointer }) => pointer === "/record/columns/y");

/** Characters of a file that are enough to find its columns. */
const HEAD = 400_000;

/** Whole lines of the beginning of a text. */
const headOf = (text: string): string => (text.length <= HEAD ? text : text.slice(0, text.lastIndexOf("\n", HEAD) + 1));

/** `onChange`: whether the first file has several loops is known. */
export function readingFields(errors: FormErrors, onChange: () => void): ReadingFields {
  const columns = COLUMNS.map(([id, label]): [string, Field<HTMLSelectElement>] => [
    id,
    choiceField({ label, choices: [["", "as found"]], pointer: () => null }, errors),
  ]);
  const unit = choiceField({ label: "Times are in", choices: TIME_UNITS, pointer: () => null }, errors);
  const slot = h("div", { class: "preview-slot" });
  const trouble = h("div", { class: "error", role: "status" });
  const element = h(
    "details",
    { hidden: true },
    h("summary", {}, "How the files are read"),
    h(
      "div",
      { class: "stack" },
      h("p", { class: "hint" }, "The first file, as an example. What you choose here holds for all files. If it has several loops, choose the columns of one to check that loop alone."),
      slot,
      trouble,
      h("div", { class: "fields" }, columns.map(([, field]) => field.element), unit.element),
    ),
  );
  const begin = newest();
  let shown: string | null = null;
  let many = false;

  const read = (): Reading => ({
    columns: Object.fromEntries(columns.map(([id, field]) => [id, field.input.value])),
    timeUnit: unit.input.value,
  });

  async function look(whole: string): Promise<void> {
    const isNewest = begin();
    const csv = headOf(whole);
    const reading = read();
    const chosen = Object.fromEntries(Object.entries(reading.columns).filter(([, column]) => column !== ""));
    const preview = await previewRecord({ csv, columns: chosen, ...(reading.timeUnit ? { time_unit: reading.timeUnit } : {}) }).catch(() => null);
    // The check itself reports what it cannot read.
    if (!preview || !isNewest()) return;
    many = isOfMany(preview);
    const cut = csv.length < whole.length ? h("p", { class: "hint" }, "Of a long file only the beginning is shown here.") : "";
    slot.replaceChildren(cut, previewPanel(preview));
    trouble.replaceChildren(...(many ? [] : preview.problems.map(({ detail }) => h("p", {}, detail))));
    if (preview.problems.length > 0 && !many) element.open = true;
    const choices = columnChoices(preview);
    for (const [, { input }] of columns) {
      const before = input.value;
      input.replaceChildren(...[["", "as found"] as const, ...choices].map(([value, text]) => h("option", { value, selected: value === before }, text)));
    }
    onChange();
  }

  element.addEventListener("change", () => shown !== null && void look(shown));
  return {
    element,
    read,
    hasMany: () => many,
    offer(csv) {
      if (csv === shown) return;
      shown = csv;
      many = false;
      element.hidden = csv === null;
      for (const [, { input }] of columns) input.value = "";
      unit.input.value = "";
      trouble.replaceChildren();
      if (csv !== null) void look(csv);
    },
  };
}
