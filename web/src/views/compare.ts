// Compare: every method on this plant in one table, and the chosen rows together in every plot.
import { isFinal, nameOf } from "../api/types.ts";
import type { Job, Result } from "../api/types.ts";
import { defaultOverlay, drawnEntries } from "../charts/drawn.ts";
import type { Drawn } from "../charts/drawn.ts";
import { LINEAR_NOTE, hasLinear } from "../charts/responses.ts";
import { h } from "../dom.ts";
import { asksForAll } from "../form/tuning_request.ts";
import { csvText, download, fileNameOf } from "../plot/export.ts";
import { plotGrid } from "../plot/grid.ts";
import { swatch } from "../plot/marks.ts";
import { formatRoute } from "../routes.ts";
import type { Store, Workspace } from "../store.ts";
import { comparisonColumns, comparisonRows, comparisonTable as tableOf, isCompared, orderOf, sortText } from "../words/comparison.ts";
import type { ComparisonColumn } from "../words/comparison.ts";
import { unitNames } from "../words/numbers.ts";
import { progressCard } from "./cards/progress_card.ts";
import { titleCard } from "./cards/title_card.ts";
import { tradeoffCard } from "./cards/tradeoff_card.ts";
import { showFailure } from "./cards/verdict_card.ts";
import { showEntryPlots } from "./entry_plots.ts";
import { jobActions } from "./job_actions.ts";
import type { JobEvents } from "./job_actions.ts";
import { comparisonControls } from "./comparison_controls.ts";
import { comparisonTable } from "./comparison_table.ts";
import type { View } from "./start.ts";

