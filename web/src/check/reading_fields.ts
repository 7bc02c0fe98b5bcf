// How the files of a check are read: columns and unit of the times, the same for all; the preview of one of them.
import { newest } from "../api/latest.ts";
import { previewRecord } from "../api/records.ts";
import type { Preview, RecordedTest } from "../api/types.ts";
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
  /** The file that is shown has the columns of several loops, as far as is known. */
  hasMany(): boolean;
  /** The texts of the files, and of those that can be read; one of them shows its columns. */
  offer(files: readonly string[], readable: readonly string[]): void;
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
const headOf = (text: string, most: number): string => (text.length <= most ? text : text.slice(0, text.lastIndexOf("\n", most) + 1));

const given = ({ columns, timeUnit }: Reading): Pick<RecordedTest, "columns" | "time_unit"> => {
  const chosen = Object.fromEntries(Object.entries(columns).filter(([, column]) => column !== ""));
  return { columns: chosen, ...(timeUnit ? { time_unit: timeUnit } : {}) };
};

/** Characters of a file that are enough to find what is wrong with it. */
const FIRST_LINES = 20_000;

/** What its first lines say about a file. */
export interface FileHead {
  /** Why it cannot be read; "": it can. */
  fault: string;
  /** Units in the headings of measurement and output; "": none. */
  y: string;
  u: string;
}

export async function fileHead(csv: string, reading: Reading): Promise<FileHead> {
  const { columns, problems } = await previewRecord({ csv: headOf(csv, FIRST_LINES), ...given(reading) });
  const unitOf = (role: "y" | "u"): string => {
    const chosen = reading.columns[role];
    return columns.find(({ guess, heading }) => (chosen ? heading === chosen : guess === role))?.unit ?? "";
  };
  return { fault: problems.map(({ detail }) => detail).join(" "), y: unitOf("y"), u: unitOf("u") };
}

/** `onChange`: whether the shown file has several loops is known. */
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
      h("p", { class: "hint" }, "One file as an example. What you choose here holds for all files. If it has several loops, choose the columns of one to check that loop alone."),
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
    const csv = headOf(whole, HEAD);
    const preview = await previewRecord({ csv, ...given(read()) }).catch(() => null);
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
    offer(files, readable) {
      const isChosen = Object.values(read().columns).some((column) => column !== "") || unit.input.value !== "";
      if (isChosen && files.some((csv) => csv === shown)) return;
      const csv = readable[0] ?? files[0] ?? null;
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
