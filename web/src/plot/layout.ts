// Converts a frame and a size to rectangles and scales. Pure: shared by the page and the exports.
import { extent, makeScale, ticks, tickTexts, usableRange } from "./axis.ts";
import type { Range, Scale } from "./axis.ts";
import type { Frame, Pane } from "./frame.ts";

export interface PaneBox {
  pane: Pane;
  left: number;
  top: number;
  width: number;
  height: number;
  x: Scale;
  y: Scale;
}

export interface Layout {
  width: number;
  height: number;
  boxes: PaneBox[];
}

/** The user's zoom; null: everything. */
export interface View {
  x: Range | null;
  y: (Range | null)[];
}

export const wholeView = (frame: Frame): View => ({ x: null, y: frame.panes.map(() => null) });

const LEFT = 54;
/** Longer tick texts need additional room on their left. */
const USUAL_TICK_LENGTH = 4;
const TICK_GLYPH_PX = 7;
/** Between the ticks of a y axis. */
export const TICK_PX = 38;
/** Between the ticks of an x axis. */
export const X_TICK_PX = 90;
const RIGHT = 14;
const TOP = 8;
const BOTTOM = 38;
/** Between two panes. */
export const GAP = 14;

/** `atLeast`: a layout whose ranges are included in this one's, unless the user has zoomed. */
export function layoutFrame(
  frame: Frame,
  width: number,
  height: number,
  view: View,
  atLeast: Layout | null = null,
): Layout {
  const innerHeight = Math.max(40, height - TOP - BOTTOM - GAP * (frame.panes.length - 1));
  const weights = frame.panes.map((pane) => pane.weight ?? 1);
  const total = weights.reduce((sum, weight) => sum + weight, 0);
  const heights = weights.map((weight) => (innerHeight * weight) / total);
  const yRanges = frame.panes.map(
    (pane, index) =>
      view.y[index] ??
      (view.x && !frame.equal
        ? rangeWithin(pane, view.x)
        : covering(pane.y.range ?? dataRange(pane), atLeast?.boxes[index]?.y)),
  );
  const left = leftOf(frame, yRanges, heights);
  const xRange = view.x ?? covering(frame.x.range ?? dataRangeOfX(frame), atLeast?.boxes[0]?.x);
  const innerWidth = Math.max(40, width - left - rightOf(frame, xRange, width - left));
  let top = TOP;
  const boxes = frame.panes.map((pane, index): PaneBox => {
    const paneHeight = heights[index]!;
    let x = usableRange(xRange[0], xRange[1], frame.x.kind);
    let y = yRanges[index]!;
    if (frame.equal) [x, y] = equalRanges(x, y, innerWidth, paneHeight);
    const box: PaneBox = {
      pane,
      left,
      top,
      width: innerWidth,
      height: paneHeight,
      x: makeScale(frame.x.kind, x, [left, left + innerWidth]),
      y: makeScale(pane.y.kind, y, [top + paneHeight, top]),
    };
    top += paneHeight + GAP;
    return box;
  });
  return { width, height, boxes };
}

/** The width of the longest tick text, so that it does not overlap the axis name. */
function leftOf(frame: Frame, ranges: Range[], heights: number[]): number {
  const lengths = frame.panes.flatMap((pane, index) =>
    tickTexts(ticks(pane.y.kind, ranges[index]!, heights[index]! / TICK_PX)).map((text) => text.length),
  );
  return LEFT + TICK_GLYPH_PX * Math.max(0, Math.max(0, ...lengths) - USUAL_TICK_LENGTH);
}

/** Half of the last tick's text, which may be at the very end. */
function rightOf(frame: Frame, range: Range, width: number): number {
  const last = tickTexts(ticks(frame.x.kind, range, width / X_TICK_PX)).at(-1) ?? "";
  return Math.max(RIGHT, Math.ceil((TICK_GLYPH_PX * last.length) / 2));
}

const dataRangeOfX = (frame: Frame): Range =>
  extent(
    frame.panes.flatMap((pane) => pane.traces.map((trace) => trace.x)),
    frame.x.kind,
  );

/** The range, extended to the one shown before. */
const covering = (range: Range, before: Scale | undefined): Range =>
  before ? [Math.min(range[0], before.range[0]), Math.max(range[1], before.range[1])] : range;

function dataRange(pane: Pane): Range {
  const levels = (pane.marks ?? []).flatMap((mark) =>
    mark.kind === "level" && mark.role !== "zero" ? [mark.value] : [],
  );
  return extent([...pane.traces.map((trace) => trace.y), levels], pane.y.kind, pane.y.kind === "linear" ? 0.06 : 0.03);
}

/** The range of the visible samples, and one sample on both sides. */
function rangeWithin(pane: Pane, [from, to]: Range): Range {
  const inView = pane.traces.map(({ x, y }) => {
    const inside = (index: number): boolean => typeof x[index] === "number" && x[index]! >= from && x[index]! <= to;
    return y.filter((_, index) => inside(index) || inside(index - 1) || inside(index + 1));
  });
  if (inView.every((list) => list.length === 0)) return pane.y.range ?? dataRange(pane);
  return extent(inView, pane.y.kind, pane.y.kind === "linear" ? 0.06 : 0.03);
}

/** Extends the narrower of two ranges around its middle until units have the same length on both axes. */
export function equalRanges(x: Range, y: Range, width: number, height: number): [Range, Range] {
  const unitsPerPixel = Math.max((x[1] - x[0]) / width, (y[1] - y[0]) / height);
  const about = (range: Range, length: number): Range => {
    const middle = (range[0] + range[1]) / 2;
    return [middle - (unitsPerPixel * length) / 2, middle + (unitsPerPixel * length) / 2];
  };
  return [about(x, width), about(y, height)];
}
