// The work list of a check as a table: a row for each loop with its last periods, its cause, the gain and what to do. Rows
// are created when they come into view, a part at a time; sorting and filtering move them.
import type { ListedLoop } from "../api/types.ts";
import { h, svgElement } from "../dom.ts";
import { extent } from "../plot/axis.ts";
import { spark } from "../plot/spark.ts";
import { explained } from "../reach/explanation.ts";
import type { ListView } from "../routes.ts";
import { orderOf } from "../words/comparison.ts";
import type { ExplainedName } from "../words/explained.ts";
import { causeMark, loopLink } from "./loop_name.ts";
import type { LoopAddress } from "./loop_name.ts";
import { mendedBefore } from "./columns.ts";
import type { WorkColumn, WorkRow } from "./columns.ts";

export interface WorkTable {
  element: HTMLElement;
  /** Creates the rows of an answer. `address`: of a loop's page. */
  build(rows: readonly WorkRow[], columns: readonly WorkColumn[], address: LoopAddress): void;
  /** Shows these rows, in this order. */
  arrange(shown: readonly WorkRow[], view: ListView): void;
  /** Moves the focus to a loop; false if its row is not shown. */
  focus(place: number): boolean;
}

/** Rows that are added at a time: the layout of a long table takes time at every change. */
const PART = 120;
/** Rows are added while the last one is this close. */
const AHEAD_PX = 600;

