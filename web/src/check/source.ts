// What checks the loops: a job with all of them, or a batch with a job for each. They are sent as one of the two, and both
// are followed until they have ended.
import { checkOfBatch, followCheck, getCheck, isCheckRequest, postCheck, postCheckBatch } from "../api/check.ts";
import { sentenceOf, waitAfter } from "../api/client.ts";
import { cancelBatch, getBatch, hasEnded } from "../api/job_lists.ts";
import { cancelJob } from "../api/jobs.ts";
import { maxBodyBytes } from "../api/records.ts";
import type { Batch, CheckContent, CheckJob, CheckLoop, CheckRequest, LoopCheck, Units } from "../api/types.ts";
import { isFinal } from "../api/types.ts";
import type { CheckedBy } from "../routes.ts";
import { counted } from "../words/range.ts";
import { nameOfBatch } from "./earlier.ts";
import { linesOf } from "./request.ts";
import type { CheckOrder } from "./request.ts";

/** A check as it stands. */
export interface CheckState {
  /** "": it has none. */
  name: string;
  ended: boolean;
  /** When it ended; null: not yet, or not known. */
  finished: string | null;
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
  /** Adds what has changed since an earlier batch; null: nothing. A job is not compared. */
  compare(before: string | null): Promise<void>;
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

const batchOf = ({ id }: Pick<Batch, "id">): CheckedBy => ({ kind: "batch", id });

/** As one job; as a batch if that is too long for one request, or if the file has many loops. */
export async function sendOrder(order: CheckOrder): Promise<CheckedBy> {
  if (order.kind === "file") return batchOf(await postCheckBatch(new Blob([order.csv]), "text/csv", order.options));
  const { request } = order;
  const body = new Blob([JSON.stringify(request)], { type: "application/json" });
  if (body.size <= (await maxBodyBytes())) return { kind: "job", id: (await postCheck(body)).id };
  const options: Record<string, string> = request.name ? { name: request.name } : {};
  return batchOf(await postCheckBatch(new Blob(linesOf(request)), "application/x-ndjson", options));
}

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
    finished: job.finished_at ?? null,
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
    compare: () => Promise.resolve(),
    cancel: async () => void (await cancelJob(id)),
    whole: (place) =>
      Promise.resolve({
        loop: job!.result!.loops[place]!,
        sent: job!.request?.loops[place] ?? null,
        units: job!.request?.units,
      }),
  };
}

const LOOK_AGAIN_MS = 1000;

function batchSource(id: string, { onState, onTrouble }: CheckFollower): CheckSource {
  let stopped = false;
  let found: CheckContent | null = null;
  let last: Batch | null = null;
  let before: string | null = null;

  function stateOfBatch(batch: Batch, content: CheckContent | null): CheckState {
    const { succeeded, failed, cancelled } = batch.counts;
    const done = succeeded + failed + cancelled;
    return {
      name: batch.name ?? "",
      ended: hasEnded(batch),
      finished: batch.finished_at,
      waits: false,
      fraction: batch.total === 0 ? 0 : done / batch.total,
      message: batch.status === "receiving" ? `${counted(batch.total, "loop")} read so far.` : `${done} of ${counted(batch.total, "loop")} checked.`,
      content,
      request: null,
      failure: "",
    };
  }

  /** The time to wait before the next look; null: it is over. */
  async function look(): Promise<number | null> {
    try {
      const batch = await getBatch(id);
      if (hasEnded(batch)) found = { ...(await checkOfBatch(id)), partial: batch.counts.cancelled > 0 };
      if (stopped) return null;
      last = batch;
      onTrouble("");
      onState(stateOfBatch(batch, found));
      if (found && before !== null) void addChanges(found, before);
      return hasEnded(batch) ? null : LOOK_AGAIN_MS;
    } catch (error) {
      if (!stopped) onTrouble(sentenceOf(error));
      return waitAfter(error);
    }
  }

  async function addChanges({ changes: _changes, since: _since, ...content }: CheckContent, earlier: string | null): Promise<void> {
    try {
      const [{ changes = [] }, named] = earlier === null ? [{}, null] : await Promise.all([checkOfBatch(id, earlier), getBatch(earlier)]);
      if (stopped || earlier !== before) return;
      found = named === null ? content : { ...content, changes, since: nameOfBatch(named) };
      onState(stateOfBatch(last!, found));
    } catch (error) {
      if (!stopped && earlier === before) onTrouble(sentenceOf(error));
    }
  }

  void (async () => {
    for (let wait = await look(); wait !== null && !stopped; wait = await look())
      await new Promise((over) => setTimeout(over, wait));
  })();
  return {
    stop() {
      stopped = true;
    },
    async compare(earlier) {
      if (earlier === before) return;
      before = earlier;
      if (found) await addChanges(found, earlier);
    },
    cancel: async () => void (await cancelBatch(id)),
    async whole(place) {
      const { request, result } = await getCheck(found!.loops[place]!.job!);
      const loop = result?.loops[0];
      if (!loop) throw new Error("The job of this loop has no result.");
      return { loop, sent: request?.loops[0] ?? null, units: request?.units };
    },
  };
}
