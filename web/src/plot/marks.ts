// Converts a layout to SVG nodes. Looks are presentation attributes with colour tokens, var(--name): no class and no
// style, so the same nodes are used by the page (which follows the theme) and the exports (which insert the colours).
import { node, svgElement } from "../dom.ts";
import type { TreeNode } from "../dom.ts";
import { ticks, tickTexts } from "./axis.ts";
import { columnExtremes, drawableRuns } from "./dense.ts";
import type { Frame, Look, Mark, Point, Trace } from "./frame.ts";
import { GLYPH_PX, markLabels } from "./labels.ts";
import { GAP, TICK_PX, X_TICK_PX } from "./layout.ts";
import type { Layout, PaneBox } from "./layout.ts";

type Attributes = Record<string, string | number>;

const LINES: Record<Look, Attributes> = {
  1: { stroke: "var(--series-1)", "stroke-width": 2.2 },
  2: { stroke: "var(--series-2)", "stroke-width": 1.8, "stroke-dasharray": "6 4" },
  3: { stroke: "var(--series-3)", "stroke-width": 1.8, "stroke-dasharray": "12 3" },
  4: { stroke: "var(--series-4)", "stroke-width": 2, "stroke-dasharray": "2 3" },
  data: { stroke: "var(--muted)", "stroke-width": 1.3 },
};

const ROLES: Record<"setpoint" | "limit" | "zero", Attributes> = {
  setpoint: { stroke: "var(--setpoint)", "stroke-width": 1 },
  limit: { stroke: "var(--limit)", "stroke-width": 1.5, "stroke-dasharray": "3 3" },
  zero: { stroke: "var(--control)", "stroke-width": 1 },
};

const THIN: Attributes = { "stroke-width": 1.3, "stroke-dasharray": "1 3", "stroke-linecap": "round" };

export const lineOf = (look: Look, thin = false): Attributes => (thin ? { ...LINES[look], ...THIN } : LINES[look]);

const FONT = { "font-size": 12 };
const FAR = 20000;
/** Below this radius the turns of a curve around the origin cannot be distinguished. */
const SMEARED_PX = 90;

const round = (value: number): number => Math.round(value * 10) / 10;

/** Everything except the cursor. `clip` makes ids of clip paths unique in the document. */
export function drawLayout(frame: Frame, layout: Layout, clip: string): TreeNode[] {
  return layout.boxes.flatMap((box, index) =>
    drawBox(frame, box, `${clip}-${index}`, index === layout.boxes.length - 1),
  );
}

function drawBox(frame: Frame, box: PaneBox, clip: string, last: boolean): TreeNode[] {
  const inside = { "clip-path": `url(#${clip})` };
  const marks = box.pane.marks ?? [];
  const frameRect = { x: box.left, y: round(box.top), width: round(box.width), height: round(box.height) };
  return [
    node("clipPath", { id: clip }, node("rect", frameRect)),
    node("g", {}, ...drawGrid(box)),
    node("g", inside, ...marks.flatMap((mark) => drawMark(box, mark))),
    node("g", inside, ...box.pane.traces.flatMap((trace) => drawTrace(box, trace))),
    node("rect", { ...frameRect, fill: "none", stroke: "var(--control)" }),
    node("g", inside, ...markLabels(box)),
    node("g", { fill: "var(--muted)", ...FONT }, ...drawTickTexts(box, last), ...drawAxisNames(frame, box, last)),
  ];
}

function axisTicks(box: PaneBox): { x: number[]; y: number[] } {
  return {
    x: ticks(box.x.kind, box.x.range, box.width / X_TICK_PX),
    y: ticks(box.y.kind, box.y.range, box.height / TICK_PX),
  };
}

function drawGrid(box: PaneBox): TreeNode[] {
  const { x, y } = axisTicks(box);
  const right = round(box.left + box.width);
  const bottom = round(box.top + box.height);
  const path =
    x.map((value) => `M${round(box.x.toPixel(value))} ${round(box.top)}V${bottom}`).join("") +
    y.map((value) => `M${box.left} ${round(box.y.toPixel(value))}H${right}`).join("");
  const grid = node("path", { d: path || "M0 0", fill: "none", stroke: "var(--grid)" });
  const zero = box.y.kind === "linear" && box.y.range[0] < 0 && box.y.range[1] > 0;
  return zero
    ? [grid, node("path", { d: `M${box.left} ${round(box.y.toPixel(0))}H${right}`, fill: "none", ...ROLES.zero })]
    : [grid];
}

