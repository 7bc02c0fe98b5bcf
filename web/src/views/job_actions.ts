// What the screens of a job have in common: stopping it, comparing all methods on its plant, saying what went wrong.
import { cancelJob } from "../api/jobs.ts";
import type { Job, TuningRequest } from "../api/types.ts";
import { h } from "../dom.ts";
import type { Store } from "../store.ts";

export interface JobEvents {
  onJob(job: Job): void;
  /** Runs every method on this request's plant or record. */
  onCompareAll(request: TuningRequest): Promise<void>;
}

export interface JobActions {
  all: HTMLButtonElement;
  trouble: HTMLElement;
  complain(error: unknown): void;
  cancel(): Promise<void>;
}

export function jobActions(store: Store, events: JobEvents, look = ""): JobActions {
  const all = h("button", { type: "button", class: look, onclick: () => void compareAll() }, "Compare all methods");
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });

  function complain(error: unknown): void {
    trouble.textContent = error instanceof Error ? error.message : String(error);
    trouble.hidden = false;
  }

  async function cancel(): Promise<void> {
    const job = store.get().job;
    if (job) await cancelJob(job.id).then(events.onJob, complain);
  }

  async function compareAll(): Promise<void> {
    const request = store.get().job?.request;
    if (!request) return;
    all.disabled = true;
    await events.onCompareAll(request).catch(complain);
    all.disabled = false;
  }

  return { all, trouble, complain, cancel };
}
