// Answers for the slider's possible next positions, requested while nothing else is: they are drawn in the frame of the
// move itself.

export interface Ahead<Question, Answer> {
  /** The answer, if it is known. */
  known(question: Question): Answer | undefined;
  keep(question: Question, answer: Answer): void;
  /** The possible next questions, the likeliest first; earlier ones are dropped. */
  towards(questions: Iterable<Question>): void;
  /** No other call is in progress. */
  resume(): void;
  /** The questions have a new meaning from now on. */
  drop(): void;
}

/** One at the service, one on its way: real calls never wait for more. */
const UNDER_WAY = 2;
/** Sufficient for two long sliders. */
const MAX_KEPT = 700;

/** `work` as for a real question; `busy`: such a question is in progress, and has priority. */
export function ahead<Question, Answer>(
  work: (question: Question, signal: AbortSignal) => Promise<Answer>,
  busy: () => boolean,
): Ahead<Question, Answer> {
  const answers = new Map<string, Answer>();
  const asked = new Set<string>();
  let wanted: Iterator<Question> | null = null;
  let running = 0;
  let calls = new AbortController();

  function keep(question: Question, answer: Answer): void {
    answers.set(JSON.stringify(question), answer);
    if (answers.size > MAX_KEPT) answers.delete(answers.keys().next().value!);
  }

  function next(): Question | null {
    for (let step = wanted?.next(); step && !step.done; step = wanted?.next()) {
      const key = JSON.stringify(step.value);
      if (!answers.has(key) && !asked.has(key)) return step.value;
    }
    wanted = null;
    return null;
  }

  function resume(): void {
    while (running < UNDER_WAY && !busy()) {
      const question = next();
      if (question === null) return;
      void ask(question);
    }
  }

  async function ask(question: Question): Promise<void> {
    const mine = calls;
    const key = JSON.stringify(question);
    asked.add(key);
    running += 1;
    try {
      const answer = await work(question, mine.signal);
      if (mine === calls) keep(question, answer);
    } catch {
      // Too many requests, or no connection: these answers are optional.
      if (mine === calls) wanted = null;
    }
    if (mine !== calls) return;
    asked.delete(key);
    running -= 1;
    resume();
  }

  return {
    known: (question) => answers.get(JSON.stringify(question)),
    keep,
    towards(questions) {
      wanted = questions[Symbol.iterator]();
      resume();
    },
    resume,
    drop() {
      calls.abort();
      calls = new AbortController();
      answers.clear();
      asked.clear();
      wanted = null;
      running = 0;
    },
  };
}
