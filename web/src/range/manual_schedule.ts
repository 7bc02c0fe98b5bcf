// A schedule that is moved by hand: its current rows, their newest curves, and the return to the design.
import type { RangeContent, ScheduleRow } from "../api/types.ts";
import { latest } from "../api/latest.ts";
import { designRange } from "../api/range.ts";
import type { RangeRequest } from "../api/range.ts";
import { givenRequest, movedRow, overRegion, sameRows } from "./schedule.ts";
import type { ShownRange } from "./schedule.ts";

export interface ManualSchedule {
  /** A design, and its request. */
  start(request: RangeRequest, designed: RangeContent): void;
  shown(): ShownRange | null;
  rows(): readonly ScheduleRow[];
  /** The request of the shown curves. */
  asked(): RangeRequest | null;
  move(index: number, at: number, released: boolean): void;
  change(index: number, row: ScheduleRow): void;
  back(): void;
  /** Runs across the range with the current rows. */
  runAgain(): void;
}

export interface ManualScheduleEvents {
  /** A row was moved; its curves are on their way. */
  onRows(): void;
  /** Curves of the rows, or the design again; `settled`: nothing is held. */
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
      // Existing runs stay until the rows are moved.
      moved = content;
      asked = question.request;
      events.onCurves(question.settled);
    },
    // While the handle is held the next answer corrects this.
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
