// The comparison on the page: rows to sort and to choose for the plots. Rows are created once for a result and a choice
// of columns; sorting moves them, choosing updates them.
import type { Entry, Result } from "../api/types.ts";
import { drawable, MAX_DRAWN } from "../charts/drawn.ts";
import type { Drawn } from "../charts/drawn.ts";
import { h, svgElement } from "../dom.ts";
import { extent } from "../plot/axis.ts";
import type { Look } from "../plot/frame.ts";
import { swatch } from "../plot/marks.ts";
import { spark } from "../plot/spark.ts";
import type { SparkScale } from "../plot/spark.ts";
import { explained } from "../reach/explanation.ts";
import { comparisonRows, isCompared, notesSummary, reasonOf, settles, sortRows } from "../words/comparison.ts";
import type { ComparisonColumn, ComparisonOrder, ComparisonRow } from "../words/comparison.ts";
import type { ExplainedName } from "../words/explained.ts";
import { DASH } from "../words/numbers.ts";
import { running } from "../words/running.ts";

export interface ComparisonTable {
  element: HTMLElement;
  /** Creates the rows for this result and these columns. `step`: of the set point. */
  build(result: Result, columns: ComparisonColumn[], step: number, address: (index: number) => string): void;
  arrange(order: ComparisonOrder, limit: number | null, onlySettled: boolean): void;
  /** Marks the rows that the plots show. */
  mark(drawn: Drawn[]): void;
}

export interface ComparisonEvents {
  onSort(column: string): void;
  onDraw(index: number, drawn: boolean): void;
}

type Signal = "load" | "setpoint";

interface TableRow {
  entry: Entry;
  element: HTMLTableRowElement;
  box: HTMLInputElement;
  rank: HTMLElement;
  line: HTMLElement;
  sparks: { cell: HTMLElement; signal: Signal }[];
  look: Look | null | undefined;
}

/** More reasons than this are folded; each is also at its dash. */
const FOOTNOTES_OPEN = 3;

