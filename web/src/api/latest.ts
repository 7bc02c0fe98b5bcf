// Latest wins: a few calls in progress, so that a slow network does not reduce the rate of answers; at most one request
// waiting (the newest); and every answer reported as it arrives unless a newer one was reported before. Requests in
// between are never sent.

export interface Latest<Request, Answer> {
  send(request: Request): void;
  /** Reports an answer that is already known; answers in progress are older. */
  give(answer: Answer, request: Request): void;
  /** Aborts all calls in progress; none of their answers is reported. */
  drop(): void;
}

export interface LatestEvents<Request, Answer> {
  onBusy(busy: boolean): void;
  onAnswer(answer: Answer, request: Request): void;
  onError(error: unknown, request: Request): void;
}

/** With a round trip of 60 ms, three calls give about 40 answers a second; a local service never gets more than one. */
const UNDER_WAY = 3;

export function latest<Request, Answer>(
  work: (request: Request, signal: AbortSignal) => Promise<Answer>,
  events: LatestEvents<Request, Answer>,
  underWay = UNDER_WAY,
): Latest<Request, Answer> {
  let waiting: { request: Request } | null = null;
  let sent = 0;
  let reported = 0;
  let running = 0;
  let calls = new AbortController();

  async function run(request: Request): Promise<void> {
    const mine = calls;
    const number = ++sent;
    running += 1;
    if (running === 1) events.onBusy(true);
    // An answer that comes after a newer one is outdated; one that comes while a newer request waits is still the best
    // available.
    const report = (tell: () => void): void => {
      if (mine !== calls || number < reported) return;
      reported = number;
      tell();
    };
    try {
      const answer = await work(request, mine.signal);
      report(() => events.onAnswer(answer, request));
    } catch (error) {
      report(() => events.onError(error, request));
    }
    if (mine !== calls) return;
    running -= 1;
    const next = waiting;
    waiting = null;
    if (next) void run(next.request);
    else if (running === 0) events.onBusy(false);
  }

  return {
    send(request) {
      if (running >= underWay) waiting = { request };
      else void run(request);
    },
    give(answer, request) {
      waiting = null;
      reported = ++sent;
      events.onAnswer(answer, request);
    },
    drop() {
      calls.abort();
      calls = new AbortController();
      running = 0;
      waiting = null;
    },
  };
}

/** For work that is not repeated: each call begins one, and returns a function that tells whether it is still the
    newest. */
export function newest(): () => () => boolean {
  let begun = 0;
  return () => {
    const mine = ++begun;
    return () => mine === begun;
  };
}
