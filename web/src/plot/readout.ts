// The cursor: its allowed positions, its line and dots, and its figures.
import { node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";
import { extent, tickText } from "./axis.ts";
import type { Range, Scale } from "./axis.ts";
import { nearestIndex } from "./cursor.ts";
import type { Frame, Trace } from "./frame.ts";
import { freest } from "./labels.ts";
import type { Layout, PaneBox } from "./layout.ts";
import { lineOf } from "./marks.ts";

/** The cursor's range: the visible range for plain plots, the whole parameter for curves in a plane. */
export function cursorRange(frame: Frame, layout: Layout): Range {
  const parameters = frame.panes.flatMap((pane) =>
    pane.traces.flatMap((trace) => (trace.parameter ? [trace.parameter] : [])),
  );
  return parameters.length > 0 ? extent(parameters, frame.cursorKind) : layout.boxes[0]!.x.range;
}

/** Maps the cursor's range to 0..1. */
export function cursorScale(frame: Frame, [lo, hi]: Range): Pick<Scale, "toPixel" | "toValue"> {
  if (frame.cursorKind === "log") {
    return {
      toPixel: (value) => Math.log(value / lo) / Math.log(hi / lo),
      toValue: (share) => lo * (hi / lo) ** share,
    };
  }
  return { toPixel: (value) => (value - lo) / (hi - lo), toValue: (share) => lo + share * (hi - lo) };
}

/** The cursor's value for a point of the drawing; null if no curve is near. */
export function valueAt(box: PaneBox, point: { x: number; y: number }): number | null {
  const parametric = box.pane.traces.filter((trace) => trace.parameter);
  if (parametric.length > 0) return nearestOnCurve(box, parametric, point);
  return snap(box.pane.traces, box.x.toValue(point.x));
}

/** The sample of the first trace nearest to the value, of one with a name if there is any: a cursor is never between samples. */
function snap(traces: Trace[], value: number): number {
  const x = (traces.find(({ quiet }) => !quiet) ?? traces[0])?.x ?? [];
  const index = nearestIndex(x, value);
  return index < 0 ? value : x[index]!;
}

function nearestOnCurve(box: PaneBox, traces: Trace[], point: { x: number; y: number }): number | null {
  let best: number | null = null;
  let distance = 60;
  for (const trace of traces) {
    for (let index = 0; index < trace.x.length; index += 1) {
      const x = trace.x[index];
      const y = trace.y[index];
      if (typeof x !== "number" || typeof y !== "number") continue;
      const away = Math.hypot(box.x.toPixel(x) - point.x, box.y.toPixel(y) - point.y);
      if (away < distance) {
        distance = away;
        best = trace.parameter?.[index] ?? null;
      }
    }
  }
  return best;
}

const short = (value: number): string => tickText(Number(value.toPrecision(4)));

/** Name and unit of an axis: of "time (s)" "time" and "s"; without a unit "". */
export function partsOf(label: string): { name: string; unit: string } {
  const [, name = label, unit = ""] = /^(.*?)(?: \((.*)\))?$/.exec(label) ?? [];
  return { name, unit };
}

/** "time 12 s", then "name value unit" of each trace at the cursor. */
export function readings(frame: Frame, box: PaneBox, value: number): string[] {
  const { unit: ofPane } = partsOf(box.pane.y.label);
  const parts: string[] = [];
  let at: number | null = null;
  for (const trace of box.pane.traces.filter(({ quiet }) => !quiet)) {
    const list = trace.parameter ?? trace.x;
    const index = nearestIndex(list, value);
    const y = trace.y[index];
    if (index < 0 || typeof y !== "number") continue;
    at ??= list[index] ?? null;
    const x = trace.x[index];
    parts.push(
      trace.parameter && typeof x === "number"
        ? `${trace.name} ${short(x)} ${y < 0 ? "−" : "+"} ${short(Math.abs(y))}i`
        : `${trace.name} ${short(y)}${ofPane ? ` ${ofPane}` : ""}`,
    );
  }
  const { name, unit } = partsOf(frame.cursorLabel);
  return [`${name} ${short(at ?? value)}${unit ? ` ${unit}` : ""}`, ...parts];
}

export function cursorNodes(frame: Frame, box: PaneBox, value: number, figures: boolean): TreeNode[] {
  const nodes: TreeNode[] = [];
  const parametric = box.pane.traces.some((trace) => trace.parameter);
  const x = box.x.toPixel(value);
  if (!parametric) {
    if (!(x >= box.left - 1 && x <= box.left + box.width + 1)) return [];
    nodes.push(
      node("path", {
        d: `M${x} ${box.top}V${box.top + box.height}`,
        stroke: "var(--text)",
        "stroke-width": 1,
        fill: "none",
      }),
    );
  }
  for (const trace of box.pane.traces.filter(({ quiet }) => !quiet)) {
    const index = nearestIndex(trace.parameter ?? trace.x, value);
    const px = box.x.toPixel(trace.x[index] ?? NaN);
    const py = box.y.toPixel(trace.y[index] ?? NaN);
    const inside =
      px >= box.left - 1 && px <= box.left + box.width + 1 && py >= box.top - 1 && py <= box.top + box.height + 1;
    if (inside)
      nodes.push(
        node("circle", {
          cx: px,
          cy: py,
          r: 3.5,
          fill: "var(--surface)",
          "stroke-width": 2,
          stroke: lineOf(trace.look)["stroke"]!,
        }),
      );
  }
  if (figures) nodes.push(...readoutNodes(box, readings(frame, box, value)));
  return nodes;
}

const READ_PX = 6.6;
const ROW_PX = 16;

/** The figures in one line, or one below the other, in the corner where they hide the least. */
function readoutNodes(box: PaneBox, parts: string[]): TreeNode[] {
  const width = (lines: string[]): number => Math.max(...lines.map((line) => line.length * READ_PX)) + 10;
  const choices = [[parts.join(" · ")], parts]
    .filter((lines, at) => at === 0 || lines.length * ROW_PX + 6 < box.height)
    .flatMap((lines) =>
      [true, false].flatMap((top) =>
        [true, false].map((right) => {
          const size = { width: width(lines), height: lines.length * ROW_PX + 4 };
          return {
            lines,
            right,
            ...size,
            left: right ? box.left + box.width - 4 - size.width : box.left + 4,
            top: top ? box.top + 3 : box.top + box.height - 3 - size.height,
          };
        }),
      ),
    );
  const { lines, right, ...place } = choices[freest(box, choices, [])]!;
  const { left: x, top: y, width: wide, height } = place;
  const back = node("rect", { x, y, width: wide, height, fill: "var(--surface)", "fill-opacity": 0.88 });
  const texts = lines.map((line, index) =>
    node(
      "text",
      {
        x: right ? x + wide - 5 : x + 5,
        y: y + 13 + ROW_PX * index,
        "text-anchor": right ? "end" : "start",
        fill: "var(--text)",
        "font-size": 12,
      },
      line,
    ),
  );
  return [back, ...texts];
}
