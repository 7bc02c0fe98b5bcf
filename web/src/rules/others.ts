// The scores of the service's rules on the same problems, one after the other; kept as long as the page is open.
import { sentenceOf } from "../api/client.ts";
import { scoreOf } from "../api/score.ts";
import type { ScoreAnswer, ScoreRequest } from "../api/score.ts";
import type { Method } from "../api/types.ts";

export interface OtherRule {
  method: string;
  title: string;
  /** Undefined: not computed yet. */
  answer?: ScoreAnswer | undefined;
  /** Why there is no answer. */
  fault?: string | undefined;
}

export interface OtherRules {
  /** What is known of each rule on these problems. */
  known(problems: ScoreRequest["problems"]): OtherRule[];
  /** Computes what is missing; a call before is dropped. `onStep`: after each rule, and at the end. */
  compute(problems: ScoreRequest["problems"], onStep: (done: number, all: number) => void): Promise<void>;
  stop(): void;
}

/** Searches, whose designs are the optimum itself; nonlinear controllers; the rule that is scored here. */
const NOT_RULES = ["robust", "frontier", "emulation", "npid_ise", "npid_iae", "npid_itae", "formula"];

export const comparedRules = (methods: readonly Method[]): Method[] => methods.filter(({ id }) => !NOT_RULES.includes(id));

export function otherRules(methods: () => readonly Method[], score: typeof scoreOf = scoreOf): OtherRules {
  const kept = new Map<string, Pick<OtherRule, "answer" | "fault">>();
  let calls = new AbortController();
  const keyOf = (problems: ScoreRequest["problems"], id: string): string => JSON.stringify([id, problems?.name, problems?.structure, problems?.Ms]);

  const known = (problems: ScoreRequest["problems"]): OtherRule[] =>
    comparedRules(methods()).map(({ id, title }) => ({ method: id, title, ...kept.get(keyOf(problems, id)) }));

  return {
    known,
    async compute(problems, onStep) {
      calls.abort();
      const mine = (calls = new AbortController());
      const all = known(problems);
      const missing = all.filter(({ answer }) => !answer);
      let done = all.length - missing.length;
      onStep(done, all.length);
      for (const { method } of missing) {
        const request = { tune: { method }, ...(problems ? { problems } : {}) } as ScoreRequest;
        const outcome = await score(request, mine.signal).then(
          (answer) => ({ answer }),
          (error: unknown) => ({ fault: sentenceOf(error) }),
        );
        if (mine.signal.aborted) return;
        kept.set(keyOf(problems, method), outcome);
        onStep(++done, all.length);
      }
    },
    stop: () => calls.abort(),
  };
}
