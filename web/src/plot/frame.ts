// The content of a plot as plain data: charts make frames, the plot draws them. Independent of the page and the
// subject.
import type { Range, ScaleKind } from "./axis.ts";

/** The look of a line. 1 to 4 are the series of a comparison; "data" are measured samples. */
export type Look = 1 | 2 | 3 | 4 | "data";

/** A grabbed place was dragged to a point, in the axes' units; `released`: the drag has ended; `from`: where it began. */
export type OnDrag = (to: { x: number; y: number }, released: boolean, from: { x: number; y: number }) => void;

export interface Trace {
  name: string;
  look: Look;
  /** It can be grabbed anywhere, if the frame can be dragged. */
  grab?: boolean;
  /** Thin and dotted, in the look's colour: a companion of a line with the same look. */
  thin?: boolean;
  /** One among many: without a name in the legend and at the cursor; table and exports have it. */
  quiet?: boolean;
  x: readonly (number | null)[];
  y: readonly (number | null)[];
  /** The cursor's variable if it is not x: a parametric curve in a plane. */
  parameter?: readonly number[];
  /** From that sample on it winds around the origin, turn after turn, within that radius. */
  winding?: { from: number; radius: number };
}

export type Mark =
  | { kind: "level"; value: number; label?: string; role: "setpoint" | "limit" | "zero" }
  | { kind: "upright"; value: number; label?: string; role: "setpoint" | "limit" | "zero" }
  | { kind: "band"; from: number; to: number; label?: string }
  | { kind: "circle"; x: number; y: number; radius: number; label: string; labelAt: "above" | "below" }
  | {
      kind: "point";
      x: number;
      y: number;
      label: string;
      /** Its colour; by default the colour of a forbidden region. */
      look?: Look;
      /** Its name is shown only under the pointer: for points that are close together. */
      quiet?: boolean;
      /** It can be dragged. */
      handle?: boolean;
    };

export type Point = Extract<Mark, { kind: "point" }>;

export interface Axis {
  kind: ScaleKind;
  /** Name with its unit, as written next to the axis. */
  label: string;
  /** The range to show first; taken from the data if absent. */
  range?: Range;
}

export interface Pane {
  y: Axis;
  traces: Trace[];
  marks?: Mark[];
  /** Share of the height, 1 by default. */
  weight?: number;
}

export interface Frame {
  title: string;
  /** Whose data these are, such as the loop's name: a part of the titles and names of files. */
  subject?: string;
  /** One or two sentences with the main figures: the plot's text for readers who do not see it. */
  description: string;
  x: Axis;
  panes: Pane[];
  /** The units of x and y have the same length. For plots with one pane. */
  equal?: boolean;
  /** Has a legend of its own; otherwise several plots share one. */
  ownLegend?: boolean;
  /** Plots with the same link share their cursor. */
  link: string;
  /** The cursor's variable with its unit, e.g. "time (s)". */
  cursorLabel: string;
  cursorKind: ScaleKind;
  /** Dragging over the plot chooses a range of x instead of zooming. Shift and drag zooms. */
  brush?: (from: number, to: number) => void;
  /** Its handles, and the curves that can be grabbed, are dragged. */
  drag?: OnDrag;
  /** Another view of the same subject, which a button shows instead. */
  alternative?: Frame;
  /** File name of exports, without ending. */
  fileName: string;
}
