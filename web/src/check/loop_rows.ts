// The loops of a check as rows to edit: name, kind, range of the output, weight; and a first row that sets all of them.
import { newest } from "../api/latest.ts";
import { h } from "../dom.ts";
import { choiceField, textField } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
import { KINDS } from "../words/check.ts";
import type { Kind } from "../words/check.ts";
import { fileHead } from "./reading_fields.ts";
import type { LoopTexts, Reading } from "./request.ts";

export interface LoopRows {
  element: HTMLElement;
  texts(): LoopTexts[];
  show(loops: readonly LoopTexts[]): void;
  add(loops: readonly LoopTexts[]): void;
  /** Reads the first lines of the files that were not read in this way; their faults then stand in their rows. The texts of the files that can be
      read; null: it was called again since. */
  read(reading: Reading): Promise<string[] | null>;
}

interface LoopRow {
  element: HTMLTableRowElement;
  remove: HTMLButtonElement;
  texts(): LoopTexts;
  read(reading: Reading): Promise<void>;
  hasFault(): boolean;
  /** What the first row sets. */
  set(part: Partial<LoopTexts>): void;
  dispose(): void;
}

const HEADS = ["Loop", "Record", "Kind", "Averaging", "Output from", "to", "Weight", ""];

const size = (characters: number): string => `${Math.max(1, Math.round(characters / 1024))} KiB`;

const record = ({ file, given }: LoopTexts): string => file || (given.csv === undefined ? "arrays" : "CSV");

export function loopRows(errors: FormErrors, onChange: () => void): LoopRows {
  let rows: LoopRow[] = [];
  const begin = newest();
  const body = h("tbody", {});
  const kind = h("select", { "aria-label": "Kind of all loops" }, h("option", { value: "" }, "as below"), KINDS.map(([value, text]) => h("option", { value }, text)));
  const text = (label: string, placeholder: string): HTMLInputElement =>
    h("input", { type: "text", "aria-label": label, placeholder, autocomplete: "off", spellcheck: "false" });
  const low = text("Lower end of the output of all loops", "as below");
  const high = text("Upper end of the output of all loops", "as below");
  const weight = text("Weight of all loops", "as below");
  kind.addEventListener("change", () => kind.value !== "" && setAll({ kind: kind.value as Kind }));
  low.addEventListener("change", () => setAll({ low: low.value }));
  high.addEventListener("change", () => setAll({ high: high.value }));
  weight.addEventListener("change", () => setAll({ weight: weight.value }));
  const all = h("tr", { class: "all-loops" }, [h("th", { scope: "row", colspan: 2 }, "All loops"), ...[kind, "", low, high, weight, ""].map((cell) => h("td", {}, cell))]);
  const table = h(
    "table",
    { class: "figures loop-rows" },
    h("caption", { class: "visually-hidden" }, "Loops to check"),
    h("thead", {}, h("tr", {}, HEADS.map((name) => h("th", { scope: "col" }, name || h("span", { class: "visually-hidden" }, "Remove"))))),
    h("tbody", {}, all),
    body,
  );
  const element = h("div", { class: "scroll loop-rows-scroll", role: "region", "aria-label": "Loops to check", tabindex: 0 }, table);

  function setAll(part: Partial<LoopTexts>): void {
    for (const row of rows) row.set(part);
    onChange();
  }

  function remove(row: LoopRow): void {
    const index = rows.indexOf(row);
    row.dispose();
    row.element.remove();
    rows = rows.filter((other) => other !== row);
    (rows[index] ?? rows[index - 1])?.remove.focus();
    changed();
  }

  function changed(): void {
    all.hidden = rows.length < 2;
    onChange();
  }

  function add(loops: readonly LoopTexts[]): void {
    for (const loop of loops) {
      const row = loopRow(loop, errors, (part) => (rows.includes(row) ? `/loops/${rows.indexOf(row)}${part}` : null), () => remove(row));
      rows.push(row);
      body.append(row.element);
    }
    changed();
  }

  return {
    element,
    texts: () => rows.map((row) => row.texts()),
    add,
    async read(reading) {
      const isNewest = begin();
      for (const row of rows) if (isNewest()) await row.read(reading);
      return isNewest() ? rows.filter((row) => !row.hasFault()).flatMap((row) => row.texts().given.csv ?? []) : null;
    },
    show(loops) {
      for (const row of rows) row.dispose();
      rows = [];
      body.replaceChildren();
      for (const field of [kind, low, high, weight]) field.value = "";
      add(loops);
    },
  };
}

function loopRow(given: LoopTexts, errors: FormErrors, pointer: (part: string) => string | null, onRemove: () => void): LoopRow {
  const named = (what: string): string => `${what} of ${given.tag || "this loop"}`;
  const field = (what: string, value: string, part: string, placeholder = "") =>
    textField({ label: named(what), bare: true, value, placeholder, pointer: () => pointer(part) }, errors);
  const tag = field("Name", given.tag, "/tag", "name");
  const kind = choiceField({ label: named("Kind"), bare: true, choices: KINDS, value: given.kind, pointer: () => pointer("/kind") }, errors);
  const low = field("Lower end of the output", given.low, "/range/op/low", "0");
  const high = field("Upper end of the output", given.high, "/range/op/high", "100");
  const weight = field("Weight", given.weight, "/weight");
  const averaging = h("input", { type: "checkbox", "aria-label": `${given.tag || "This loop"} smooths flows`, checked: given.averaging });
  const remove = h("button", { type: "button", class: "quiet remove", "aria-label": `Remove ${given.tag || "this loop"}`, title: "Remove this loop", onclick: onRemove }, "×");
  const follow = (): void => {
    averaging.disabled = kind.input.value !== "level";
  };
  kind.input.addEventListener("change", follow);
  follow();
  const characters = given.given.csv?.length ?? 0;
  const fault = h("span", { class: "error" });
  const source = [h("span", { class: "hint" }, record(given), characters > 0 ? `, ${size(characters)}` : ""), fault];
  let asRead = "";
  let units: LoopTexts["units"] = given.units;
  const fields = [tag, kind, low, high, weight];
  return {
    element: h("tr", {}, h("th", { scope: "row" }, tag.element), ...[source, kind.element, averaging, low.element, high.element, weight.element, remove].map((cell) => h("td", {}, cell))),
    remove,
    async read(reading) {
      const { csv } = given.given;
      const way = JSON.stringify(reading);
      if (csv === undefined || asRead === way) return;
      asRead = way;
      // The check itself reports what it cannot read.
      const head = await fileHead(csv, reading).catch(() => null);
      if (!head || asRead !== way) return;
      fault.textContent = head.fault;
      units = { y: head.y, u: head.u };
    },
    hasFault: () => fault.textContent !== "",
    texts: () => ({
      ...given,
      units,
      tag: tag.input.value,
      kind: kind.input.value as Kind,
      averaging: averaging.checked,
      low: low.input.value,
      high: high.input.value,
      weight: weight.input.value,
    }),
    set(part) {
      if (part.kind !== undefined) kind.input.value = part.kind;
      if (part.low !== undefined) low.input.value = part.low;
      if (part.high !== undefined) high.input.value = part.high;
      if (part.weight !== undefined) weight.input.value = part.weight;
      for (const { control } of fields) errors.settle(control);
      follow();
    },
    dispose() {
      for (const { control } of fields) errors.remove(control);
    },
  };
}
