// Jobs: the stored jobs, to find, duplicate, repeat or delete them; batches, and a CSV of loops as a batch.
import { ApiError, sentenceOf } from "../api/client.ts";
import { deleteBatch, hasEnded, listBatches, listJobs, nextJobs, postLoops } from "../api/job_lists.ts";
import type { Batch, Job, JobList, ListedJob } from "../api/types.ts";
import { cancelJob, deleteJob, getJob, postJob } from "../api/jobs.ts";
import { isFinal } from "../api/types.ts";
import { h } from "../dom.ts";
import { parseNumber } from "../form/number.ts";
import { implementOf } from "../my_controller.ts";
import { addressOfCheck, addressOfJob, formatRoute } from "../routes.ts";
import type { Store } from "../store.ts";
import { age, methodWords, shortPlant } from "../words/job_list.ts";
import { defaultOf, robustOf } from "../words/limits.ts";
import { formatNumber } from "../words/numbers.ts";
import { jobTable, reader, troubleLine } from "./job_actions.ts";
import { reportLink } from "./report_link.ts";
import type { View } from "./start.ts";

export interface JobsEvents {
  onJob(job: Job): void;
  onBatch(batch: Batch): void;
  /** The search text, for the address. */
  onSearch(text: string): void;
}

const SEARCH_WAIT_MS = 150;
const COLUMNS = ["Name", "Plant", "Method", "Load IAE", "Ms", "Age", "Status"];

/** A button with a confirmation: the first press asks, the second one acts, and leaving it cancels the question. */
export function askingButton(label: string, spoken: string, sure: string, act: () => void): HTMLButtonElement {
  let asked = false;
  const button = h("button", { type: "button", class: "quiet", "aria-label": spoken, onclick: press }, label);
  const back = (): void => {
    asked = false;
    button.textContent = label;
    button.setAttribute("aria-label", spoken);
    button.classList.remove("danger");
  };
  function press(): void {
    if (asked) return act();
    asked = true;
    button.textContent = sure;
    button.setAttribute("aria-label", `${sure}: ${spoken}`);
    button.classList.add("danger");
  }
  button.addEventListener("blur", back);
  button.addEventListener("keydown", (event) => {
    if (event.key === "Escape") back();
  });
  return button;
}

const nameOf = (job: ListedJob): string => job.name || `Job ${job.id.slice(0, 8)}`;

