// A batch: its progress, and a line for each of its loops, those that need attention first.
import { batchCsv, cancelBatch, getBatch, hasEnded, jobsOfBatch, postAgain } from "../api/job_lists.ts";
import type { Batch, ListedJob } from "../api/types.ts";
import { h } from "../dom.ts";
import { download } from "../plot/export.ts";
import { addressOfCheck, addressOfJob, formatRoute } from "../routes.ts";
import { batchColumns, sorted } from "../words/job_list.ts";
import type { BatchColumn } from "../words/job_list.ts";
import { orderOf, sortText } from "../words/comparison.ts";
import { jobTable, reader, troubleLine } from "./job_actions.ts";
import { reportLink } from "./report_link.ts";
import type { View } from "./start.ts";

export interface BatchEvents {
  /** Its loops were sorted: a column's id, with a minus for descending order. */
  onSort(sort: string): void;
  onBatch(batch: Batch): void;
}

/** Loops in the list; the CSV has all of them. */
const MAX_LISTED = 2000;
/** A batch of more loops is read again only when it has ended. */
const MAX_FOLLOWED = 400;
const WORDS = ["name", "plant", "method", "status"];

export function batchView(id: string, sort: string, announce: (sentence: string) => void, events: BatchEvents): View {
  let disposed = false;
  let batch: Batch | null = null;
  let jobs: ListedJob[] = [];
  let readAt = -1;
  let order = orderOf(sort || "index");
  const heading = h("h1", { tabindex: -1 }, "Batch");
  const line = troubleLine("alert");
  const { element: trouble, complain } = line;
  const counts = h("p", { role: "status" });
  const bar = h("progress", { max: 1, "aria-label": "Loops done" });
  const cancel = h("button", { type: "button", onclick: () => void work(() => cancelBatch(id)) }, "Cancel the rest");
  const again = h("button", { type: "button", onclick: () => void work(tryAgain) }, "Retry the failed jobs");
  const csv = h("button", { type: "button", onclick: () => void work(saveCsv) }, "Download CSV");
  const sheets = reportLink("Change sheets", "change-sheet.html", "batches");
  const checked = h("a", { href: addressOfCheck(id, "batch"), hidden: true }, "Work list of the loops");
  const note = h("p", { class: "hint", hidden: true });
  let columns: BatchColumn[] = [];
  let heads: { column: BatchColumn; element: HTMLElement }[] = [];
  const rows = h("tbody");
  const table = jobTable("Loops of the batch", [], rows);
  const shortcuts = [
    shortcut("gain", "Largest improvement over today"),
    shortcut("risk", "Highest risk"),
    shortcut("excess", "Farthest above the optimum"),
  ];
  const first = h("p", { class: "actions" }, "First:", shortcuts.map(({ element: button }) => button));
  const element = h(
    "main",
    { class: "jobs", id: "main" },
    heading,
    trouble,
    h(
      "section",
      { class: "card", "aria-label": "Progress" },
      counts,
      bar,
      h(
        "p",
        { class: "actions" },
        checked,
        csv,
        sheets.element,
        cancel,
        again,
        h("a", { href: formatRoute({ screen: "jobs", text: "" }) }, "All jobs"),
      ),
    ),
    h(
      "section",
      { class: "card", "aria-label": "Loops" },
      first,
      note,
      table,
    ),
  );

  function shortcut(column: string, label: string): { column: string; element: HTMLButtonElement } {
    const act = (): void => put({ column, falling: true });
    return { column, element: h("button", { type: "button", class: "quiet", onclick: act }, label) };
  }

  /** The headings are rebuilt if the loops have new columns, such as settings once the first is tuned. */
  function showHeads(): void {
    const next = batchColumns(jobs);
    const same = next.length === columns.length && next.every(({ id, label }, at) => columns[at]!.id === id && columns[at]!.label === label);
    columns = next;
    if (!same) {
      heads = columns.map((column) => {
        const button = h("button", { type: "button", class: "quiet", onclick: () => sortBy(column) }, column.label);
        return { column, element: h("th", { scope: "col" }, button) };
      });
      table.querySelector("thead tr")!.replaceChildren(...heads.map((head) => head.element));
    }
    for (const { column, element: button } of shortcuts)
      button.hidden = jobs.length > 0 && !columns.some(({ id }) => id === column);
    first.hidden = shortcuts.every(({ element: button }) => button.hidden);
  }

  async function work(act: () => Promise<void>): Promise<void> {
    trouble.hidden = true;
    await act().catch(complain);
    if (!disposed) list.look();
  }

  async function saveCsv(): Promise<void> {
    const file = await batchCsv(id);
    download(new Blob([file.text], { type: "text/csv" }), file.name || `batch-${id}.csv`);
  }

  async function tryAgain(): Promise<void> {
    const next = batch && (await postAgain(batch, jobs));
    if (next) events.onBatch(next);
    else
      complain(
        new Error(
          "None of the loops that failed can run: their lines could not be read. Correct them in the file and send it again.",
        ),
      );
  }

  function sortBy(column: BatchColumn): void {
    put({ column: column.id, falling: order.column === column.id ? !order.falling : (column.falls ?? false) });
  }

  function put(next: { column: string; falling: boolean }): void {
    order = next;
    events.onSort(sortText(order));
    showRows();
    const label = columns.find((column) => column.id === order.column)?.label ?? "Loop";
    announce(`Sorted by ${label}, ${order.falling ? "falling" : "rising"}.`);
  }

  function cell(job: ListedJob, column: BatchColumn): HTMLElement {
    const text = column.text(job);
    if (column.id === "name")
      return h(
        "th",
        { scope: "row" },
        h("a", { href: job.outline?.check ? addressOfCheck(job.id) : addressOfJob(job.id, "design") }, text),
      );
    const error =
      column.id === "status" && job.outline?.error ? h("span", { class: "hint job-error" }, job.outline.error) : null;
    return h("td", { class: WORDS.includes(column.id) ? "words" : null }, text, error);
  }

  function showRows(): void {
    showHeads();
    checked.hidden = !jobs.some(({ outline }) => outline?.check);
    if (batch) showHead(batch);
    for (const { column, element: head } of heads) {
      if (column.id === order.column) head.setAttribute("aria-sort", order.falling ? "descending" : "ascending");
      else head.removeAttribute("aria-sort");
    }
    const column = columns.find((candidate) => candidate.id === order.column) ?? columns[0]!;
    rows.replaceChildren(
      ...sorted(jobs, column, order.falling).map((job) =>
        h(
          "tr",
          {},
          columns.map((one) => cell(job, one)),
        ),
      ),
    );
    note.hidden = !batch || batch.total <= jobs.length || jobs.length === 0;
    note.textContent = `${jobs.length} of ${batch?.total ?? 0} loops are listed; the CSV has all of them.`;
  }

  function showHead(now: Batch): void {
    const { succeeded, failed, cancelled, queued, running } = now.counts;
    const parts = [
      `${succeeded} ${checked.hidden ? "tuned" : "checked"}`,
      failed && `${failed} failed`,
      cancelled && `${cancelled} cancelled`,
      running && `${running} running`,
      queued && `${queued} waiting`,
    ];
    heading.textContent = now.name || `Batch ${now.id.slice(0, 8)}`;
    document.title = `${heading.textContent} · Batch · Tunewright`;
    const words = `${now.total} ${now.total === 1 ? "loop" : "loops"}: ${parts.filter(Boolean).join(", ")}`;
    if (counts.textContent !== words) counts.textContent = words;
    bar.value = now.total === 0 ? 0 : (succeeded + failed + cancelled) / now.total;
    bar.hidden = hasEnded(now);
    cancel.hidden = hasEnded(now);
    again.hidden = !hasEnded(now) || failed + cancelled === 0;
    // A check has no settings to enter.
    sheets.show(succeeded > 0 && checked.hidden ? now.id : null, now.created_at);
  }

  async function read(): Promise<boolean> {
    const now = await getBatch(id);
    if (disposed) return false;
    batch = now;
    showHead(now);
    const done = now.counts.succeeded + now.counts.failed + now.counts.cancelled;
    if (done !== readAt && (hasEnded(now) || now.total <= MAX_FOLLOWED)) {
      const listed = await jobsOfBatch(id, MAX_LISTED);
      if (disposed) return false;
      jobs = listed;
      readAt = done;
      showRows();
    }
    return !hasEnded(now);
  }

  const list = reader(read, line);
  list.look();
  return {
    element,
    heading,
    dispose() {
      disposed = true;
      list.stop();
    },
  };
}
