// The last checks, to open again.
import { listJobs } from "../api/job_lists.ts";
import type { ListedJob } from "../api/types.ts";
import { h } from "../dom.ts";
import { addressOfCheck, formatRoute } from "../routes.ts";
import { verdictWords } from "../words/check.ts";
import { age, shortPlant } from "../words/job_list.ts";

const MOST = 5;

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

  function item(job: ListedJob): HTMLElement {
    const { verdict } = job.outline?.check ?? {};
    const words = [shortPlant(job.outline), verdict && verdictWords(verdict).toLowerCase(), age(job.created_at, Date.now())];
    return h(
      "li",
      {},
      h("a", { href: addressOfCheck(job.id) }, job.name || `Check ${job.id.slice(0, 8)}`),
      h("span", { class: "hint" }, words.filter(Boolean).join(", ")),
    );
  }

  return {
    element,
    async look() {
      // The search looks in names too.
      const { jobs } = await listJobs("check").catch(() => ({ jobs: [] }));
      const checks = jobs.filter(({ outline }) => outline?.check).slice(0, MOST);
      element.hidden = checks.length === 0;
      list.replaceChildren(...checks.map(item));
    },
  };
}
