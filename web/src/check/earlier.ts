// The last checks, to open again: jobs, and batches with a job for each loop.
import { listBatches, listJobs } from "../api/job_lists.ts";
import type { Batch, ListedJob } from "../api/types.ts";
import { h } from "../dom.ts";
import { addressOfCheck, formatRoute } from "../routes.ts";
import { verdictWords } from "../words/check.ts";
import { age, shortPlant } from "../words/job_list.ts";
import { counted } from "../words/range.ts";

const MOST = 5;

export interface EarlierCheck {
  address: string;
  name: string;
  words: string;
}

/** One for each job, and for each batch that has jobs in the list. */
export function earlierOf(jobs: readonly ListedJob[], batches: readonly Batch[], now: number): EarlierCheck[] {
  const found = new Map<string, EarlierCheck>();
  for (const job of jobs) {
    const batch = batches.find(({ id }) => id === job.batch);
    // The search looks in names too.
    if (!job.outline?.check || found.has(job.batch ?? job.id) || (job.batch && !batch)) continue;
    const { loops, verdict } = job.outline.check;
    const first = [shortPlant(job.outline), loops !== 1 && verdict && verdictWords(verdict).toLowerCase(), age(job.created_at, now)];
    found.set(
      job.batch ?? job.id,
      batch
        ? { address: addressOfCheck(batch.id, "batch"), name: batch.name || `Batch ${batch.id.slice(0, 8)}`, words: `${counted(batch.total, "loop")}, ${age(batch.created_at, now)}` }
        : { address: addressOfCheck(job.id), name: job.name || `Check ${job.id.slice(0, 8)}`, words: first.filter(Boolean).join(", ") },
    );
  }
  return [...found.values()].slice(0, MOST);
}

/** A card that is hidden while there is none. */
export function earlierChecks(): { element: HTMLElement; look(): Promise<void> } {
  const list = h("ul", { class: "batch-list" });
  const element = h(
    "section",
    { class: "card", "aria-labelledby": "earlier-checks", hidden: true },
    h("h2", { id: "earlier-checks" }, "Earlier checks"),
    list,
    h("p", { class: "actions" }, h("a", { href: formatRoute({ screen: "jobs", text: "check" }) }, "All checks")),
  );
  return {
    element,
    async look() {
      // Without the list the form still works.
      const [{ jobs }, batches] = await Promise.all([listJobs("check"), listBatches()]).catch(() => [{ jobs: [] }, []] as const);
      const checks = earlierOf(jobs, batches, Date.now());
      element.hidden = checks.length === 0;
      list.replaceChildren(
        ...checks.map(({ address, name, words }) => h("li", {}, h("a", { href: address }, name), h("span", { class: "hint" }, words))),
      );
    },
  };
}
