// What checked the loops: a job with all of them, or a batch with a job for each. Both are followed until they have ended.
import { checkOfBatch, followCheck, getCheck, isCheckRequest } from "../api/check.ts";
import { sentenceOf, waitAfter } from "../api/client.ts";
import { cancelBatch, getBatch, hasEnded, jobsOfBatch } from "../api/job_lists.ts";
import { cancelJob } from "../api/jobs.ts";
import type { Batch, CheckContent, CheckJob, CheckLoop, CheckRequest, LoopCheck, Units } from "../api/types.ts";
import { isFinal } from "../api/types.ts";
import type { CheckedBy } from "../routes.ts";
import { counted } from "../words/range.ts";

/** A check as it stands. */
export interface CheckState {
  /** "": it has none. */
  name: string;
  ended: boolean;
  /** It waits for its turn. */
  waits: boolean;
  /** Of its loops, 0 to 1. */
  fraction: number;
  message: string;
  content: CheckContent | null;
  /** The request of a job; a batch has one for each loop. */
  request: CheckRequest | null;
  /** The reason why it ended without a work list, or "". */
  failure: string;
}

/** A loop with its curves, and as it was sent. */
export interface WholeLoop {
  loop: LoopCheck;
  sent: CheckLoop | null;
  units: Units | undefined;
}

export interface CheckSource {
  cancel(): Promise<void>;
  /** A loop by its place in the list. */
  whole(place: number): Promise<WholeLoop>;
  stop(): void;
}

export interface CheckFollower {
  onState(state: CheckState): void;
  /** Reports that the connection is lost or that it was deleted; "" when it is back. */
  onTrouble(sentence: string): void;
}

export const checkSource = ({ kind, id }: CheckedBy, follower: CheckFollower): CheckSource =>
  kind === "batch" ? batchSource(id, follower) : jobSource(id, follower);

/** The reason why a job that has ended has no work list. */
function whyNone({ request, error }: CheckJob): string {
  if (request && !isCheckRequest(request)) return "This job is not a check of loops.";
  return error?.detail ?? "The check was stopped before a loop was done.";
}

/** Another kind of job has another result. */
const contentOf = ({ result }: CheckJob): CheckContent | null => (result && "loops" in result ? result : null);

const stateOf = (job: CheckJob): CheckState => {
  const content = contentOf(job);
  const ended = isFinal(job.status);
  return {
    name: job.name ?? "",
    ended,
    waits: job.status === "queued",
    fraction: job.progress?.fraction ?? 0,
    message: job.progress?.message ?? "",
    content,
    request: job.request && isCheckRequest(job.request) ? job.request : null,
    failure: ended && !content ? whyNone(job) : "",
  };
};

function jobSource(id: string, { onState, onTrouble }: CheckFollower): CheckSource {
  let job: CheckJob | null = null;
  const take = (next: CheckJob): void => {
    job = next;
    onState(stateOf(next));
  };
  const stop = followCheck(id, { onJob: take, onProgress: (progress) => job && onState(stateOf({ ...job, progress })), onTrouble });
  return {
    stop,
    cancel: async () => void (await cancelJob(id)),
    whole: (place) =>
      Promise.resolve({
        loop: job!.result!.loops[place]!,
        sent: job!.request?.loops[place] ?? null,
        units: job!.request?.units,
      }),
  };
}

/** As many as a batch may have. */
const MOST_LOOPS = 100_000;
const LOOK_AGAIN_MS = 1000;

function batchSource(id: string, { onState, onTrouble }: CheckFollower): CheckSource {
  let stopped = false;
  let jobs: Promise<Map<number, string>> | null = null;

  function stateOfBatch(batch: Batch, content: CheckContent | null): CheckState {
    const { succeeded, failed, cancelled } = batch.counts;
    const done = succeeded + failed + cancelled;
    return {
      name: batch.name ?? "",
      ended: hasEnded(batch),
      waits: false,
      fraction: batch.total === 0 ? 0 : done / batch.total,
      message: batch.status === "receiving" ? `${counted(batch.total, "loop")} read so far.` : `${done} of ${counted(batch.total, "loop")} checked.`,
      content,
      request: null,
      failure: hasEnded(batch) && !content ? "The batch has no loop that was checked." : "",
    };
  }

  /** The time to wait before the next look; null: it is over. */
  async function look(): Promise<number | null> {
    try {
      const batch = await getBatch(id);
      const content = hasEnded(batch) ? await checkOfBatch(id) : null;
      if (stopped) return null;
      onTrouble("");
      onState(stateOfBatch(batch, content && content.loops.length > 0 ? { ...content, partial: batch.counts.cancelled > 0 } : null));
      return hasEnded(batch) ? null : LOOK_AGAIN_MS;
    } catch (error) {
      if (!stopped) onTrouble(sentenceOf(error));
      return waitAfter(error);
    }
  }

  /** Jobs by the places of their loops; listed once. */
  const jobOf = async (place: number): Promise<string | undefined> => {
    jobs ??= jobsOfBatch(id, MOST_LOOPS).then((list) => new Map(list.map((job) => [job.index ?? 0, job.id])));
    return (await jobs.catch((error: unknown) => {
      jobs = null;
      throw error;
    })).get(place);
  };

  void (async () => {
    for (let wait = await look(); wait !== null && !stopped; wait = await look())
      await new Promise((over) => setTimeout(over, wait));
  })();
  return {
    stop() {
      stopped = true;
    },
    cancel: async () => void (await cancelBatch(id)),
    async whole(place) {
      const job = await jobOf(place);
      if (job === undefined) throw new Error("The job of this loop was deleted.");
      const { request, result } = await getCheck(job);
      const loop = result?.loops[0];
      if (!loop) throw new Error("The job of this loop has no result.");
      return { loop, sent: request?.loops[0] ?? null, units: request?.units };
    },
  };
}
