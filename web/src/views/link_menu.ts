// Links to a design: one to its job, which says how long it works, and one that holds the model and everything that is
// told about its loop.
import { getHealth } from "../api/records.ts";
import type { Job, TuningRequest } from "../api/types.ts";
import { closesItself, h } from "../dom.ts";
import { linkOf } from "../form/link.ts";
import { formatRoute } from "../routes.ts";
import { durationWords } from "../words/numbers.ts";
import { copyButton } from "./copy.ts";

export interface LinkMenu {
  element: HTMLElement;
  /** The displayed job, and the request of the displayed design. */
  show(job: Job, request: TuningRequest | undefined): void;
}

export function linkMenu(announce: (sentence: string) => void): LinkMenu {
  let shown: Job | null = null;
  let whole: string | null = null;
  const lasts = h("p", { class: "hint", role: "status" });
  const ofJob = copyButton({ label: "Copy link to this job", look: "quiet", text: () => location.href }, announce);
  const ofModel = copyButton(
    { label: "Copy link that holds the model", look: "quiet", text: () => whole && new URL(whole, location.href).href },
    announce,
  );
  const holds = h("p", { class: "hint" }, "It holds model, units, controller, today's settings and options, and works on every Tunewright.");
  const menu = h(
    "details",
    { class: "menu link-menu" },
    h("summary", {}, "Link"),
    h("div", { class: "menu-items" }, ofJob, lasts, ofModel, holds),
  );

  async function say(): Promise<void> {
    const job = shown;
    const health = await getHealth();
    if (job && job === shown) lasts.textContent = keptWords(job.finished_at ?? null, health?.retention_s);
  }

  menu.addEventListener("toggle", () => menu.open && void say());
  closesItself(menu);
  return {
    element: menu,
    show(job, request) {
      shown = job;
      const route = request ? linkOf(request) : null;
      whole = route && formatRoute(route);
      ofModel.hidden = holds.hidden = whole === null;
    },
  };
}

const local = (time: Date): string => time.toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });

/** `finished`: when the job ended, null before; `retention`: of jobs that succeeded, in s, 0 without limit; undefined if
    the service does not say. */
export function keptWords(finished: string | null, retention: number | undefined): string {
  if (retention === undefined) return "The link works as long as the service keeps the job.";
  if (retention === 0) return "The link works until the job is deleted; the service keeps jobs without limit.";
  const kept = `the service keeps a job for ${durationWords(retention)} after its end`;
  if (finished === null) return `The link works for a time: ${kept}.`;
  return `The link works until ${local(new Date(Date.parse(finished) + 1000 * retention))}: ${kept}.`;
}
