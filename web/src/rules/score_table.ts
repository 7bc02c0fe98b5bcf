// The score problem by problem: sorted, filtered by result; a problem opens its design.
import { h } from "../dom.ts";
import { DASH, formatNumber, formatSetting } from "../words/numbers.ts";
import { SCORE_COLUMNS, scoreCells, sortScores, STATUS_WORDS } from "./words.ts";
import type { ScoreOrder, ScoreRow, Status } from "./words.ts";
import { csvText, download } from "../plot/export.ts";

export interface ScoreTable {
  element: HTMLElement;
  show(rows: readonly ScoreRow[], name: string): void;
}

const STATUSES = Object.keys(STATUS_WORDS) as Status[];
const LOOK: Record<Status, string> = { kept: "good", "limits-broken": "bad", unstable: "bad", "no-settings": "muted" };
const SETTINGS = ["Kp", "Ti", "Td"];

/** `onOpen`: the design of that problem is wanted. */
export function scoreTable(onOpen: (row: ScoreRow) => void): ScoreTable {
  let rows: readonly ScoreRow[] = [];
  let subject = "";
  let order: ScoreOrder = { column: "problem", falling: false };
  let made = new Map<ScoreRow, HTMLElement>();
  const filter = h("select", { "aria-label": "Show", onchange: arrange });
  const count = h("span", { class: "hint", role: "status" });
  const head = h("tr", {}, SCORE_COLUMNS.map(({ id, label, meaning }) => h("th", { scope: "col", "data-column": id, class: id === "problem" ? "pin" : null }, h("button", { type: "button", class: "sort", title: meaning, onclick: () => sort(id) }, label))));
  const body = h("tbody", {});
  const table = h("table", { class: "figures comparison-table score-table" }, h("caption", { class: "visually-hidden" }, "Score problem by problem"), h("thead", {}, head), body);
  const save = h("button", { type: "button", class: "quiet", onclick: saveCsv }, "CSV");
  const element = h(
    "section",
    { class: "card", "aria-label": "Problem by problem" },
    h("div", { class: "card-head" }, h("h2", {}, "Problem by problem"), h("div", { class: "actions" }, count, filter, save)),
    h("p", { class: "hint" }, "A problem opens as a design: the robust optimum within its limits beside these settings."),
    h("div", { class: "comparison-scroll", tabindex: 0, role: "region", "aria-label": "Score problem by problem" }, table),
  );

  const shown = (): ScoreRow[] => sortScores(rows.filter(({ score }) => filter.value === "" || score.status === filter.value), order);

  function sort(column: string): void {
    order = { column, falling: order.column === column && !order.falling };
    arrange();
  }

  function arrange(): void {
    const list = shown();
    body.replaceChildren(...list.map((row) => made.get(row)!));
    count.textContent = `${list.length} of ${rows.length}`;
    for (const cell of head.cells) {
      if (cell.dataset["column"] === order.column) cell.setAttribute("aria-sort", order.falling ? "descending" : "ascending");
      else cell.removeAttribute("aria-sort");
    }
  }

  /** Without settings there are no figures: their place is that of the reason. */
  function rowOf(row: ScoreRow): HTMLElement {
    const [problem, status, ...figures] = SCORE_COLUMNS;
    const { why } = row.score;
    const rest = why ? [h("td", { class: "reason", colspan: figures.length }, why)] : figures.map((column) => cellOf(row, column));
    return h("tr", {}, cellOf(row, problem!), cellOf(row, status!), rest);
  }

  function cellOf(row: ScoreRow, { id, value }: (typeof SCORE_COLUMNS)[number]): HTMLElement {
    const { score, known } = row;
    if (id === "problem") return h("th", { scope: "row", class: "pin" }, known ? h("button", { type: "button", class: "link", title: `${known.plant}: design it`, onclick: () => onOpen(row) }, score.name) : score.name);
    if (id === "status") return h("td", { class: LOOK[score.status] }, STATUS_WORDS[score.status]);
    const given = value(row);
    const broken = (id === "Ms" || id === "Mt") && known && typeof given === "number" && score.status === "limits-broken" && given > known[id];
    if (typeof given !== "number") return h("td", {}, given ?? DASH);
    return h("td", { class: broken ? "bad" : null }, SETTINGS.includes(id) ? formatSetting(given) : formatNumber(given));
  }

  function saveCsv(): void {
    const name = subject.replace(/[^\p{L}\p{N}_.-]+/gu, "-").replace(/^[-.]+|[-.]+$/g, "").slice(0, 40);
    download(new Blob([csvText(scoreCells(shown()))], { type: "text/csv" }), `${name ? `${name}-` : ""}score.csv`);
  }

  return {
    element,
    show(next, name) {
      [rows, subject] = [next, name];
      made = new Map(rows.map((row) => [row, rowOf(row)]));
      const chosen = filter.value;
      const numbers = (status: Status): number => rows.filter(({ score }) => score.status === status).length;
      filter.replaceChildren(
        h("option", { value: "" }, "all results"),
        ...STATUSES.map((status) => h("option", { value: status, selected: status === chosen }, `${STATUS_WORDS[status]} (${numbers(status)})`)),
      );
      arrange();
    },
  };
}