export function jobsView(store: Store, text: string, announce: (sentence: string) => void, events: JobsEvents): View {
  let disposed = false;
  let next: string | null = null;
  let further: ListedJob[] = [];
  const heading = h("h1", { tabindex: -1 }, "Jobs");
  const line = troubleLine("alert");
  const { element: trouble, complain } = line;
  const search = h("input", {
    type: "text",
    value: text,
    "aria-label": "Search jobs by name, method or id",
    placeholder: "Name, method or id",
  });
  const found = h("p", { class: "hint", role: "status" });
  const rows = h("tbody");
  const heads = [...COLUMNS, "Actions"].map((name) => h("th", { scope: "col" }, name));
  const table = jobTable("List of jobs", heads, rows);
  const more = h("button", { type: "button", hidden: true, onclick: () => void showMore() }, "Older jobs");
  const batchRows = h("ul", { class: "batch-list" });
  const batches = h(
    "section",
    { class: "card", "aria-labelledby": "batches-title", hidden: true },
    h("h2", { id: "batches-title" }, "Batches"),
    batchRows,
  );
  const known = new Map<string, { text: string; element: HTMLTableRowElement }>();
  const loops = loopsCard(store, announce, events.onBatch);
  const element = h(
    "main",
    { class: "jobs", id: "main" },
    heading,
    trouble,
    h(
      "section",
      { class: "card", "aria-label": "Jobs" },
      h("div", { class: "job-search", role: "search" }, search, found),
      table,
      more,
    ),
    batches,
    loops.element,
  );

  /** Changes a job, then reads the list again. */
  async function change(work: () => Promise<void>, done: string): Promise<void> {
    trouble.hidden = true;
    try {
      await work();
      announce(done);
    } catch (error) {
      complain(error);
    }
    list.look();
  }

  async function again(job: ListedJob): Promise<void> {
    const request = (await getJob(job.id)).request;
    if (request) events.onJob(await postJob(request));
  }

  async function remove(job: ListedJob): Promise<void> {
    await deleteJob(job.id);
    further = further.filter((other) => other.id !== job.id);
    search.focus();
  }

  function actions(job: ListedJob): HTMLElement[] {
    const name = nameOf(job);
    const list: HTMLElement[] = [
      h("a", { href: formatRoute({ screen: "edit", job: job.id }), "aria-label": `Duplicate ${name}` }, "Duplicate"),
    ];
    if (job.status === "succeeded") {
      const report = reportLink();
      report.show(job.id, job.finished_at);
      report.element.setAttribute("aria-label", `Report of ${name}`);
      list.push(report.element);
    }
    const button = (label: string, work: () => Promise<void>, done: string): HTMLButtonElement =>
      h(
        "button",
        { type: "button", class: "quiet", "aria-label": `${label} ${name}`, onclick: () => void change(work, done) },
        label,
      );
    if (job.status === "failed" || job.status === "cancelled")
      list.push(button("Try again", () => again(job), `${name} runs again.`));
    if (isFinal(job.status))
      list.push(
        askingButton(
          "Delete",
          `Delete ${name}`,
          "Delete for good",
          () => void change(() => remove(job), `${name} is deleted.`),
        ),
      );
    else list.push(button("Cancel", async () => void (await cancelJob(job.id)), `${name} is cancelled.`));
    return list;
  }

  function rowOf(job: ListedJob): HTMLTableRowElement {
    const outline = job.outline;
    const error = outline?.error ? h("span", { class: "hint job-error" }, outline.error) : null;
    return h(
      "tr",
      {},
      h(
        "th",
        { scope: "row" },
        h("a", { href: outline?.check ? addressOfCheck(job.id) : addressOfJob(job.id, "design") }, nameOf(job)),
      ),
      h("td", { class: "words" }, shortPlant(outline)),
      h("td", { class: "words" }, methodWords(outline)),
      h("td", {}, formatNumber(outline?.load_IAE)),
      h("td", {}, formatNumber(outline?.Ms)),
      h("td", {}, age(job.created_at, Date.now())),
      h("td", { class: "words" }, job.status, error),
      h("td", { class: "words" }, h("div", { class: "row-actions" }, actions(job))),
    );
  }

  /** Unchanged rows stay as they are, with their focus. */
  function show(jobs: ListedJob[]): void {
    const elements = jobs.map((job) => {
      const words = JSON.stringify([job, age(job.created_at, Date.now())]);
      const before = known.get(job.id);
      if (before?.text === words) return before.element;
      const made = rowOf(job);
      known.set(job.id, { text: words, element: made });
      return made;
    });
    const same = elements.length === rows.rows.length && elements.every((row, index) => row === rows.rows[index]);
    if (!same) rows.replaceChildren(...elements);
    table.hidden = jobs.length === 0;
    more.hidden = next === null;
    const words =
      search.value.trim() === ""
        ? "There is no job yet. Start has five ways to make one."
        : `No job has "${search.value.trim()}" in its name, method or id.`;
    found.textContent =
      jobs.length === 0
        ? words
        : `${jobs.length}${next === null ? "" : " newest"} ${jobs.length === 1 ? "job" : "jobs"}`;
  }

  function showBatches(list: Batch[]): void {
    batches.hidden = list.length === 0;
    batchRows.replaceChildren(
      ...list.map((batch) => {
        const name = batch.name || `Batch ${batch.id.slice(0, 8)}`;
        const failed = batch.counts.failed > 0 ? `, ${batch.counts.failed} failed` : "";
        const ended = batch.counts.succeeded + batch.counts.failed + batch.counts.cancelled;
        return h(
          "li",
          {},
          h("a", { href: formatRoute({ screen: "batch", id: batch.id, sort: "" }) }, name),
          h(
            "span",
            { class: "hint" },
            `${ended} of ${batch.total} loops done${failed}, ${age(batch.created_at, Date.now())}`,
          ),
          hasEnded(batch)
            ? askingButton(
                "Delete",
                `Delete ${name}`,
                "Delete with all its jobs",
                () => void change(() => deleteBatch(batch.id), `${name} is deleted.`),
              )
            : null,
        );
      }),
    );
  }

  let shownBatches = "";
  async function read(): Promise<boolean> {
    const asked = search.value.trim();
    const [page, list] = await Promise.all([listJobs(asked), listBatches()]);
    if (disposed || asked !== search.value.trim()) return false;
    take(page);
    const words = JSON.stringify(list);
    if (words !== shownBatches) showBatches(list);
    shownBatches = words;
    return page.jobs.some((job) => !isFinal(job.status)) || list.some((batch) => !hasEnded(batch));
  }

  function take(page: JobList): void {
    const ids = new Set(page.jobs.map((job) => job.id));
    further = further.filter((job) => !ids.has(job.id));
    if (further.length === 0) next = page.next;
    show([...page.jobs, ...further]);
  }

  async function showMore(): Promise<void> {
    if (next === null) return;
    const page = await nextJobs(next).catch(complain);
    if (!page) return;
    next = page.next;
    further.push(...page.jobs);
    list.look();
  }

  search.addEventListener("input", () => {
    further = [];
    events.onSearch(search.value.trim());
    list.look(SEARCH_WAIT_MS);
  });
  const list = reader(read, line);
  list.look();
  return {
    element,
    heading,
    dispose() {
      disposed = true;
      loops.dispose();
      list.stop();
    },
  };
}

