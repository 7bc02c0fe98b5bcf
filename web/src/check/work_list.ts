// The answer of a check: how many loops have which cause, the work list, the map of periods, cascades.
import type { CheckContent } from "../api/types.ts";
import { h } from "../dom.ts";
import { download } from "../plot/export.ts";
import type { ListView } from "../routes.ts";
import { orderOf, sortText } from "../words/comparison.ts";
import type { UnitNames } from "../words/numbers.ts";
import { nameColumn, shownRows, workColumns, workCsv, workRows } from "./columns.ts";
import type { WorkColumn, WorkRow } from "./columns.ts";
import { countsSentence, workFilters } from "./filters.ts";
import { followAddress, loopLink } from "./loop_name.ts";
import type { LoopAddress } from "./loop_name.ts";
import { periodMap } from "./period_map.ts";
import { workTable } from "./table.ts";

export interface WorkList {
  element: HTMLElement;
  /** `address`: of a loop's page. */
  show(content: CheckContent, units: UnitNames, address: LoopAddress): void;
  setView(view: ListView): void;
  /** Places of the rows that are shown, in their order. */
  order(): number[];
  focus(place: number): boolean;
  /** For speech. */
  sentence(): string;
  save(name: string): void;
}

/** `onView`: the user sorted or filtered; the address follows. `before`: the choice of an earlier check. */
export function workList(announce: (sentence: string) => void, onView: (view: ListView) => void, before: HTMLElement): WorkList {
  let rows: WorkRow[] = [];
  let columns: WorkColumn[] = [];
  let view: ListView | null = null;
  let shown: WorkRow[] = [];
  let addressOf: LoopAddress = () => "";
  const filters = workFilters((part) => change({ ...view!, ...part }), before);
  const table = workTable(sortBy);
  const periods = h("section", { class: "card", "aria-labelledby": "check-periods" });
  const cascades = h("section", { class: "card", "aria-labelledby": "check-cascades" });
  const element = h(
    "div",
    { class: "check-results" },
    h("section", { class: "card", "aria-label": "Loops" }, filters.element, table.element),
    periods,
    cascades,
  );

  followAddress(element, (place) => addressOf(place));

  function change(next: ListView): void {
    setView(next);
    onView(next);
  }

  function setView(next: ListView): void {
    view = next;
    shown = shownRows(rows, columns, next);
    table.arrange(shown, next);
    filters.show(next, shown.length, rows.length);
  }

  function sortBy(id: string): void {
    const order = orderOf(view!.sort);
    const column = columns.find((candidate) => candidate.id === id);
    const falling = order.column === id ? !order.falling : (column?.falls ?? false);
    change({ ...view!, sort: sortText({ column: id, falling }) });
    announce(`Sorted by ${(column ?? nameColumn).label}, ${falling ? "falling" : "rising"}.`);
  }

  function showCascades({ cascades: pairs, loops }: CheckContent, address: LoopAddress): void {
    cascades.hidden = pairs.length === 0;
    const link = (place: number): HTMLElement => loopLink(place, loops[place]!.tag, address);
    cascades.replaceChildren(
      h("h2", { id: "check-cascades" }, "Cascades"),
      h(
        "ul",
        { class: "plain" },
        pairs.map(({ master, slave }) => h("li", {}, link(master), " gives ", link(slave), " its set point.")),
      ),
    );
  }

  return {
    element,
    show(content, units, address) {
      addressOf = address;
      rows = workRows(content);
      columns = workColumns(rows, units, content.since);
      filters.build(rows);
      table.build(rows, columns, address);
      const map = periodMap(content, address);
      periods.replaceChildren(
        h("h2", { id: "check-periods" }, "Map of periods"),
        map ?? h("p", { class: "hint" }, "No loop oscillates regularly."),
      );
      showCascades(content, address);
      if (view) setView(view);
    },
    setView,
    order: () => shown.map(({ place }) => place),
    focus: table.focus,
    sentence: () => countsSentence(rows),
    save(name) {
      download(new Blob([workCsv(shown, columns, rows)], { type: "text/csv" }), `${name}.csv`);
    },
  };
}