/** The height of a tick's digits. */
const DIGIT_PX = 11;

const isDecade = (value: number): boolean => Number.isInteger(Number(Math.log10(value).toFixed(9)));

/** The ticks of a y axis whose texts do not overlap: of a logarithmic one first the powers of ten. */
export function legibleTicks({ y: scale }: Pick<PaneBox, "y">, values: readonly number[]): number[] {
  const first = scale.kind === "log" ? values.filter(isDecade) : [];
  const taken: number[] = [];
  for (const value of [...first, ...values.filter((other) => !first.includes(other))])
    if (taken.every((other) => Math.abs(scale.toPixel(other) - scale.toPixel(value)) >= DIGIT_PX)) taken.push(value);
  return values.filter((value) => taken.includes(value));
}

function drawTickTexts(box: PaneBox, last: boolean): TreeNode[] {
  const { x, y } = axisTicks(box);
  const bottom = box.top + box.height;
  const yTexts = tickTexts(y);
  const texts: TreeNode[] = legibleTicks(box, y).map((value) =>
    node("text", { x: box.left - 6, y: round(box.y.toPixel(value) + 4), "text-anchor": "end" }, yTexts[y.indexOf(value)]!),
  );
  if (!last) return texts;
  let free = -Infinity;
  const below = tickTexts(x);
  for (const [index, value] of x.entries()) {
    const at = box.x.toPixel(value);
    const half = below[index]!.length * 3.4;
    if (at - half < free) continue;
    free = at + half + 6;
    texts.push(node("text", { x: round(at), y: round(bottom + 16), "text-anchor": "middle" }, below[index]!));
  }
  return texts;
}

/** The name of a y axis, without its unit if both are longer than the pane and would run into the next. */
export function axisName({ pane, height }: Pick<PaneBox, "pane" | "height">): string {
  const { label } = pane.y;
  return label.length * GLYPH_PX > height + GAP ? label.replace(/ \(.*\)$/, "") : label;
}

function drawAxisNames(frame: Frame, box: PaneBox, last: boolean): TreeNode[] {
  const middle = round(box.top + box.height / 2);
  const names = [
    node(
      "text",
      { x: 0, y: 0, transform: `translate(13 ${middle}) rotate(-90)`, "text-anchor": "middle" },
      axisName(box),
    ),
  ];
  if (last)
    names.push(
      node(
        "text",
        { x: round(box.left + box.width / 2), y: round(box.top + box.height + 33), "text-anchor": "middle" },
        frame.x.label,
      ),
    );
  return names;
}

const lengthX = (box: PaneBox, units: number): number => Math.abs(box.x.toPixel(units) - box.x.toPixel(0));

/** Turns around the origin that cannot be distinguished; they are drawn after zooming in. */
function smeared(box: PaneBox, trace: Trace): { from: number; radius: number } | null {
  const { winding } = trace;
  return winding && lengthX(box, winding.radius) < SMEARED_PX ? winding : null;
}

/** The path of a trace in pixels; for long traces the extremes of each pixel column. */
export function tracePath(box: PaneBox, trace: Trace): string {
  const near = (pixel: number): number => Math.max(-FAR, Math.min(FAR, pixel));
  const last = smeared(box, trace)?.from ?? Infinity;
  let path = "";
  for (const [first, end] of drawableRuns(trace.x, trace.y, box.x.kind === "log", box.y.kind === "log")) {
    const xs: number[] = [];
    const ys: number[] = [];
    for (let index = first; index <= Math.min(end, last); index += 1) {
      xs.push(near(box.x.toPixel(trace.x[index]!)));
      ys.push(near(box.y.toPixel(trace.y[index]!)));
    }
    const dense = !trace.parameter && xs.length > 4 * box.width;
    const kept = dense ? columnExtremes(xs.map(Math.floor), ys) : xs.map((_, index) => index);
    path += kept
      .map((index, position) => `${position === 0 ? "M" : "L"}${round(xs[index]!)} ${round(ys[index]!)}`)
      .join("");
  }
  return path;
}

