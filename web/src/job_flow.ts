// The job that the page follows: started, shown, replaced by another one.
import { isCheckRequest } from "./api/check.ts";
import { getJob, postJob, postJobAndWait, watchJob } from "./api/jobs.ts";
import { newest } from "./api/latest.ts";
import { isStructureRequest } from "./api/structure.ts";
import { isFinal } from "./api/types.ts";
import type { Job, TuningRequest } from "./api/types.ts";
import { byAllMethods } from "./form/tuning_request.ts";
import { addressOfCheck, addressOfJob, addressOfStructure, showsJob, stepAddress } from "./routes.ts";
import type { JobScreen, Route } from "./routes.ts";
import type { Store } from "./store.ts";

export interface JobFlow {
  /** Shows a job on that screen. */
  open(job: Job, screen?: JobScreen): void;
  /** Starts a job for this request, shown as soon as it is accepted. */
  tune(request: TuningRequest): Promise<void>;
  /** Tunes the subject of this request by every method. */
  compareAll(request: TuningRequest): Promise<void>;
  /**
   * Replaces the shown job: the screen stays, and Back leads to the previous design with its job. Throws if the entry
   * with that index gets no answer. Returns the job, null if another one has replaced it meanwhile. `onWaiting`: the
   * job while it runs, from its second second on.
   */
  retune(request: TuningRequest, index: number, onWaiting: (job: Job) => void): Promise<Job | null>;
  /** Reports the state of a job until it has ended or another one is followed. */
  follow(id: string): void;
  take(job: Job): void;
  stop(): void;
}

/** Quick designs are answered in the first call. */
const FIRST_WAIT_S = 1;
const LONGEST_WAIT_MS = 20_000;
const POLL_MS = 400;

/** The job when it has ended, or after the longest wait. */
async function ended(job: Job, onWaiting: (job: Job) => void): Promise<Job> {
  const until = Date.now() + LONGEST_WAIT_MS;
  while (!isFinal(job.status) && Date.now() < until) {
    onWaiting(job);
    await new Promise((over) => setTimeout(over, POLL_MS));
    job = await getJob(job.id);
  }
  return job;
}

/** Checks and structures have screens of their own. */
export const ownAddress = ({ id, request }: Job): string | null =>
  isCheckRequest(request) ? addressOfCheck(id) : isStructureRequest(request) ? addressOfStructure(id) : null;

export function jobFlow(store: Store): JobFlow {
  let stopWatching: (() => void) | null = null;
  const beginRetune = newest();

  function open(job: Job, screen: JobScreen = "design"): void {
    const own = ownAddress(job);
    if (own) return void (location.hash = own);
    const nothing = { selected: null, drawn: null, sort: "", rankMs: null, step: null };
    store.set((workspace) => ({ ...workspace, job, jobTrouble: "", ...nothing }));
    location.hash = addressOfJob(job.id, screen);
  }

  /** The newest call counts: results of older ones are dropped. */
  async function retune(request: TuningRequest, index: number, onWaiting: (job: Job) => void): Promise<Job | null> {
    const { route: from, step: sent } = store.get();
    const isNewest = beginRetune();
    const job = await postJobAndWait(request, FIRST_WAIT_S)
      .then((made) => ended(made, (now) => isNewest() && onWaiting(now)))
      .catch((error: unknown) => {
        if (isNewest()) throw error;
      });
    if (!job || !isNewest()) return null;
    if (job.status === "cancelled" && !job.result) throw new Error("The search was stopped; the design stays as it was.");
    const failure = job.error ?? job.result?.controllers[index]?.error;
    if (failure) throw new Error(failure.detail ?? failure.title ?? "There is no such design.");
    const now = store.get().route;
    // The same job's screen: a slider that has moved since then writes its own address.
    if (from.screen !== "design" || now.screen !== "design" || now.job !== from.job) return null;
    const { values: _modified, step: typed, ...before } = now;
    // The request has the step that was typed before it was sent.
    const step = store.get().step === sent ? null : (typed ?? null);
    const route: Route = { ...before, job: job.id, entry: index, ...(step ? { step } : {}) };
    store.set((workspace) => ({ ...workspace, route, job, selected: index, step, jobTrouble: "" }));
    stepAddress(now, before, route);
    if (!isFinal(job.status)) follow(job.id);
    return job;
  }

  function follow(id: string): void {
    stop();
    stopWatching = watchJob(id, {
      onJob: take,
      onTrouble: (sentence) => store.set((workspace) => ({ ...workspace, jobTrouble: sentence })),
    });
  }

  function take(job: Job): void {
    const own = ownAddress(job);
    if (own) return location.replace(own);
    store.set((workspace) =>
      showsJob(workspace.route) && workspace.route.job === job.id ? { ...workspace, job, jobTrouble: "" } : workspace,
    );
  }

  function stop(): void {
    stopWatching?.();
    stopWatching = null;
  }

  return {
    open,
    async tune(request) {
      open(await postJob(request));
    },
    async compareAll(request) {
      open(await postJob(byAllMethods(request)), "compare");
    },
    retune,
    follow,
    take,
    stop,
  };
}
