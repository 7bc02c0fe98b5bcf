// The job that the page follows: started, shown, replaced by another one in its place.
import { postJob, postJobAndWait, watchJob } from "./api/jobs.ts";
import { newest } from "./api/latest.ts";
import { isFinal } from "./api/types.ts";
import type { Job, TuningRequest } from "./api/types.ts";
import { byAllMethods } from "./form/tuning_request.ts";
import { addressOfJob, showsJob, stepAddress } from "./routes.ts";
import type { JobScreen, Route } from "./routes.ts";
import type { Store } from "./store.ts";

export interface JobFlow {
  /** Shows a job on that screen. */
  open(job: Job, screen?: JobScreen): void;
  /** A job of this request, shown as soon as it is accepted. */
  tune(request: TuningRequest): Promise<void>;
  /** Every method on what this request is about. */
  compareAll(request: TuningRequest): Promise<void>;
  /**
   * A job in the place of the one that is shown: the screen stays, and Back leads to the design before, as its job has it.
   * Throws where the entry of that index gets no answer. Answers the job, null where another one has taken its place.
   */
  retune(request: TuningRequest, index: number): Promise<Job | null>;
  /** Reports what becomes of a job until it has ended or another one is followed. */
  follow(id: string): void;
  take(job: Job): void;
  stop(): void;
}

const LONGEST_WAIT_S = 20;

export function jobFlow(store: Store): JobFlow {
  let stopWatching: (() => void) | null = null;
  const beginRetune = newest();

  function open(job: Job, screen: JobScreen = "design"): void {
    const nothing = { selected: null, drawn: null, sort: "", rankMs: null };
    store.set((workspace) => ({ ...workspace, job, jobTrouble: "", ...nothing }));
    location.hash = addressOfJob(job.id, screen);
  }

  /** The newest one counts: what an older one comes to is told to nobody. */
  async function retune(request: TuningRequest, index: number): Promise<Job | null> {
    const from = store.get().route;
    const isNewest = beginRetune();
    const job = await postJobAndWait(request, LONGEST_WAIT_S).catch((error: unknown) => {
      if (isNewest()) throw error;
    });
    if (!job || !isNewest()) return null;
    const failure = job.error ?? job.result?.controllers[index]?.error;
    if (failure) throw new Error(failure.detail ?? failure.title ?? "There is no such design.");
    const now = store.get().route;
    // The same job's screen: a slider that has moved since writes its own address.
    if (from.screen !== "design" || now.screen !== "design" || now.job !== from.job) return null;
    const { values: _modified, ...before } = now;
    const route: Route = { ...before, job: job.id, entry: index };
    store.set((workspace) => ({ ...workspace, route, job, selected: index, jobTrouble: "" }));
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