function drawTrace(box: PaneBox, trace: Trace): TreeNode[] {
  const line = lineOf(trace.look, trace.thin);
  const path = node("path", { d: tracePath(box, trace) || "M0 0", fill: "none", "stroke-linejoin": "round", ...line });
  const winding = smeared(box, trace);
  if (!winding) return [path];
  const disc = {
    cx: round(box.x.toPixel(0)),
    cy: round(box.y.toPixel(0)),
    r: round(lengthX(box, winding.radius)),
    fill: String(line["stroke"]),
    "fill-opacity": 0.14,
  };
  return [node("circle", disc), path];
}

function drawMark(box: PaneBox, mark: Mark): TreeNode[] {
  switch (mark.kind) {
    case "level": {
      const y = round(box.y.toPixel(mark.value));
      return [
        node("path", { d: `M${box.left} ${y}H${round(box.left + box.width)}`, fill: "none", ...ROLES[mark.role] }),
      ];
    }
    case "upright": {
      const x = round(box.x.toPixel(mark.value));
      return [
        node("path", {
          d: `M${x} ${round(box.top)}V${round(box.top + box.height)}`,
          fill: "none",
          ...ROLES[mark.role],
        }),
      ];
    }
    case "band": {
      const [from, to] = [box.x.toPixel(mark.from), box.x.toPixel(mark.to)];
      const edge = (x: number): string => `M${round(x)} ${round(box.top)}V${round(box.top + box.height)}`;
      return [
        node("rect", {
          x: round(Math.min(from, to)),
          y: round(box.top),
          width: round(Math.abs(to - from)),
          height: round(box.height),
          fill: "var(--accent)",
          "fill-opacity": 0.07,
        }),
        node("path", { d: edge(from) + edge(to), fill: "none", stroke: "var(--accent)", "stroke-width": 1.5 }),
      ];
    }
    case "circle": {
      const radius = Math.abs(box.x.toPixel(mark.x + mark.radius) - box.x.toPixel(mark.x));
      const centre = { cx: round(box.x.toPixel(mark.x)), cy: round(box.y.toPixel(mark.y)), r: round(radius) };
      return [node("circle", { ...centre, fill: "var(--limit)", "fill-opacity": 0.07, ...ROLES.limit })];
    }
    case "point":
      return [
        node("circle", {
          cx: round(box.x.toPixel(mark.x)),
          cy: round(box.y.toPixel(mark.y)),
          r: mark.handle ? 7 : 3.5,
          fill: mark.look ? String(LINES[mark.look].stroke) : "var(--bad)",
          ...(mark.quiet ? { "fill-opacity": 0.55 } : {}),
          ...(mark.handle ? { stroke: "var(--surface)", "stroke-width": 2 } : {}),
        }),
      ];
  }
}

/** The nearest suitable point of a pane within a distance of a place in pixels. */
export function pointNear(
  box: PaneBox,
  place: { x: number; y: number },
  reach: number,
  qualifies: (mark: Point) => boolean,
): Point | null {
  const distance = (mark: Point): number =>
    Math.hypot(box.x.toPixel(mark.x) - place.x, box.y.toPixel(mark.y) - place.y);
  const near = (box.pane.marks ?? [])
    .filter((mark): mark is Point => mark.kind === "point" && qualifies(mark))
    .filter((mark) => distance(mark) <= reach)
    .sort((a, b) => distance(a) - distance(b));
  return near[0] ?? null;
}

/** A short piece of a series' line, for legends and table headings. */
export function swatch(look: Look, thin = false): Element {
  const line = node("path", { d: "M1 5H27", fill: "none", ...lineOf(look, thin) });
  return svgElement(
    node("svg", { width: 28, height: 10, viewBox: "0 0 28 10", "aria-hidden": "true", focusable: "false" }, line),
  );
}