export function compareView(store: Store, announce: (sentence: string) => void, events: JobEvents): View {
  let shown: Result | null = null;
  let drawnBefore: number[] | null = null;
  let columns: ComparisonColumn[] = [];
  const designLink = h("a", { href: "#/" }, "Settings and verdict");
  const { all, trouble, complain, cancel } = jobActions(store, events);
  const title = titleCard("Compare", announce, designLink);
  const failure = h("section", { class: "verdict", "aria-label": "Verdict" });
  const progress = progressCard(announce, () => void cancel());
  const heading = h("h2", { id: "comparison-title" });
  const controls = comparisonControls({
    onChange: arrange,
    onLimit: (rankMs) => store.set((workspace) => ({ ...workspace, rankMs })),
    onColumns: rebuild,
    onExport: exportTable,
  });
  const table = comparisonTable({ onSort: sortBy, onDraw: choose });
  const star = h("p", { class: "hint" }, "* the load IAE of the robust PID whose limits on Ms and Mt are both the Ms of the row, with the usual filter. A row with a larger Mt or another filter can lie below it.");
  const legend = h("p", { class: "pane-legend overlay-legend" });
  const plots = plotGrid(announce);
  const tradeoff = tradeoffCard(announce);
  const comparison = h(
    "section",
    { class: "card comparison", "aria-labelledby": heading.id },
    h("div", { class: "comparison-head" }, heading, controls.element),
    table.element,
    star,
    all,
  );
  const linearNote = h("p", { class: "hint", hidden: true }, LINEAR_NOTE);
  const overlay = h(
    "section",
    { class: "main-column", "aria-labelledby": "overlay-title" },
    h("div", { class: "overlay-head" }, h("h2", { id: "overlay-title" }, "Chosen rows, together"), legend),
    linearNote,
    plots.element,
    tradeoff.element,
  );
  const element = h(
    "main",
    { class: "compare", id: "main" },
    title.element,
    trouble,
    failure,
    progress.element,
    comparison,
    overlay,
  );

  function sortBy(column: string): void {
    const order = orderOf(store.get().sort);
    const sort = sortText({ column, falling: order.column === column && !order.falling });
    store.set((workspace) => ({ ...workspace, sort }));
    const label = columns.find((candidate) => candidate.id === column)?.label ?? column;
    announce(`Sorted by ${label}, ${orderOf(sort).falling ? "falling" : "rising"}.`);
  }

  function drawnNow(workspace: Workspace, result: Result): Drawn[] {
    return drawnEntries(result, workspace.drawn ?? defaultOverlay(result));
  }

  function choose(index: number, draw: boolean): void {
    const workspace = store.get();
    const result = workspace.job?.result;
    if (!result) return;
    const others = drawnNow(workspace, result)
      .map((item) => item.index)
      .filter((other) => other !== index);
    const drawn = draw ? [...others, index].sort((a, b) => a - b) : others;
    store.set((current) => ({ ...current, drawn }));
  }

  function exportTable(): void {
    const job = store.get().job;
    if (!job?.result) return;
    const every = comparisonColumns(unitNames(job.request?.units));
    const rows = comparisonRows(job.result, controls.limit());
    const blob = new Blob([csvText(tableOf(rows, every))], { type: "text/csv" });
    download(blob, `${fileNameOf({ subject: nameOf(job), fileName: "comparison-table" })}.csv`);
  }

  function arrange(): void {
    table.arrange(orderOf(store.get().sort), controls.limit(), controls.onlySettled());
  }

  function rebuild(): void {
    const job = store.get().job;
    const result = job?.result;
    if (!job || !result) return;
    const every = comparisonColumns(unitNames(job.request?.units));
    controls.setColumns(every);
    const compared = isCompared(result);
    controls.setCriterion(compared ? "excess over the optimum*" : "load IAE");
    columns = every.filter(({ id }) => controls.shows(id) && (compared || id !== "excess"));
    star.hidden = !compared || !controls.shows("excess");
    const step = job.request?.evaluate?.setpoint_step ?? 1;
    table.build(result, columns, step, (entry) => formatRoute({ screen: "design", job: job.id, entry }));
    arrange();
    table.mark(drawnNow(store.get(), result));
  }

  function showPlots(job: Job, drawn: Drawn[]): void {
    const request = job.request;
    plots.setSubject(nameOf(job));
    showEntryPlots(plots, drawn, request);
    linearNote.hidden = !hasLinear(drawn);
    const plant = job.result?.model?.plant ?? job.result?.linear_model ?? request?.plant;
    tradeoff.show(drawn, plant, unitNames(request?.units).time);
  }

  function showResult(job: Job, result: Result, workspace: Workspace): void {
    const anew = shown !== result;
    controls.setLimit(workspace.rankMs ?? result.rank_limits?.Ms ?? job.request?.evaluate?.rank_limits?.Ms ?? null);
    if (anew) {
      shown = result;
      const methods = result.controllers.filter((entry) => entry.method !== "baseline");
      const refused = methods.filter((entry) => entry.error).length;
      const answers = methods.length - refused;
      heading.textContent = `${answers} ${answers === 1 ? "tuning" : "tunings"} of this plant${refused > 0 ? `, ${refused} that ${refused === 1 ? "does" : "do"} not apply` : ""}`;
      all.hidden = asksForAll(job.request?.tune);
      rebuild();
      announce(`${heading.textContent}.`);
    }
    arrange();
    if (!anew && drawnBefore === workspace.drawn) return;
    drawnBefore = workspace.drawn;
    const drawn = drawnNow(workspace, result);
    table.mark(drawn);
    legend.replaceChildren(...drawn.map((item) => h("span", {}, swatch(item.look), item.name)));
    showPlots(job, drawn);
  }

  function show(workspace: Workspace): void {
    const job = workspace.job;
    if (workspace.jobTrouble) complain(workspace.jobTrouble);
    else trouble.hidden = true;
    title.show(job);
    const result = job?.result && (job.result.controllers?.length ?? 0) > 0 ? job.result : null;
    progress.element.hidden = !job || isFinal(job.status);
    failure.hidden = !job || !isFinal(job.status) || result !== null;
    comparison.hidden = !job || !isFinal(job.status) || result === null;
    overlay.hidden = comparison.hidden;
    if (!job) return;
    designLink.href = formatRoute({ screen: "design", job: job.id, entry: workspace.selected });
    if (!isFinal(job.status)) progress.show(job);
    else if (result) showResult(job, result, workspace);
    else showFailure(failure, job);
  }

  show(store.get());
  const leave = store.subscribe(show);
  return {
    element,
    heading: title.heading,
    dispose() {
      leave();
      plots.dispose();
      tradeoff.dispose();
    },
  };
}