export function workTable(onSort: (column: string) => void): WorkTable {
  const elements = new Map<number, HTMLTableRowElement>();
  let all: readonly WorkRow[] = [];
  let columns: readonly WorkColumn[] = [];
  let address: LoopAddress = () => "";
  let shown: readonly WorkRow[] = [];
  let footnotes: string[] = [];
  const head = h("tr", {});
  const body = h("tbody", {});
  const table = h(
    "table",
    { class: "figures work-table" },
    h("caption", { class: "visually-hidden" }, "Loops in the order in which to work on them"),
    h("thead", {}, head),
    body,
  );
  const scroller = h("div", { class: "scroll work-scroll", role: "region", "aria-label": "Work list", tabindex: 0 }, table);
  const notes = h("ol", { class: "footnotes" });
  const why = h("details", { class: "missing", hidden: true }, h("summary", {}, "Why figures are missing"), notes);
  const cue = h("p", { class: "hint", hidden: true });
  body.addEventListener("keydown", moveFocus);
  scroller.addEventListener("scroll", addAhead, { passive: true });
  // On paper all of them are in view, with their footnotes.
  window.addEventListener("beforeprint", () => {
    addTo(shown.length);
    why.open = true;
  });

  function elementOf(row: WorkRow): HTMLTableRowElement {
    const known = elements.get(row.place);
    if (known) return known;
    const made = rowElement(row);
    elements.set(row.place, made);
    return made;
  }

  /** At least this many rows are in the table. */
  function addTo(count: number): void {
    body.append(...shown.slice(body.rows.length, count).map(elementOf));
    const left = shown.length - body.rows.length;
    cue.hidden = left <= 0;
    cue.textContent = `${left} more below: scroll the table.`;
  }

  function addAhead(): void {
    if (body.rows.length < shown.length && scroller.scrollTop + scroller.clientHeight + AHEAD_PX > scroller.scrollHeight)
      addTo(body.rows.length + PART);
  }

  /** From row to row. */
  function moveFocus(event: KeyboardEvent): void {
    const step = event.key === "ArrowDown" ? 1 : event.key === "ArrowUp" ? -1 : 0;
    const row = event.target instanceof Element ? event.target.closest("tr") : null;
    const at = [...body.rows].findIndex((other) => other === row);
    const next = at < 0 || step === 0 ? undefined : body.rows[at + step];
    if (!next) return;
    event.preventDefault();
    next.querySelector("a")?.focus();
  }

  function heading(id: string, label: string, look: string, about: ExplainedName | null): HTMLElement {
    const sort = h("button", { type: "button", class: "sort", onclick: () => onSort(id) }, label);
    const explain = about ? explained(about, "", `What is ${label}?`) : "";
    return h("th", { scope: "col", "data-column": id, class: look || null }, sort, explain);
  }

  function cell(row: WorkRow, column: WorkColumn): HTMLElement {
    const { text, why: reason } = column.figure(row);
    const look = column.words ? "words" : null;
    if (column.id === "cause") return h("td", { class: look }, causeMark(row.loop.cause));
    const first = column.id === "action" ? mendedBefore(row, all) : null;
    if (first) return h("td", { class: look }, text, h("span", { class: "hint after" }, "after ", loopLink(first.place, first.loop.tag, address)));
    return h("td", { class: look, title: reason || null }, text, reason ? h("sup", {}, footnotes.indexOf(reason) + 1) : null);
  }

  function rowElement(row: WorkRow): HTMLTableRowElement {
    return h(
      "tr",
      {},
      h("td", { class: "pin rank" }, row.rank),
      h("th", { scope: "row", class: "pin loop" }, loopLink(row.place, row.loop.tag, address)),
      h("td", { class: "spark" }, waveSpark(row.loop)),
      columns.map((column) => cell(row, column)),
    );
  }

  return {
    element: h("div", {}, scroller, cue, why),
    build(rows, given, addressOf) {
      [all, columns, address] = [rows, given, addressOf];
      elements.clear();
      footnotes = [...new Set(rows.flatMap((row) => columns.map((column) => column.figure(row).why)))].filter(Boolean);
      head.replaceChildren(
        heading("rank", "#", "pin rank", null),
        heading("loop", "Loop", "pin loop", null),
        h("th", { scope: "col", class: "spark" }, rows.some(({ loop }) => loop.excerpt) ? "Last periods" : "Trend"),
        ...columns.map(({ id, label, words, about }) => heading(id, label, words ? "words" : "", about)),
      );
      why.hidden = footnotes.length === 0;
      notes.replaceChildren(...footnotes.map((note) => h("li", {}, note)));
    },
    arrange(next, view) {
      // A moved row loses the focus.
      const kept = [...body.rows].every((row, at) => next[at] && elements.get(next[at].place) === row);
      shown = next;
      if (!kept) {
        body.replaceChildren();
        scroller.scrollTop = 0;
      }
      addTo(Math.max(body.rows.length, PART));
      const { column, falling } = orderOf(view.sort || "rank");
      for (const one of head.querySelectorAll<HTMLElement>("[data-column]")) {
        if (one.dataset["column"] === column) one.setAttribute("aria-sort", falling ? "descending" : "ascending");
        else one.removeAttribute("aria-sort");
      }
    },
    focus(place) {
      const at = shown.findIndex((row) => row.place === place);
      addTo(at + PART);
      const link = elements.get(place)?.querySelector("a");
      if (at < 0 || !link) return false;
      link.focus({ preventScroll: true });
      link.scrollIntoView({ block: "center", inline: "nearest" });
      return true;
    },
  };
}

const mean = (values: readonly (number | null)[]): number | null => {
  const known = values.filter((value): value is number => value !== null);
  return known.length === 0 ? null : known.reduce((sum, value) => sum + value, 0) / known.length;
};

/** The measurement over the last periods, where its wave is seen, or else over the whole record, with a line at the mean of the set point or else of
    itself. */
function waveSpark({ excerpt, trend }: ListedLoop): SVGElement | null {
  const { t, y, r } = excerpt ?? trend;
  const level = mean(r ?? y);
  if (t.length < 2 || level === null) return null;
  return svgElement(
    spark({ name: "", look: 1, x: t, y }, { x: [t[0]!, t[t.length - 1]!], y: extent([y, [level]], "linear", 0.05), level }),
  );
}
