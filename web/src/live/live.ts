// The modified design: the last slider move, its newest answer, and how it is requested. No element of the page.
import { batch, computed, effect, signal } from "@preact/signals-core";
import type { ReadonlySignal } from "@preact/signals-core";
import { ApiError } from "../api/client.ts";
import { latest } from "../api/latest.ts";
import { designOf, withHeldPoints } from "../api/live.ts";
import type { Entry } from "../api/types.ts";
import { ahead } from "./ahead.ts";
import { samePoint, stepBack, stepForward, stepInPlace, stepTo } from "./point.ts";
import type { Point, Steps } from "./point.ts";
import { costOfRow, designShown, manualQuestion, manualShown, questionOf } from "./shown.ts";
import type { Shown, Modifiable } from "./shown.ts";

/** The start of the sliders: an entry of a job. */
export interface Proposal {
  from: Modifiable;
  point: Point;
}

/** The answer for a point, as shown. */
export interface Answer extends Shown {
  point: Point;
  entry: Entry;
}

export interface Live {
  /** The positions of the sliders; null before there is a proposal. */
  readonly point: ReadonlySignal<Point | null>;
  /** The newest answer; null while the proposal itself is shown. */
  readonly answer: ReadonlySignal<Answer | null>;
  /** A slider or a mark is held. */
  readonly held: ReadonlySignal<boolean>;
  /** No answer has arrived for a while. */
  readonly late: ReadonlySignal<boolean>;
  /** The design is too slow to follow a slider: it is requested on release. Its duration in ms; 0: it follows. */
  readonly waits: ReadonlySignal<number>;
  /** The reason why there is no newer answer, or "". */
  readonly trouble: ReadonlySignal<string>;
  /** The displayed design is that of the point: no newer answer is to come. */
  readonly current: ReadonlySignal<boolean>;
  readonly canUndo: ReadonlySignal<boolean>;
  readonly canRedo: ReadonlySignal<boolean>;
  readonly steps: ReadonlySignal<Steps | null>;
  /** Starts from an entry; `at`: the positions of its sliders, from the address or the steps that led there. */
  start(proposal: Proposal, at: Steps): void;
  /** There is nothing to adjust. */
  stop(): void;
  /** During a hold. */
  move(point: Point): void;
  /** The possible next points, the likeliest first. */
  expect(points: Iterable<Point>): void;
  /** Released, or a value typed: one step. `gesture`: keys of one slider that follow each other at once are one step
      together. */
  settle(point: Point, gesture?: string): void;
  undo(): void;
  redo(): void;
  /** Back to the proposal. */
  reset(): void;
  /** Asks again at once. */
  retry(): void;
  /** Waits until the point has its answer, or there is a reason why it has none. */
  settled(): Promise<void>;
  dispose(): void;
}

const LATE_MS = 150;
const RETRY_S = 2;
/** The longest pause between the keys of one gesture. */
const GESTURE_MS = 1000;
/** A design that takes longer to compute does not follow the slider. */
const LONGEST_FRAME_MS = 250;

interface Question {
  point: Point;
  held: boolean;
}

