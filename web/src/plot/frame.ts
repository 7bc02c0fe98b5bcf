// What a plot shows, as plain data: charts make frames, the plot draws them. Nothing here knows the page or the subject.
import type { Range, ScaleKind } from "./axis.ts";

/** How a line looks. 1 to 4 are the series of a comparison; "data" are measured samples. */
export type Look = 1 | 2 | 3 | 4 | "data";

export interface Trace {
  name: string;
  look: Look;
  /** Thin and dotted, in the look's colour: what stands beside a line of the same look. */
  thin?: boolean;
  x: readonly (number | null)[];
  y: readonly (number | null)[];
  /** The cursor's variable where it is not x: a curve in a plane run through by a parameter. */
  parameter?: readonly number[];
  /** From that sample on it winds about the origin, turn upon turn, within that radius. */
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
      /** Its colour; the colour of what must be avoided by itself. */
      look?: Look;
      /** Its name shows while it is pointed at: for points that stand close. */
      quiet?: boolean;
      /** It can be taken and moved. */
      handle?: boolean;
    };

export type Point = Extract<Mark, { kind: "point" }>;

export interface Axis {
  kind: ScaleKind;
  /** Name with its unit, as written beside the axis. */
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
  /** One or two sentences with the main figures: the plot's text for those who do not see it. */
  description: string;
  x: Axis;
  panes: Pane[];
  /** A unit of x is as long as a unit of y. For one pane. */
  equal?: boolean;
  /** Names its own traces; else they stand in a legend that several plots share. */
  ownLegend?: boolean;
  /** Plots with the same link move their cursors together. */
  link: string;
  /** The cursor's variable with its unit, e.g. "time (s)". */
  cursorLabel: string;
  cursorKind: ScaleKind;
  /** What dragging over the plot does instead of zooming: it chooses a stretch of x. Shift and drag zooms. */
  brush?: (from: number, to: number) => void;
  /** The same subject drawn in another way, which a button shows in its place. */
  alternative?: Frame;
  /** File name of exports, without ending. */
  fileName: string;
}
