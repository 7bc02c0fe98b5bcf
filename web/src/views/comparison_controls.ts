// Controls above the comparison: the limit on Ms, only rows that settle, columns, the table as a file.
import { closesItself, h, uniqueId } from "../dom.ts";
import { parseNumber } from "../form/number.ts";
import type { ComparisonColumn } from "../words/comparison.ts";

export interface ComparisonControls {
  element: HTMLElement;
  /** Null: the limit in the answer. */
  limit(): number | null;
  /** Without reporting. */
  setLimit(Ms: number | null): void;
  onlySettled(): boolean;
  setColumns(columns: ComparisonColumn[]): void;
  /** How the rows are ranked. */
  setCriterion(words: string): void;
  /** True if a column is shown. */
  shows(id: string): boolean;
}

export interface ComparisonControlEvents {
  onChange(): void;
  /** A limit was typed. */
  onLimit(Ms: number): void;
  onColumns(): void;
  onExport(): void;
}

export function comparisonControls(events: ComparisonControlEvents): ComparisonControls {
  let limit: number | null = null;
  /** The reader's deviations from the initial choice. */
  const chosen = new Map<string, boolean>();
  let columns: ComparisonColumn[] = [];
  const input = h("input", {
    type: "text",
    id: uniqueId("rank-Ms"),
    autocomplete: "off",
    "aria-describedby": "rank-error",
  });
  const label = h("label", { for: input.id });
  const error = h("span", { class: "error", id: "rank-error", role: "status" });
  const stable = h("input", { type: "checkbox", id: uniqueId("only-settled") });
  const list = h("div", { class: "menu-items columns" });
  const menu = h("details", { class: "menu" }, h("summary", {}, "Columns"), list);

  input.addEventListener("change", () => {
    const parsed = parseNumber(input.value, "Ms");
    const sentence = !parsed.ok ? parsed.sentence : parsed.value > 1 ? "" : `Ms is ${input.value}; it must be above 1.`;
    error.textContent = sentence;
    input.removeAttribute("aria-invalid");
    if (sentence !== "" || !parsed.ok) return input.setAttribute("aria-invalid", "true");
    limit = parsed.value;
    events.onLimit(limit);
  });
  stable.addEventListener("change", () => events.onChange());
  closesItself(menu);

  const shows = (id: string): boolean => chosen.get(id) ?? columns.find((column) => column.id === id)?.main ?? false;

  return {
    element: h(
      "div",
      { class: "comparison-controls" },
      label,
      input,
      error,
      h("span", { class: "check" }, stable, h("label", { for: stable.id }, "only those that settle")),
      menu,
      h("button", { type: "button", class: "quiet", onclick: () => events.onExport() }, "Export CSV"),
    ),
    limit: () => limit,
    setLimit(Ms) {
      if (Ms === limit) return;
      limit = Ms;
      input.value = Ms === null ? "" : String(Ms);
    },
    onlySettled: () => stable.checked,
    setColumns(next) {
      const known = columns.map((column) => column.label).join();
      columns = next;
      if (known === columns.map((column) => column.label).join()) return;
      list.replaceChildren(
        ...columns.map((column) => {
          const box = h("input", { type: "checkbox", id: uniqueId("column"), checked: shows(column.id) });
          box.addEventListener("change", () => {
            chosen.set(column.id, box.checked);
            events.onColumns();
          });
          return h("span", { class: "check" }, box, h("label", { for: box.id, title: column.meaning }, column.label));
        }),
      );
    },
    setCriterion(words) {
      label.textContent = `ranked by ${words}, with Ms ≤`;
    },
    shows,
  };
}