/** `onSettled`: a step was made, forward, back or to the proposal. */
export function liveDesign(onSettled: (point: Point) => void): Live {
  const proposal = signal<Proposal | null>(null);
  const steps = signal<Steps | null>(null);
  const point = signal<Point | null>(null);
  const answer = signal<Answer | null>(null);
  const held = signal(false);
  const late = signal(false);
  const trouble = signal("");
  let lastKey = { gesture: "", at: 0 };
  let lateTimer: ReturnType<typeof setTimeout> | undefined;
  let retryTimer: ReturnType<typeof setTimeout> | undefined;

  const waits = signal(0);
  /** Duration of the last design of this proposal, ms; settings by hand need no search unless they are for a
      product. */
  const cost = { design: 0, manual: 0 };
  const costs = (asked: Point): "design" | "manual" => (asked.manual ? "manual" : "design");
  const waitsFor = (asked: Point): number => {
    const ms = cost[costs(asked)];
    return ms > LONGEST_FRAME_MS ? ms : 0;
  };

  async function work({ point: asked, held: coarse }: Question, abort: AbortSignal): Promise<Shown> {
    const { from } = proposal.peek()!;
    if (!asked.manual) {
      const answer = await designOf(questionOf(from, asked.tune!, coarse), abort);
      return designShown(from, asked.tune!, answer, coarse);
    }
    const body = manualQuestion(from, asked);
    return manualShown(from, asked, await designOf(coarse ? withHeldPoints(body) : body, abort));
  }

  /** A design that does not follow the slider is not requested ahead either. */
  function* following(points: Iterable<Point>): Generator<Point> {
    for (const ahead of points) {
      if (waitsFor(ahead) > 0) return;
      yield ahead;
    }
  }

  let underWay = false;
  const next = ahead<Point, Shown>((asked, abort) => work({ point: asked, held: true }, abort), () => underWay);
  const calls = latest<Question, Shown>(
    work,
    {
      onBusy: (busy) => {
        underWay = busy;
        if (busy) return;
        expectNothing();
        next.resume();
      },
      onAnswer(shown, question) {
        const entry = shown.result.controllers[shown.index];
        if (question.held) next.keep(question.point, shown);
        cost[costs(question.point)] = shown.cost;
        expectNothing();
        if (!samePoint(question.point, point.peek()!)) expectSoon();
        batch(() => {
          trouble.value = entry?.error?.detail ?? "";
          if (entry && !entry.error) answer.value = { ...shown, point: question.point, entry };
        });
      },
      onError: fail,
    },
  );

  function fail(error: unknown): void {
    expectNothing();
    const busy = error instanceof ApiError && (error.status === 429 || error.status === 0 || error.status === 503);
    const wait = (error instanceof ApiError ? error.retryAfter : null) ?? RETRY_S;
    const sentence = error instanceof ApiError ? (error.problem.errors?.[0]?.detail ?? error.message) : String(error);
    trouble.value = busy ? `${sentence} The last plots remain; trying again in ${wait} s.` : sentence;
    clearTimeout(retryTimer);
    if (busy) retryTimer = setTimeout(() => retry(), wait * 1000);
  }

  function expectSoon(): void {
    lateTimer ??= setTimeout(() => (late.value = true), LATE_MS);
  }

  function expectNothing(): void {
    clearTimeout(lateTimer);
    lateTimer = undefined;
    late.value = false;
  }

  function ask(question: Question): void {
    clearTimeout(retryTimer);
    const start = proposal.peek()!;
    if (!question.held && samePoint(question.point, start.point)) {
      waits.value = 0;
      calls.drop();
      expectNothing();
      batch(() => {
        answer.value = null;
        trouble.value = "";
      });
      return;
    }
    const known = question.held ? next.known(question.point) : undefined;
    if (known) return calls.give(known, question);
    waits.value = question.held ? waitsFor(question.point) : 0;
    expectSoon();
    if (waits.value > 0) return;
    calls.send(question);
  }

  function retry(): void {
    if (point.peek()) ask({ point: point.peek()!, held: held.peek() });
  }

  function go(to: Steps): void {
    if (to === steps.peek()) return;
    batch(() => {
      held.value = false;
      steps.value = to;
      point.value = to.now;
    });
    ask({ point: to.now, held: false });
    onSettled(to.now);
  }

  /** Drops all calls in progress. */
  function forget(): void {
    calls.drop();
    next.drop();
    clearTimeout(retryTimer);
    expectNothing();
  }

  function standAt(from: Proposal | null, at: Steps | null): void {
    forget();
    cost.design = from ? costOfRow(from.from) : 0;
    cost.manual = 0;
    batch(() => {
      waits.value = 0;
      proposal.value = from;
      steps.value = at;
      point.value = at?.now ?? null;
      answer.value = null;
      held.value = false;
      trouble.value = "";
    });
  }

  const current = computed(() => {
    const shown = answer.value?.point ?? proposal.value?.point;
    return point.value === null || (shown !== undefined && samePoint(shown, point.value));
  });

  return {
    point,
    answer,
    current,
    held,
    late,
    waits,
    trouble,
    canUndo: computed(() => (steps.value?.past.length ?? 0) > 0),
    canRedo: computed(() => (steps.value?.future.length ?? 0) > 0),
    steps,
    start(from, { past, now: at, future }) {
      lastKey.gesture = "";
      standAt(from, { past, now: at, future });
      if (!samePoint(at, from.point)) ask({ point: at, held: false });
    },
    stop: () => standAt(null, null),
    move(to) {
      batch(() => {
        held.value = true;
        point.value = to;
      });
      ask({ point: to, held: true });
    },
    expect: (points) => next.towards(following(points)),
    settle(to, gesture = "") {
      next.towards([]);
      const before = steps.peek();
      if (!before) return;
      const goesOn = gesture !== "" && gesture === lastKey.gesture && performance.now() - lastKey.at < GESTURE_MS;
      lastKey = { gesture, at: performance.now() };
      if (samePoint(before.now, to)) {
        held.value = false;
        ask({ point: to, held: false });
      } else go(goesOn && before.past.length > 0 ? stepInPlace(before, to) : stepTo(before, to));
    },
    undo() {
      lastKey.gesture = "";
      if (steps.peek()) go(stepBack(steps.peek()!));
    },
    redo() {
      lastKey.gesture = "";
      if (steps.peek()) go(stepForward(steps.peek()!));
    },
    reset() {
      lastKey.gesture = "";
      if (steps.peek() && proposal.peek()) go(stepTo(steps.peek()!, proposal.peek()!.point));
    },
    retry,
    settled: () =>
      new Promise((resolve) => {
        const stop = effect(() => {
          if (!current.value && trouble.value === "") return;
          resolve();
          queueMicrotask(() => stop());
        });
      }),
    dispose: forget,
  };
}
