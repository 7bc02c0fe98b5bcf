// The figures, one column per entry. A figure without a number is a dash, with the reason below the table.
import type { Entry } from "../api/types.ts";
import { h } from "../dom.ts";
import { explained } from "../reach/explanation.ts";
import type { FigureGroup } from "../words/figures.ts";
import { DASH } from "../words/numbers.ts";

/** What a column is about. */
type Subject = Partial<Pick<Entry, "title" | "error">>;

export interface TableColumn<T = Entry> {
  name: string;
  entry: T;
  /** The swatch of its line in the plots, if it is drawn. */
  swatch(): Element | null;
}

export function figuresTable<T extends Subject>(caption: string, columns: TableColumn<T>[], groups: FigureGroup<T>[]): HTMLElement {
  const notes: string[] = [];
  const mark = (why: string): number => {
    if (!notes.includes(why)) notes.push(why);
    return notes.indexOf(why) + 1;
  };
  const table = h(
    "table",
    { class: "figures" },
    h("caption", { class: "visually-hidden" }, caption),
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        h("td", {}),
        columns.map((column) =>
          h("th", { scope: "col", title: column.entry.title ?? column.name }, column.swatch(), column.name),
        ),
      ),
    ),
    groups.map((group) =>
      h(
        "tbody",
        {},
        h("tr", { class: "group" }, h("th", { scope: "rowgroup", colspan: columns.length + 1 }, group.title)),
        group.rows.map((row) =>
          h(
            "tr",
            {},
            h("th", { scope: "row", title: row.meaning }, row.about ? explained(row.about, row.label) : row.label),
            columns.map((column) => {
              const value = column.entry.error
                ? { text: "", why: `${column.name} has no result for this entry.` }
                : row.value(column.entry);
              if (value.text !== "") return h("td", {}, value.text);
              return h("td", { title: value.why }, DASH, h("sup", {}, mark(value.why)));
            }),
          ),
        ),
      ),
    ),
  );
  return h(
    "div",
    {},
    h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": caption }, table),
    notes.length > 0
      ? h(
          "ol",
          { class: "footnotes" },
          notes.map((note) => h("li", {}, note)),
        )
      : null,
  );
}
