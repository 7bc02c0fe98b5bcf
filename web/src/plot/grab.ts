// What a press on a plot grabs: a handle, or a curve that can be dragged.
import type { Trace } from "./frame.ts";
import type { Layout, PaneBox } from "./layout.ts";
import { pointNear } from "./marks.ts";

export interface Place {
  x: number;
  y: number;
}

/** Pixels between a press and a handle, and between a press and a curve. */
const HANDLE_PX = 14;
const CURVE_PX = 7;
/** A finger is less exact. */
const TOUCH_FACTOR = 2;

/** Distance in pixels from a place to a curve. */
function distanceTo(box: PaneBox, { x: xs, y: ys }: Trace, place: Place): number {
  let nearest = Infinity;
  let before: Place | null = null;
  for (let index = 0; index < xs.length; index += 1) {
    const [x, y] = [xs[index], ys[index]];
    if (typeof x !== "number" || typeof y !== "number") {
      before = null;
      continue;
    }
    const at = { x: box.x.toPixel(x), y: box.y.toPixel(y) };
    nearest = Math.min(nearest, before ? distanceToPiece(before, at, place) : Math.hypot(at.x - place.x, at.y - place.y));
    before = at;
  }
  return nearest;
}

function distanceToPiece(from: Place, to: Place, place: Place): number {
  const [dx, dy] = [to.x - from.x, to.y - from.y];
  const along = dx * dx + dy * dy;
  const part = along === 0 ? 0 : Math.max(0, Math.min(1, ((place.x - from.x) * dx + (place.y - from.y) * dy) / along));
  return Math.hypot(from.x + part * dx - place.x, from.y + part * dy - place.y);
}

/** True if a press at that place of a layout grabs something. */
export function isGrab(layout: Layout, box: PaneBox, place: Place, touch: boolean): boolean {
  const factor = touch ? TOUCH_FACTOR : 1;
  if (!layout.boxes.includes(box)) return false;
  if (pointNear(box, place, factor * HANDLE_PX, (mark) => mark.handle === true)) return true;
  return box.pane.traces.some((trace) => trace.grab === true && distanceTo(box, trace, place) <= factor * CURVE_PX);
}
