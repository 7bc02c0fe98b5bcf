// Latest wins: one call under way, at most one waiting (the newest); what came between is never sent.

export interface Latest<Request> {
  send(request: Request): void;
  /** Nothing that is still on its way is reported any more. */
  drop(): void;
}

export interface LatestEvents<Request, Answer> {
  onBusy(busy: boolean): void;
  onAnswer(answer: Answer, request: Request): void;
  onError(error: unknown, request: Request): void;
}

export function latest<Request, Answer>(
  work: (request: Request) => Promise<Answer>,
  events: LatestEvents<Request, Answer>,
): Latest<Request> {
  let running = false;
  let waiting: { request: Request } | null = null;
  let epoch = 0;

  async function run(request: Request): Promise<void> {
    const mine = epoch;
    running = true;
    events.onBusy(true);
    try {
      const answer = await work(request);
      // The answer to a request that was replaced meanwhile is old.
      if (mine === epoch && !waiting) events.onAnswer(answer, request);
    } catch (error) {
      if (mine === epoch && !waiting) events.onError(error, request);
    }
    if (mine !== epoch) return;
    running = false;
    const next = waiting as { request: Request } | null;
    waiting = null;
    if (next) void run(next.request);
    else events.onBusy(false);
  }

  return {
    send(request) {
      if (running) waiting = { request };
      else void run(request);
    },
    drop() {
      epoch += 1;
      running = false;
      waiting = null;
    },
  };
}
