// Rows under a line of headings that can be added and removed: states, parameters, points of a range.
import { h } from "../dom.ts";

export interface Row<Texts> {
  element: HTMLElement;
  first: HTMLElement;
  texts(): Texts;
  dispose(): void;
}

export interface RowList<Texts> {
  element: HTMLElement;
  texts(): Texts[];
  show(texts: Texts[]): void;
  add(texts: Texts): Row<Texts>;
}

/** `nameOf`: the name of a row in its button to remove it; after a removal the focus moves to the next row. */
export function rowList<Texts>(
  what: string,
  headings: string[],
  onChange: () => void,
  nameOf: (texts: Texts) => string,
  make: (texts: Texts | null, rows: () => Row<Texts>[]) => Row<Texts>,
): RowList<Texts> {
  let rows: Row<Texts>[] = [];
  const list = h("div", { class: "rows" });
  const head = h(
    "div",
    { class: `row-head ${what}-row`, "aria-hidden": "true" },
    headings.map((text) => h("span", {}, text)),
  );
  const add = h(
    "button",
    { type: "button", class: "quiet", onclick: () => append(null).first.focus() },
    `Add a ${what}`,
  );

  function append(texts: Texts | null): Row<Texts> {
    const row = make(texts, () => rows);
    const remove = h("button", { type: "button", class: "quiet remove", title: `Remove this ${what}` }, "×");
    const name = (): void => remove.setAttribute("aria-label", `Remove ${what} ${nameOf(row.texts())}`);
    remove.addEventListener("click", () => {
      const index = rows.indexOf(row);
      row.dispose();
      row.element.remove();
      rows = rows.filter((other) => other !== row);
      head.hidden = rows.length === 0;
      ((rows[index] ?? rows[index - 1])?.first ?? add).focus();
      onChange();
    });
    row.element.addEventListener("input", name);
    name();
    row.element.append(remove);
    list.append(row.element);
    rows.push(row);
    head.hidden = false;
    return row;
  }

  return {
    element: h("div", {}, head, list, add),
    texts: () => rows.map((row) => row.texts()),
    add: append,
    show(next) {
      for (const row of rows) row.dispose();
      rows = [];
      list.replaceChildren();
      head.hidden = true;
      for (const texts of next) append(texts);
    },
  };
}
