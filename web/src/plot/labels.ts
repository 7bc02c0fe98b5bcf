// Places of the names of marks and of a cursor's figures: those with the fewest curves, without overlap.
import { node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";
import type { Mark, Point } from "./frame.ts";
import type { PaneBox } from "./layout.ts";

export interface Rectangle {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** About the width of a letter at 12 pixels. */
export const GLYPH_PX = 6.4;
const LINE_PX = 14;
const BASE_PX = 11;
const SMALL_CIRCLE_PX = 36;
/** The penalty of overlapping another name, in samples of curves. */
const COLLISION = 1000;

const round = (value: number): number => Math.round(value * 10) / 10;

const overlap = (a: Rectangle, b: Rectangle): boolean =>
  a.left < b.left + b.width && b.left < a.left + a.width && a.top < b.top + b.height && b.top < a.top + a.height;

/** Number of samples of the pane's curves in each rectangle. */
function samplesUnder(box: PaneBox, places: readonly Rectangle[]): number[] {
  const counts = places.map(() => 0);
  for (const trace of box.pane.traces)
    for (let index = 0; index < trace.x.length; index += 1) {
      const x = box.x.toPixel(trace.x[index] ?? NaN);
      const y = box.y.toPixel(trace.y[index] ?? NaN);
      places.forEach(({ left, top, width, height }, at) => {
        if (x >= left && x <= left + width && y >= top && y <= top + height) counts[at]! += 1;
      });
    }
  return counts;
}

/** The index of the place that hides the least; the first of equals. */
export function freest(box: PaneBox, places: readonly Rectangle[], taken: readonly Rectangle[]): number {
  const outside = ({ left, top, width, height }: Rectangle): boolean =>
    left < box.left || top < box.top || left + width > box.left + box.width || top + height > box.top + box.height;
  const costs = samplesUnder(box, places).map((samples, at) => {
    const place = places[at]!;
    const hit = taken.filter((other) => overlap(place, other)).length;
    return samples + COLLISION * (hit + (outside(place) ? 1 : 0));
  });
  return costs.indexOf(Math.min(...costs));
}

const around = (text: string, x: number, base: number, anchor: Anchor): Place => {
  const width = text.length * GLYPH_PX;
  const left = anchor === "start" ? x : anchor === "end" ? x - width : x - width / 2;
  return { x, base, anchor, left, top: base - BASE_PX, width, height: LINE_PX };
};

type Anchor = "start" | "middle" | "end";
interface Place extends Rectangle {
  x: number;
  base: number;
  anchor: Anchor;
}

/** The possible places of a mark's name, the usual one first. */
function placesOf(box: PaneBox, mark: Mark): Place[] {
  const text = mark.label ?? "";
  const right = box.left + box.width;
  switch (mark.kind) {
    case "level": {
      const line = box.y.toPixel(mark.value);
      const bases = line - box.top > 15 ? [line - 4, line + 14] : [line + 14, line - 4];
      return bases.flatMap((base) => [around(text, right - 5, base, "end"), around(text, box.left + 5, base, "start")]);
    }
    case "band":
      return [around(text, box.x.toPixel(mark.from) + 5, box.top + 14, "start")];
    case "upright": {
      const x = box.x.toPixel(mark.value);
      return [box.top + 14, box.top + box.height - 6].flatMap((base) => [
        around(text, x + 5, base, "start"),
        around(text, x - 5, base, "end"),
      ]);
    }
    case "circle": {
      // Inside the circle, where allowed curves never are; a small circle has no room for it.
      const radius = Math.abs(box.y.toPixel(mark.y + mark.radius) - box.y.toPixel(mark.y));
      const inside = radius > SMALL_CIRCLE_PX;
      const [x, y] = [box.x.toPixel(mark.x), box.y.toPixel(mark.y)];
      const above = around(text, x, y - radius + (inside ? 15 : -5), "middle");
      const below = around(text, x, y + radius + (inside ? -5 : 15), "middle");
      return mark.labelAt === "above" ? [above, below] : [below, above];
    }
    case "point": {
      const away = mark.handle ? 11 : 6;
      const [x, y] = [box.x.toPixel(mark.x), box.y.toPixel(mark.y)];
      return [y - away, y + away + BASE_PX].flatMap((base) => [
        around(text, x + away, base, "start"),
        around(text, x - away, base, "end"),
      ]);
    }
  }
}

const named = (mark: Mark): boolean => Boolean(mark.label) && !(mark.kind === "point" && mark.quiet);

function textAt(text: string, { x, base, anchor }: Place): TreeNode {
  const place = { x: round(x), y: round(base), "text-anchor": anchor };
  return node("text", { ...place, fill: "var(--text)", "font-size": 12 }, text);
}

/** The names of a pane's marks, without those of quiet ones. */
export function markLabels(box: PaneBox): TreeNode[] {
  const taken: Rectangle[] = [];
  return (box.pane.marks ?? []).filter(named).map((mark) => {
    const places = placesOf(box, mark);
    const place = places[freest(box, places, taken)]!;
    taken.push(place);
    return textAt(mark.label!, place);
  });
}

/** A point's name next to it. */
export function pointLabel(box: PaneBox, mark: Point): TreeNode {
  const places = placesOf(box, mark);
  return textAt(mark.label, places[freest(box, places, [])]!);
}
