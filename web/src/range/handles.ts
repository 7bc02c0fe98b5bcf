// Handles of a schedule's rows on a plot: each a slider along the axis, for mouse, touch and keyboard.
import type { RangeTraces, ScheduleRow } from "../api/types.ts";
import { interpolate } from "../charts/rimc.ts";
import { h, setAttribute } from "../dom.ts";
import type { Layout, PaneBox } from "../plot/layout.ts";
import type { PlotHandles } from "../plot/plot.ts";
import { keyedPlace, reachOf } from "./schedule.ts";
import type { Extent } from "./schedule.ts";

export interface HandlesShown {
  rows: readonly ScheduleRow[];
  extent: Extent;
  /** The curve on which they are placed: of the first pane. */
  curve: { at: readonly number[]; value: RangeTraces["Ms"] } | null;
  /** The spoken text of each. */
  words(row: ScheduleRow, index: number): string;
}

export interface RangeHandles extends PlotHandles {
  show(shown: HandlesShown): void;
}

export interface HandleEvents {
  onHold(held: boolean): void;
  /** A row was moved to `at`; `released`: the drag has ended, or a key was used. */
  onMove(index: number, at: number, released: boolean): void;
}

export function rangeHandles(events: HandleEvents): RangeHandles {
  const layer = h("div", { class: "handles" });
  let handles: HTMLElement[] = [];
  let shown: HandlesShown | null = null;
  let box: PaneBox | null = null;
  let taken: number | null = null;

  const placeUnder = (event: PointerEvent): number =>
    box!.x.toValue(event.clientX - layer.getBoundingClientRect().left);

  function handleOf(index: number): HTMLElement {
    const handle = h("div", { class: "handle", role: "slider", tabindex: 0, "aria-label": `Handle of row ${index + 1}` });
    handle.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !box) return;
      event.preventDefault();
      handle.focus();
      handle.setPointerCapture(event.pointerId);
      taken = index;
      events.onHold(true);
    });
    handle.addEventListener("pointermove", (event) => {
      if (taken === index) events.onMove(index, placeUnder(event), false);
    });
    const release = (event: PointerEvent): void => {
      if (taken !== index) return;
      taken = null;
      events.onHold(false);
      // A touch that the browser cancels ends at the handle's place.
      events.onMove(index, event.type === "pointerup" ? placeUnder(event) : shown!.rows[index]!.at, true);
    };
    handle.addEventListener("pointerup", release);
    handle.addEventListener("pointercancel", release);
    handle.addEventListener("keydown", (event) => {
      const row = shown?.rows[index];
      if (!row || event.ctrlKey || event.metaKey || event.altKey) return;
      const to = keyedPlace(
        event.key,
        event.shiftKey,
        row.at,
        reachOf(shown!.rows, index, shown!.extent),
        shown!.extent,
      );
      if (to === null) return;
      event.preventDefault();
      events.onMove(index, to, true);
    });
    return handle;
  }

  /** On the curve; at the edge if that is unknown or not visible. */
  function heightOf(row: ScheduleRow): number {
    const at = shown?.curve ? interpolate(shown.curve.at, shown.curve.value, row.at) : null;
    const y = at === null ? box!.top : box!.y.toPixel(at);
    return Math.min(box!.top + box!.height, Math.max(box!.top, y));
  }

  function arrange(): void {
    if (!shown || !box) return;
    const at = box;
    shown.rows.forEach((row, index) => {
      const handle = handles[index]!;
      const x = at.x.toPixel(row.at);
      handle.hidden = x < at.left - 1 || x > at.left + at.width + 1;
      handle.style.left = `${x}px`;
      handle.style.top = `${heightOf(row)}px`;
    });
  }

  return {
    element: layer,
    place(layout: Layout) {
      box = layout.boxes[0] ?? null;
      arrange();
    },
    show(next) {
      shown = next;
      if (handles.length !== next.rows.length) {
        handles = next.rows.map((_, index) => handleOf(index));
        layer.replaceChildren(...handles);
      }
      next.rows.forEach((row, index) => {
        const handle = handles[index]!;
        const [lo, hi] = reachOf(next.rows, index, next.extent);
        setAttribute(handle, "aria-valuemin", String(lo));
        setAttribute(handle, "aria-valuemax", String(hi));
        setAttribute(handle, "aria-valuenow", String(row.at));
        setAttribute(handle, "aria-valuetext", next.words(row, index));
      });
      arrange();
    },
  };
}