/** A CSV of loops, dropped here or chosen, becomes a batch. */
function loopsCard(
  store: Store,
  announce: (sentence: string) => void,
  onBatch: (batch: Batch) => void,
): Pick<View, "element" | "dispose"> {
  const method = h("select", { id: "loops-method" });
  const limit = h("input", {
    type: "text",
    id: "loops-ms",
    inputmode: "decimal",
    value: "",
    placeholder: "default",
  });
  const limitField = h("div", { class: "field" }, h("label", { for: "loops-ms" }, "Largest Ms"), limit);
  const file = h("input", {
    type: "file",
    accept: ".csv,.tsv,.txt,text/csv",
    class: "visually-hidden",
    id: "loops-file",
  });
  const fault = h("div", { class: "error", role: "alert" });
  const own = h("input", { type: "checkbox", id: "loops-own", checked: true });
  const ownName = h("span", {});
  const ownField = h("label", { class: "check", for: "loops-own", hidden: true }, own, ownName);
  const drop = h(
    "label",
    { class: "drop", for: "loops-file" },
    h("strong", {}, "Drop a CSV of loops here, or choose a file"),
    h(
      "span",
      { class: "hint" },
      "One loop per line: name, K, T, L, and today's Kp, Ti, Td if you have them. Every line is tuned; the answer is a table of settings.",
    ),
  );

  function refuse(sentence: string): void {
    fault.replaceChildren(h("p", {}, sentence));
    limit.setAttribute("aria-invalid", "true");
    file.value = "";
  }

  async function take(chosen: File | undefined): Promise<void> {
    if (!chosen) return;
    fault.replaceChildren();
    limit.removeAttribute("aria-invalid");
    const options: Record<string, string> = {
      method: method.value || "robust",
      name: chosen.name.replace(/\.\w+$/, ""),
    };
    if (method.value === "robust" && limit.value.trim() !== "") {
      // Both limits are set from the one field: its fault is shown here, once and under its label.
      const Ms = parseNumber(limit.value, "Largest Ms");
      if (!Ms.ok) return refuse(Ms.sentence);
      if (Ms.value <= 1) return refuse(`Largest Ms is ${limit.value.trim()}; it must be above 1.`);
      Object.assign(options, { Ms: String(Ms.value), Mt: String(Ms.value) });
    }
    const implement = ownField.hidden || !own.checked ? null : implementOf(store.get().mine);
    for (const [name, value] of Object.entries(implement ?? {}))
      options[`implement/${name}`] = typeof value === "string" ? value : JSON.stringify(value);
    announce(`Sending ${chosen.name}.`);
    try {
      onBatch(await postLoops(chosen, options));
    } catch (error) {
      const listed = error instanceof ApiError ? (error.problem.errors ?? []) : [];
      const faults = listed.map((item) => h("li", {}, item.detail));
      fault.replaceChildren(faults.length > 0 ? h("ul", {}, faults) : h("p", {}, sentenceOf(error)));
    }
    file.value = "";
  }

  const listMethods = (): void => {
    const chosen = method.value || "robust";
    method.replaceChildren(
      ...store.get().methods.map((item) => h("option", { value: item.id, selected: item.id === chosen }, item.title)),
    );
    const standard = defaultOf(robustOf(store.get().methods), "Ms");
    limit.placeholder = standard === null ? "default" : `default (${standard})`;
  };
  listMethods();
  const showOwn = (): void => {
    const { mine } = store.get();
    ownField.hidden = implementOf(mine) === null;
    ownName.textContent = mine ? `Design for my controller, ${mine.name}` : "";
  };
  showOwn();
  const dispose = store.subscribe((workspace, previous) => {
    if (workspace.methods !== previous.methods) listMethods();
    if (workspace.mine !== previous.mine) showOwn();
  });
  method.addEventListener("change", () => {
    limitField.hidden = method.value !== "robust";
  });
  file.addEventListener("change", () => void take(file.files?.[0]));
  const card = h(
    "section",
    { class: "card loops", "aria-labelledby": "loops-title" },
    h("h2", { id: "loops-title" }, "Many loops at once"),
    h(
      "div",
      { class: "loops-fields" },
      h("div", { class: "field" }, h("label", { for: "loops-method" }, "Method"), method),
      limitField,
      ownField,
    ),
    file,
    drop,
    fault,
  );
  for (const name of ["dragenter", "dragover"]) card.addEventListener(name, (event) => event.preventDefault());
  card.addEventListener("drop", (event) => {
    event.preventDefault();
    void take(event.dataTransfer?.files[0]);
  });
  return { element: card, dispose };
}
