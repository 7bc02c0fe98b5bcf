// A schedule that a hand moves: its rows now, the newest curves of them, and the way back to the design.
import type { RangeContent, ScheduleRow } from "../api/types.ts";
import { latest } from "../api/latest.ts";
import { designRange } from "../api/range.ts";
import type { RangeRequest } from "../api/range.ts";
import { givenRequest, movedRow, overRegion, sameRows } from "./schedule.ts";
import type { ShownRange } from "./schedule.ts";

export interface ManualSchedule {
  /** A design, and what it was asked by. */
  start(request: RangeRequest, designed: RangeContent): void;
  shown(): ShownRange | null;
  rows(): readonly ScheduleRow[];
  /** What the curves that are shown were asked by. */
  asked(): RangeRequest | null;
  move(index: number, at: number, released: boolean): void;
  change(index: number, row: ScheduleRow): void;
  back(): void;
  /** The runs across the range with the rows as they stand. */
  runAgain(): void;
}

export interface ManualScheduleEvents {
  /** A row stands elsewhere; its curves are on their way. */
  onRows(): void;
  /** Curves of the rows, or the design again; `settled`: no hand is on it. */
  onCurves(settled: boolean): void;
  onBusy(busy: boolean): void;
  onError(error: unknown): void;
}

interface Question {
  request: RangeRequest;
  settled: boolean;
}

export function manualSchedule(events: ManualScheduleEvents): ManualSchedule {
  let design: { request: RangeRequest; content: RangeContent } | null = null;
  let rows: ScheduleRow[] = [];
  let moved: RangeContent | null = null;
  let asked: RangeRequest | null = null;
  const calls = latest<Question, RangeContent>(({ request }, signal) => designRange(request, signal), {
    onBusy: events.onBusy,
    onAnswer(content, question) {
      // Runs that were made stay until the rows have moved.
      moved = content;
      asked = question.request;
      events.onCurves(question.settled);
    },
    // Under the hand the next answer mends it.
    onError(error, { settled }) {
      if (settled) events.onError(error);
    },
  });

  function ask(settled: boolean, runs = false): void {
    if (!design) return;
    const { request, content } = design;
    const send = (quick: boolean, last: boolean): void =>
      calls.send({ request: givenRequest(request, content, rows, { runs: runs && !quick, quick }), settled: last });
    const later = settled && overRegion(request);
    if (later || !settled) send(true, false);
    if (settled) send(false, true);
  }

  function restore(): void {
    calls.drop();
    events.onBusy(false);
    rows = design?.content.schedule?.rows ?? [];
    moved = null;
    asked = design?.request ?? null;
  }

  function take(next: ScheduleRow[], released: boolean): void {
    const same = sameRows(next, rows);
    rows = next;
    if (!same) events.onRows();
    if (!same || released) ask(released);
  }

  return {
    start(request, content) {
      design = { request, content };
      restore();
    },
    shown: () => (design ? { designed: design.content, moved } : null),
    rows: () => rows,
    asked: () => asked,
    move(index, at, released) {
      if (design) take(movedRow(rows, index, at, design.content.scheduling), released);
    },
    change(index, row) {
      take(
        rows.map((other, position) => (position === index ? row : other)),
        true,
      );
    },
    back() {
      restore();
      events.onRows();
      events.onCurves(true);
    },
    runAgain: () => ask(true, true),
  };
}
