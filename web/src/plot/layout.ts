// From a frame and a size to rectangles and scales. Pure: the page and the exports share it.
import { extent, makeScale, usableRange } from "./axis.ts";
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

/** What the user zoomed to; null: everything. */
export interface View {
  x: Range | null;
  y: (Range | null)[];
}

export const wholeView = (frame: Frame): View => ({ x: null, y: frame.panes.map(() => null) });

const LEFT = 54;
const RIGHT = 14;
const TOP = 8;
const BOTTOM = 38;
const GAP = 14;

export function layoutFrame(frame: Frame, width: number, height: number, view: View): Layout {
  const innerWidth = Math.max(40, width - LEFT - RIGHT);
  const innerHeight = Math.max(40, height - TOP - BOTTOM - GAP * (frame.panes.length - 1));
  const weights = frame.panes.map((pane) => pane.weight ?? 1);
  const total = weights.reduce((sum, weight) => sum + weight, 0);
  const xRange =
    view.x ??
    frame.x.range ??
    extent(
      frame.panes.flatMap((pane) => pane.traces.map((trace) => trace.x)),
      frame.x.kind,
    );
  let top = TOP;
  const boxes = frame.panes.map((pane, index): PaneBox => {
    const paneHeight = (innerHeight * weights[index]!) / total;
    let x = usableRange(xRange[0], xRange[1], frame.x.kind);
    let y = view.y[index] ?? pane.y.range ?? dataRange(pane);
    if (frame.equal) [x, y] = equalRanges(x, y, innerWidth, paneHeight);
    const box: PaneBox = {
      pane,
      left: LEFT,
      top,
      width: innerWidth,
      height: paneHeight,
      x: makeScale(frame.x.kind, x, [LEFT, LEFT + innerWidth]),
      y: makeScale(pane.y.kind, y, [top + paneHeight, top]),
    };
    top += paneHeight + GAP;
    return box;
  });
  return { width, height, boxes };
}

function dataRange(pane: Pane): Range {
  const levels = (pane.marks ?? []).flatMap((mark) =>
    mark.kind === "level" && mark.role !== "zero" ? [mark.value] : [],
  );
  return extent([...pane.traces.map((trace) => trace.y), levels], pane.y.kind, pane.y.kind === "linear" ? 0.06 : 0.03);
}

/** Widens the narrower of two ranges about its middle until a unit is as long on both axes. */
export function equalRanges(x: Range, y: Range, width: number, height: number): [Range, Range] {
  const unitsPerPixel = Math.max((x[1] - x[0]) / width, (y[1] - y[0]) / height);
  const about = (range: Range, length: number): Range => {
    const middle = (range[0] + range[1]) / 2;
    return [middle - (unitsPerPixel * length) / 2, middle + (unitsPerPixel * length) / 2];
  };
  return [about(x, width), about(y, height)];
}
