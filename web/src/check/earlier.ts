// The last checks, jobs and batches: to open again, or to compare with.
import { listBatches, listJobs, newestOfBatch } from "../api/job_lists.ts";
import type { Batch, ListedJob } from "../api/types.ts";
import { h } from "../dom.ts";
import { addressOfCheck, formatRoute } from "../routes.ts";
import type { CheckedBy } from "../routes.ts";
import { verdictWords } from "../words/check.ts";
import { age, shortPlant } from "../words/job_list.ts";
import { counted } from "../words/range.ts";

const MOST = 5;

export interface EarlierCheck {
  of: CheckedBy;
  name: string;
  words: string;
}

/** A batch, and one of its jobs. */
export type BatchOfJobs = readonly [Batch, ListedJob | undefined];

export const nameOfBatch = ({ id, name }: Pick<Batch, "id" | "name">): string => name || `Batch ${id.slice(0, 8)}`;

/** A check of one loop is called after it. */
function nameOfJob({ id, name, outline }: ListedJob): string {
  const { loops, tag } = outline!.check!;
  return name || (loops === 1 && tag) || `Check ${id.slice(0, 8)}`;
}

function jobWords({ outline, created_at }: ListedJob, now: number): string {
  const { loops, verdict } = outline!.check!;
  return [shortPlant(outline), loops !== 1 && verdict && verdictWords(verdict).toLowerCase(), age(created_at, now)].filter(Boolean).join(", ");
}

/** The checks among jobs and batches, the newest first. */
export function earlierOf(jobs: readonly ListedJob[], batches: readonly BatchOfJobs[], now: number): EarlierCheck[] {
  const found = [
    // The search looks in names too.
    ...jobs
      .filter(({ outline }) => outline?.check)
      .map((job) => ({ at: job.created_at, of: { kind: "job", id: job.id } as const, name: nameOfJob(job), words: jobWords(job, now) })),
    ...batches
      .filter(([, job]) => job?.outline?.check)
      .map(([batch]) => ({ at: batch.created_at, of: { kind: "batch", id: batch.id } as const, name: nameOfBatch(batch), words: `${counted(batch.total, "loop")}, ${age(batch.created_at, now)}` })),
  ];
  return found.sort((a, b) => Date.parse(b.at) - Date.parse(a.at)).map(({ of, name, words }) => ({ of, name, words }));
}

/** Without the lists the screen still works: none then. */
export async function lastChecks(): Promise<EarlierCheck[]> {
  try {
    const [{ jobs }, batches] = await Promise.all([listJobs("check"), listBatches()]);
    const ofBatches = await Promise.all(batches.map(async (batch): Promise<BatchOfJobs> => [batch, await newestOfBatch(batch.id)]));
    return earlierOf(jobs, ofBatches, Date.now());
  } catch {
    return [];
  }
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
      const checks = (await lastChecks()).slice(0, MOST);
      element.hidden = checks.length === 0;
      list.replaceChildren(
        ...checks.map(({ of, name, words }) => h("li", {}, h("a", { href: addressOfCheck(of.id, of.kind) }, name), h("span", { class: "hint" }, words))),
      );
    },
  };
}

/** The earlier check with which a batch is compared. */
export interface BeforeChoice {
  element: HTMLElement;
  /** Batches to choose from; hidden if there is none. `since`: the name of the chosen one, which may be older than these. */
  offer(checks: readonly EarlierCheck[], chosen: string | null, since: string): void;
}

/** `onChoose`: until the comparison is there. */
export function beforeChoice(onChoose: (before: string | null) => Promise<void>): BeforeChoice {
  const select = h("select", { id: "work-before", onchange: () => void choose() });
  const busy = h("span", { class: "hint", role: "status" });
  const element = h("span", { class: "work-before", hidden: true }, h("label", { for: select.id }, "Compare with"), select, busy);

  async function choose(): Promise<void> {
    busy.textContent = "Comparing...";
    await onChoose(select.value || null);
    busy.textContent = "";
  }

  return {
    element,
    offer(checks, chosen, since) {
      const known = checks.map(({ of, name, words }) => [of.id, `${name}, ${words}`] as const);
      const older = chosen === null || known.some(([id]) => id === chosen) ? [] : [[chosen, since || "an earlier check"] as const];
      const choices = [["", "no earlier check"] as const, ...known, ...older];
      select.replaceChildren(...choices.map(([id, name]) => h("option", { value: id, selected: id === (chosen ?? "") }, name)));
      element.hidden = choices.length === 1;
    },
  };
}
