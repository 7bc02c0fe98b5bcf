// Common parts of a job's screens: stopping it, comparing all methods on its plant, showing errors.
import { sentenceOf, waitAfter } from "../api/client.ts";
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

/** The line of a screen for errors. */
export interface TroubleLine {
  element: HTMLElement;
  complain(error: unknown): void;
}

export function troubleLine(role: "status" | "alert"): TroubleLine {
  const element = h("p", { class: "trouble", role, hidden: true });
  return {
    element,
    complain(error) {
      element.textContent = sentenceOf(error);
      element.hidden = false;
    },
  };
}

const LOOK_AGAIN_MS = 1000;

export interface Reader {
  /** Reads now, or after this number of milliseconds; an earlier plan is dropped. */
  look(wait?: number): void;
  stop(): void;
}

/** Reads a list again while it changes (`read` returns that), and after a failure until it succeeds: the line shows
    the failure meanwhile. */
export function reader(read: () => Promise<boolean>, trouble: TroubleLine): Reader {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let round = 0;
  let lost = "";

  async function step(mine: number): Promise<void> {
    let wait: number | null = null;
    try {
      if (await read()) wait = LOOK_AGAIN_MS;
      // An error of another action stays visible.
      if (lost !== "" && trouble.element.textContent === lost) trouble.element.hidden = true;
      lost = "";
    } catch (error) {
      if (mine !== round) return;
      trouble.complain(error);
      lost = trouble.element.textContent ?? "";
      wait = waitAfter(error);
    }
    if (mine === round && wait !== null) look(wait);
  }

  function look(wait = 0): void {
    clearTimeout(timer);
    const mine = ++round;
    if (wait === 0) void step(mine);
    else timer = setTimeout(() => void step(mine), wait);
  }

  return {
    look,
    stop() {
      clearTimeout(timer);
      round = -1;
    },
  };
}

/** A table with a line for each job, which scrolls on its own if it is wide. */
export function jobTable(label: string, heads: HTMLElement[], rows: HTMLElement): HTMLElement {
  const table = h("table", { class: "figures job-list" }, h("thead", {}, h("tr", {}, heads)), rows);
  return h("div", { class: "scroll", role: "region", "aria-label": label, tabindex: 0 }, table);
}

/** `displayed`: the request of what is on the screen, if that is not the job's own. */
export function jobActions(
  store: Store,
  events: JobEvents,
  look = "",
  displayed: () => TuningRequest | undefined = () => undefined,
): JobActions {
  const all = h("button", { type: "button", class: look, onclick: () => void compareAll() }, "Compare all methods");
  const { element: trouble, complain } = troubleLine("status");

  async function cancel(): Promise<void> {
    const job = store.get().job;
    if (job) await cancelJob(job.id).then(events.onJob, complain);
  }

  async function compareAll(): Promise<void> {
    const request = displayed() ?? store.get().job?.request;
    if (!request) return;
    all.disabled = true;
    await events.onCompareAll(request).catch(complain);
    all.disabled = false;
  }

  return { all, trouble, complain, cancel };
}
