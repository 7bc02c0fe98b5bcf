// A trace as a drawing of the size of a word, in the looks of the plots.
import { node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";
import { makeScale } from "./axis.ts";
import type { Range } from "./axis.ts";
import type { Trace } from "./frame.ts";
import { lineOf, tracePath } from "./marks.ts";

export interface SparkScale {
  x: Range;
  y: Range;
  /** Drawn as a thin horizontal line. */
  level: number;
}

const WIDTH = 76;
const HEIGHT = 26;
const MARGIN = 2;

/** Values outside the scale are cut off. The figures are next to it: it has no text of its own. */
export function spark(trace: Trace, scale: SparkScale): TreeNode {
  const x = makeScale("linear", scale.x, [0, WIDTH]);
  const y = makeScale("linear", scale.y, [HEIGHT - MARGIN, MARGIN]);
  const box = {
    pane: { y: { kind: "linear" as const, label: "" }, traces: [] },
    left: 0,
    top: 0,
    width: WIDTH,
    height: HEIGHT,
    x,
    y,
  };
  const { stroke } = lineOf(trace.look);
  const line = { fill: "none", "stroke-width": 1 };
  return node(
    "svg",
    { width: WIDTH, height: HEIGHT, viewBox: `0 0 ${WIDTH} ${HEIGHT}`, "aria-hidden": "true", focusable: "false" },
    node("path", { ...line, d: `M0 ${y.toPixel(scale.level).toFixed(1)}H${WIDTH}`, stroke: "var(--control)" }),
    node("path", {
      ...line,
      d: tracePath(box, trace) || "M0 0",
      stroke: stroke ?? "var(--text)",
      "stroke-width": 1.5,
      "stroke-linejoin": "round",
    }),
  );
}
