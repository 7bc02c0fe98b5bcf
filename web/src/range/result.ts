// The result of a range's design: verdict, plots with the rows as handles, schedule, one setting, runs, points. The
// answer for a row is updated while it moves.
import type { RangeContent } from "../api/types.ts";
import type { RangeRequest } from "../api/range.ts";
import { plantFrame, robustnessFrame, settingsFrame } from "../charts/range.ts";
import type { RangeShown } from "../charts/range.ts";
import { h } from "../dom.ts";
import { staleMark } from "../form/errors.ts";
import { plotGrid } from "../plot/grid.ts";
import { createPlot } from "../plot/plot.ts";
import type { Plot } from "../plot/plot.ts";
import type { Store } from "../store.ts";
import { unitNames } from "../words/numbers.ts";
import { manualSchedule } from "./manual_schedule.ts";
import { rangeHandles } from "./handles.ts";
import { ownRows } from "./own_rows.ts";
import { resultCards, showRangeVerdict } from "./result_cards.ts";
import { runsCard } from "./runs_card.ts";
import { givenRequest, handleWords, sameDesign, sameRows } from "./schedule.ts";
import { scheduleCard } from "./schedule_card.ts";

export interface RangeResultView {
  element: HTMLElement;
  /** `typed`: the request in the form, if the shown one came from elsewhere. */
  show(request: RangeRequest, content: RangeContent, typed?: RangeRequest): void;
  /** With the current rows, if they were moved by hand; null if they belong to another design than the request's. */
  withMoved(request: RangeRequest): RangeRequest | null;
  /** The current verdict, for speech. */
  sentence(): string;
  clear(): void;
  /** The form was refused: the shown result belongs to the previous request. */
  setStale(stale: boolean): void;
  dispose(): void;
}

/** `onAsked`: receives the request of the shown curves. */
export function rangeResult(
  store: Store,
  announce: (sentence: string) => void,
  onAsked: (request: RangeRequest | null) => void,
): RangeResultView {
  let about: RangeRequest = {};
  let form: RangeRequest = {};
  let first: Plot | null = null;
  let held = false;
  const cards = resultCards();
  const manual = manualSchedule({
    onRows: follow,
    onCurves(settled) {
      draw();
      showMoving();
      // Parts outside the view are updated on release.
      if (!settled || held) return;
      showCards();
      announce(sentence());
    },
    onBusy: (busy) => element.toggleAttribute("data-follows", busy),
    onError: (error) => schedule.complain(error),
  });
  const handles = rangeHandles({
    onHold(now) {
      held = now;
      first?.hold(now);
      plots.hold(now);
    },
    onMove: manual.move,
  });
  const schedule = scheduleCard({ onChange: manual.change, onBack: manual.back });
  const plots = plotGrid(announce);
  const own = ownRows(store, announce);
  const runs = runsCard(announce, manual.runAgain);
  const slot = h("div", { class: "range-first" });
  const stale = staleMark(() => element);
  const element = h(
    "div",
    { class: "range-results", hidden: true },
    stale.element,
    cards.verdict,
    slot,
    h("div", { class: "range-cards" }, schedule.element, cards.one),
    own.element,
    plots.element,
    runs.element,
    cards.points,
    cards.warnings,
  );

  function drawn(): RangeShown {
    const { designed, moved } = manual.shown()!;
    return {
      designed,
      moved,
      rows: manual.rows(),
      Ms: limitOn("Ms", designed) ?? about.schedule?.Ms ?? null,
      IAE: limitOn("relative_IAE", designed) ?? null,
      units: unitNames(about.units),
    };
  }

  function draw(): void {
    const shown = drawn();
    showHandles(shown);
    const frame = robustnessFrame(shown);
    if (first) first.update(frame);
    else {
      first = createPlot(frame, announce, handles);
      first.element.classList.add("tall");
      slot.replaceChildren(first.element);
    }
    plots.show("settings", settingsFrame(shown));
    plots.show("plant", plantFrame(shown));
  }

  function showHandles(shown: RangeShown): void {
    const { curves, scheduling } = shown.moved ?? shown.designed;
    handles.show({
      rows: shown.rows,
      extent: scheduling,
      curve: curves.schedule ? { at: curves.at, value: curves.schedule.Ms } : null,
      words: (row, index) => handleWords(row, index, shown),
    });
  }

  /** Immediately, before the answer: the handle, its line, its place in the table. */
  function follow(): void {
    const shown = drawn();
    showHandles(shown);
    first?.update(robustnessFrame(shown));
    schedule.follow(shown.rows);
  }

  function showMoving(): void {
    const { designed, moved, rows, units } = drawn();
    showRangeVerdict(cards.verdict, moved ?? designed);
    schedule.show(moved ?? designed, rows, moved !== null, units);
  }

  function showCards(): void {
    const { designed, moved, units } = drawn();
    cards.show(designed, moved, units);
    const parameter = about.range?.along === "parameter" ? (about.range.parameter ?? null) : null;
    runs.show(designed, moved, parameter, units);
    showOwn();
    onAsked(manual.asked());
  }

  function showOwn(): void {
    const { designed, moved, rows, units } = drawn();
    const { schedule: held, scheduling } = moved ?? designed;
    own.show(held ? { scheduling, rows, interpolation: held.interpolation, units } : null);
  }

  const sentence = (): string => cards.verdict.textContent ?? "";

  return {
    element,
    show(request, content, typed = request) {
      about = request;
      form = typed;
      element.hidden = false;
      stale.set(false);
      manual.start(request, content);
      draw();
      showMoving();
      showCards();
    },
    withMoved(request) {
      const { designed } = manual.shown() ?? {};
      if (!designed || element.hidden) return request;
      const rows = [...manual.rows()];
      // A job may have been given its rows: like moved ones, they are not the form's design.
      const given = about.schedule?.given !== undefined || !sameRows(rows, designed.schedule?.rows ?? []);
      if (!given) return request;
      return sameDesign(request, form) ? givenRequest(request, designed, rows, { runs: true, quick: false }) : null;
    },
    sentence,
    clear() {
      element.hidden = true;
      stale.set(false);
    },
    setStale: stale.set,
    dispose() {
      first?.dispose();
      plots.dispose();
      runs.dispose();
      own.dispose();
    },
  };
}

/** The limit that the answer states. */
const limitOn = (quantity: string, { worst }: RangeContent): number | undefined =>
  [...(worst.schedule ?? []), ...(worst.one ?? [])].find((place) => place.quantity === quantity)?.limit;