export function comparisonTable(events: ComparisonEvents): ComparisonTable {
  let result: Result = { controllers: [] };
  let columns: ComparisonColumn[] = [];
  let scales: Record<Signal, SparkScale> | null = null;
  let rows = new Map<number, TableRow>();
  let footnotes: string[] = [];
  const head = h("tr", {});
  const answered = h("tbody", {});
  const refused = h("tbody", { class: "refused" });
  const table = h(
    "table",
    { class: "figures comparison-table" },
    h("caption", { class: "visually-hidden" }, "Methods on this plant, each with its figures"),
    h("thead", {}, head),
    answered,
    refused,
  );
  const notes = h("ol", { class: "footnotes" });
  const notesCount = h("summary", {});
  const folded = h("details", { class: "missing" }, notesCount, notes);
  const scroller = h("div", { class: "comparison-scroll", tabindex: 0, role: "region", "aria-label": "Comparison table" }, table);
  const cue = h("p", { class: "hint scroll-cue", hidden: true });
  const element = h("div", {}, scroller, cue, folded);
  scroller.addEventListener("scroll", tellMore, { passive: true });
  new ResizeObserver(() => requestAnimationFrame(tellMore)).observe(scroller);

  /** How many rows are below the visible part of the table. */
  function tellMore(): void {
    const end = scroller.scrollTop + scroller.clientHeight;
    const below = [...table.tBodies].flatMap((body) => [...body.rows]).filter((row) => row.offsetTop + row.offsetHeight / 2 > end);
    cue.hidden = below.length === 0;
    cue.textContent = `${below.length} more ${below.length === 1 ? "row" : "rows"} below: scroll the table.`;
  }

  function heading(id: string, label: string, meaning: string, name = "", about: ExplainedName | null = null): HTMLElement {
    const button = h(
      "button",
      { type: "button", class: "sort", title: meaning, onclick: () => events.onSort(id) },
      label,
    );
    return h("th", { scope: "col", "data-column": id, class: name }, button, about ? explained(about, "", `What is ${label}?`) : "");
  }

  const mark = (why: string): number => {
    if (!footnotes.includes(why)) footnotes.push(why);
    return footnotes.indexOf(why) + 1;
  };

  function figureCell(column: ComparisonColumn, entry: Entry): HTMLElement {
    const figure = column.figure(entry);
    if (figure.text !== "") return h("td", {}, figure.text);
    return h("td", { title: figure.why }, DASH, h("sup", {}, mark(figure.why)));
  }

  function makeRow({ index, name, entry }: ComparisonRow, address: (index: number) => string): TableRow {
    const box = h("input", { type: "checkbox", "aria-label": `Draw ${name}`, disabled: !drawable(entry) });
    box.addEventListener("change", () => events.onDraw(index, box.checked));
    const rank = h("span", { class: "rank" });
    const line = h("span", { class: "line" });
    const sparks = (["load", "setpoint"] as const).map((signal) => ({ cell: h("td", { class: "spark" }), signal }));
    const first = h("td", { class: "pin first" }, h("label", { class: "draw" }, box, rank));
    const title = entry.error
      ? name
      : h("a", { href: address(index), title: `${entry.title ?? name}: its settings and verdict` }, name);
    const method = h("th", { scope: "row", class: "pin method-cell" }, title, line);
    const cells = entry.error
      ? [h("td", { class: "reason", colspan: columns.length + sparks.length + 1 }, h("span", {}, reasonOf(entry)))]
      : [...sparks.map(({ cell }) => cell), ...columns.map((column) => figureCell(column, entry)), notesCell(entry)];
    const today = entry.method === "baseline";
    const row = h("tr", { class: today ? "today" : null }, first, method, cells);
    return { entry, element: row, box, rank, line, sparks, look: undefined };
  }

  function build(next: Result, shown: ComparisonColumn[], step: number, address: (index: number) => string): void {
    [result, columns, footnotes] = [next, shown, []];
    const list = comparisonRows(result, null);
    scales = sparkScales(list, step);
    head.replaceChildren(
      heading("rank", "#", `by the ${isCompared(result) ? "excess over the optimum at the same Ms" : "load IAE"}, of those that settle within Ms`, "pin first"),
      heading("method", "Method", "by name", "pin method-cell"),
      h("th", { scope: "col", class: "spark-head" }, "y, load step"),
      h("th", { scope: "col", class: "spark-head" }, "y, set-point step"),
      ...columns.map((column) => heading(column.id, column.label, column.meaning, "", column.about)),
      h("th", { scope: "col", class: "notes-head" }, "Notes"),
    );
    rows = new Map(list.map((row) => [row.index, makeRow(row, address)]));
    folded.hidden = footnotes.length === 0;
    folded.open = footnotes.length <= FOOTNOTES_OPEN;
    notesCount.textContent = `Why ${footnotes.length === 1 ? "a figure is" : "figures are"} missing`;
    notes.replaceChildren(...footnotes.map((note) => h("li", {}, note)));
  }

  /** Rows that are in the right place are not moved: a moved row loses the focus. */
  function place(body: HTMLElement, list: ComparisonRow[]): void {
    const elements = list.map(({ index }) => rows.get(index)!.element);
    const same = body.children.length === elements.length && elements.every((row, at) => body.children[at] === row);
    if (!same) body.replaceChildren(...elements);
  }

  function arrange(order: ComparisonOrder, limit: number | null, onlySettled: boolean): void {
    const ranked = comparisonRows(result, limit);
    for (const { index, rank, why } of ranked) {
      const cell = rows.get(index)!.rank;
      cell.textContent = rank === null ? "" : String(rank);
      cell.title = why;
    }
    const shown = ranked.filter(({ entry }) => !onlySettled || settles(entry));
    const sorted = sortRows(
      shown.filter(({ entry }) => !entry.error),
      order,
      columns,
    );
    place(answered, sorted);
    place(
      refused,
      shown.filter(({ entry }) => entry.error),
    );
    for (const cell of head.querySelectorAll<HTMLElement>("[data-column]")) {
      const sorts = cell.dataset["column"] === order.column;
      if (sorts) cell.setAttribute("aria-sort", order.falling ? "descending" : "ascending");
      else cell.removeAttribute("aria-sort");
    }
  }

  /** `name`: its name in the plots. */
  function draw(row: TableRow, look: Look | null, name: string): void {
    if (row.look === look) return;
    row.look = look;
    row.line.replaceChildren(...(look === null ? [] : [swatch(look), name]));
    row.element.classList.toggle("drawn", look !== null);
    for (const { cell, signal } of row.sparks) {
      const response = running(row.entry).responses?.[signal];
      if (!response || !scales) continue;
      const trace = { name: "", look: look ?? ("data" as const), x: response.t, y: response.y };
      cell.replaceChildren(svgElement(spark(trace, scales[signal])));
    }
  }

  return {
    element,
    build,
    arrange,
    mark(drawn) {
      const full = drawn.length >= MAX_DRAWN;
      for (const [index, row] of rows) {
        const item = drawn.find((candidate) => candidate.index === index);
        row.box.checked = item !== undefined;
        row.box.disabled = !drawable(row.entry) || (full && !item);
        row.box.title = full && !item ? `At most ${MAX_DRAWN} are drawn: remove one first.` : "";
        draw(row, item?.look ?? null, item?.name ?? "");
      }
    },
  };
}

function notesCell(entry: Entry): HTMLElement {
  const summary = notesSummary(entry);
  if (summary === "") return h("td", { class: "notes-cell" });
  const details = (entry.warnings ?? []).map((warning) => h("p", {}, warning.detail));
  const text = entry.robustness?.stable === false ? h("strong", { class: "bad" }, summary) : summary;
  return h(
    "td",
    { class: "notes-cell" },
    details.length === 0 ? text : h("details", {}, h("summary", {}, text), details),
  );
}

/** One scale for all: that of the better three quarters, so that large oscillations do not flatten the others. */
function sparkScales(rows: ComparisonRow[], step: number): Record<Signal, SparkScale> | null {
  const good = rows.filter(({ entry }) => entry.robustness?.stable && entry.responses);
  const better = good.slice(0, Math.max(1, Math.ceil(0.75 * good.length)));
  const scale = (signal: Signal, level: number): SparkScale => {
    const traces = better.flatMap(({ entry }) => running(entry).responses?.[signal] ?? []);
    const ends = traces.map((trace) => trace.t[trace.t.length - 1] ?? 0).sort((a, b) => a - b);
    const y = extent([...traces.map((trace) => trace.y), [0, level]], "linear");
    return { x: [0, ends[Math.floor(ends.length / 2)] ?? 1], y, level };
  };
  return better.length === 0 ? null : { load: scale("load", 0), setpoint: scale("setpoint", step) };
}
