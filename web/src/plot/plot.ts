// One plot on the page: stacked panes over one x axis, with cursor, zoom, keys, data table and exports.
import { h, node, svgElement, uniqueId } from "../dom.ts";
import { extent } from "./axis.ts";
import type { Range, Scale } from "./axis.ts";
import { joinLink, moveCursor, nearestIndex } from "./cursor.ts";
import type { CursorPosition } from "./cursor.ts";
import { dataTable } from "./data_table.ts";
import { download, exportHeight, frameToCsv, frameToSvg, lightPalette, svgToPng } from "./export.ts";
import type { Frame, Trace } from "./frame.ts";
import { layoutFrame, wholeView } from "./layout.ts";
import type { Layout, PaneBox, View } from "./layout.ts";
import { drawLayout, lineOf, tickText } from "./marks.ts";
import { zoomAbout, zoomToRectangle } from "./zoom.ts";

export interface Plot {
  element: HTMLElement;
  update(frame: Frame): void;
  dispose(): void;
}

/** Says a sentence to those who cannot see the plot. */
export type Announce = (sentence: string) => void;

const KEYS = "Arrow keys move the cursor, with Shift in bigger steps; plus and minus zoom; 0 shows everything; T shows the data as a table.";
const DRAG_MIN_PX = 6;

export function createPlot(first: Frame, announce: Announce): Plot {
  let frame = first;
  let view = wholeView(frame);
  let layout: Layout = layoutFrame(frame, 480, 300, view);
  let cursor: CursorPosition = { value: null, source: null };
  const self = {};
  const clip = uniqueId("pane");

  const title = h("h3", { id: uniqueId("plot-title") }, frame.title);
  const description = h("p", { class: "visually-hidden", id: uniqueId("plot-text") });
  const drawing = svgElement(node("g"));
  const overlay = svgElement(node("g", { "pointer-events": "none" }));
  const svg = svgElement(
    node("svg", { role: "img", tabindex: 0, "aria-labelledby": title.id, "aria-describedby": description.id, class: "canvas" }),
  ) as unknown as SVGSVGElement;
  svg.append(drawing, overlay);

  const table = h("div", { class: "data-table", tabindex: 0, role: "region", "aria-label": `Data of ${frame.title}`, hidden: true });
  const tableButton = h("button", { type: "button", class: "quiet", "aria-expanded": "false", onclick: () => toggleTable() }, "Table", h("span", { class: "visually-hidden" }, ` of ${frame.title}`));
  const resetButton = h("button", { type: "button", class: "quiet", hidden: true, onclick: () => setView(wholeView(frame)) }, "Show all");
  const exportMenu = h(
    "details",
    { class: "menu" },
    h("summary", {}, "Export", h("span", { class: "visually-hidden" }, ` ${frame.title}`)),
    h(
      "div",
      { class: "menu-items" },
      h("button", { type: "button", onclick: () => save("svg") }, "SVG"),
      h("button", { type: "button", onclick: () => save("png") }, "PNG"),
      h("button", { type: "button", onclick: () => save("csv") }, "CSV"),
    ),
  );
  exportMenu.addEventListener("focusout", (event) => {
    if (!(event.relatedTarget instanceof Node && exportMenu.contains(event.relatedTarget))) exportMenu.open = false;
  });
  exportMenu.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    exportMenu.open = false;
    exportMenu.querySelector("summary")?.focus();
  });
  const element = h(
    "section",
    { class: "card plot", "aria-labelledby": title.id },
    h("header", {}, title, h("div", { class: "tools" }, resetButton, tableButton, exportMenu)),
    description,
    svg,
    h("p", { class: "keys", "aria-hidden": "true" }, "← → cursor   + − zoom   0 all   T table"),
    table,
  );
  table.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    toggleTable();
    svg.focus();
  });

  function draw(): void {
    const box = svg.getBoundingClientRect();
    const width = Math.max(200, Math.round(box.width) || 480);
    const height = Math.max(140, Math.round(box.height) || 300);
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    layout = layoutFrame(frame, width, height, view);
    drawing.replaceChildren(...drawLayout(frame, layout, clip).map(svgElement));
    resetButton.hidden = view.x === null && view.y.every((range) => range === null);
    drawCursor();
  }

  function drawCursor(): void {
    const value = cursor.value;
    overlay.replaceChildren(...(value === null ? [] : layout.boxes.flatMap((box) => cursorNodes(frame, box, value, showsFigures())).map(svgElement)));
  }
  const showsFigures = (): boolean => cursor.source === self || frame.panes.some((pane) => pane.traces.some((trace) => trace.parameter));

  function setView(next: View): void {
    view = next;
    draw();
  }

  function toggleTable(): void {
    table.hidden = !table.hidden;
    tableButton.setAttribute("aria-expanded", String(!table.hidden));
    if (!table.hidden) {
      table.replaceChildren(dataTable(frame));
      table.focus();
    }
  }

  async function save(kind: "svg" | "png" | "csv"): Promise<void> {
    exportMenu.open = false;
    const { width, height } = layout;
    if (kind === "csv") {
      download(new Blob([frameToCsv(frame)], { type: "text/csv" }), `${frame.fileName}.csv`);
      return;
    }
    const markup = frameToSvg(frame, view, width, height, lightPalette());
    if (kind === "svg") download(new Blob([markup], { type: "image/svg+xml" }), `${frame.fileName}.svg`);
    else download(await svgToPng(markup, width, exportHeight(height)), `${frame.fileName}.png`);
  }

  const moveTo = (value: number | null): void => moveCursor(frame.link, { value, source: value === null ? null : self });

  /** The box under a point of the SVG, or the nearest. */
  const boxAt = (y: number): PaneBox => layout.boxes.find((box) => y <= box.top + box.height + 7) ?? layout.boxes[layout.boxes.length - 1]!;
  const pointOf = (event: PointerEvent): { x: number; y: number } => {
    const rectangle = svg.getBoundingClientRect();
    return { x: event.clientX - rectangle.left, y: event.clientY - rectangle.top };
  };

  const pointers = new Map<number, { x: number; y: number }>();
  let drag: { x: number; y: number } | null = null;

  function hover(point: { x: number; y: number }): void {
    const box = boxAt(point.y);
    if (point.x < box.left || point.x > box.left + box.width) return moveTo(null);
    moveTo(valueAt(box, point));
  }

  svg.addEventListener("pointerdown", (event) => {
    pointers.set(event.pointerId, pointOf(event));
    if (event.pointerType === "mouse" && event.button === 0) {
      drag = pointOf(event);
      svg.setPointerCapture(event.pointerId);
    }
  });
  svg.addEventListener("pointermove", (event) => {
    const point = pointOf(event);
    const before = pointers.get(event.pointerId);
    if (pointers.size === 2 && before) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)![1];
      const old = Math.abs(before.x - other.x);
      const now = Math.abs(point.x - other.x);
      pointers.set(event.pointerId, point);
      if (old > 10 && now > 10) setView(zoomAbout(frame, layout, view, (point.x + other.x) / 2, old / now));
      return;
    }
    if (before) pointers.set(event.pointerId, point);
    if (event.pointerType !== "mouse") return;
    if (drag) drawBand(drag, point);
    else hover(point);
  });
  const release = (event: PointerEvent): void => {
    pointers.delete(event.pointerId);
    const start = drag;
    drag = null;
    if (event.type !== "pointerup") return drawCursor();
    const end = pointOf(event);
    if (event.pointerType !== "mouse") return hover(end);
    if (start && Math.hypot(end.x - start.x, end.y - start.y) > DRAG_MIN_PX) setView(zoomToRectangle(frame, layout, view, boxAt(start.y), start, end));
    else drawCursor();
  };
  svg.addEventListener("pointerup", release);
  svg.addEventListener("pointercancel", release);
  svg.addEventListener("pointerleave", (event) => {
    if (event.pointerType === "mouse" && !drag) moveTo(null);
  });
  svg.addEventListener("dblclick", () => setView(wholeView(frame)));

  function drawBand(from: { x: number; y: number }, to: { x: number; y: number }): void {
    const box = boxAt(from.y);
    const tall = frame.equal || Math.abs(to.y - from.y) > 16;
    overlay.replaceChildren(
      svgElement(
        node("rect", {
          x: Math.min(from.x, to.x),
          y: tall ? Math.min(from.y, to.y) : box.top,
          width: Math.abs(to.x - from.x),
          height: tall ? Math.abs(to.y - from.y) : box.height,
          fill: "var(--accent)",
          "fill-opacity": 0.12,
          stroke: "var(--accent)",
        }),
      ),
    );
  }

  svg.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? 0.1 : 0.01;
    const [lo, hi] = cursorRange(frame, layout);
    const along = cursorScale(frame, [lo, hi]);
    const at = along.toPixel(cursor.value ?? lo);
    const actions: Record<string, () => void> = {
      ArrowRight: () => moveTo(along.toValue(Math.min(1, at + step))),
      ArrowLeft: () => moveTo(along.toValue(Math.max(0, at - step))),
      ArrowUp: () => moveTo(along.toValue(Math.min(1, at + step))),
      ArrowDown: () => moveTo(along.toValue(Math.max(0, at - step))),
      Home: () => moveTo(lo),
      End: () => moveTo(hi),
      "+": () => setView(zoomAbout(frame, layout, view, cursorPixel(), 1 / 1.5)),
      "=": () => setView(zoomAbout(frame, layout, view, cursorPixel(), 1 / 1.5)),
      "-": () => setView(zoomAbout(frame, layout, view, cursorPixel(), 1.5)),
      "0": () => setView(wholeView(frame)),
      Escape: () => setView(wholeView(frame)),
      t: toggleTable,
      T: toggleTable,
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
  svg.addEventListener("keyup", (event) => {
    if ((event.key.startsWith("Arrow") || event.key === "Home" || event.key === "End") && cursor.value !== null) {
      announce(layout.boxes.map((box) => `${box.pane.y.label}: ${readings(frame, box, cursor.value!).join(", ")}`).join("; "));
    }
  });

  function cursorPixel(): number {
    const box = layout.boxes[0]!;
    const value = cursor.value;
    const parametric = frame.panes[0]?.traces.some((trace) => trace.parameter) ?? false;
    if (value === null || parametric) return box.left + box.width / 2;
    return box.x.toPixel(value);
  }

  function valueAt(box: PaneBox, point: { x: number; y: number }): number | null {
    const parametric = box.pane.traces.filter((trace) => trace.parameter);
    if (parametric.length > 0) return nearestOnCurve(box, parametric, point);
    return snap(box.pane.traces, box.x.toValue(point.x));
  }

  const leave = joinLink(frame.link, (position) => {
    cursor = position;
    drawCursor();
  });
  const observer = new ResizeObserver(() => draw());
  observer.observe(svg);
  const writeTexts = (): void => {
    title.textContent = frame.title;
    description.textContent = `${frame.description} ${KEYS}`;
  };
  writeTexts();

  return {
    element,
    update(next) {
      const samePanes = next.panes.length === frame.panes.length;
      frame = next;
      if (!samePanes) view = wholeView(frame);
      writeTexts();
      if (!table.hidden) table.replaceChildren(dataTable(frame));
      draw();
    },
    dispose() {
      leave();
      observer.disconnect();
    },
  };
}

/** The cursor's range: what is in view for plain plots, the whole parameter for curves in a plane. */
function cursorRange(frame: Frame, layout: Layout): Range {
  const parameters = frame.panes.flatMap((pane) => pane.traces.flatMap((trace) => (trace.parameter ? [trace.parameter] : [])));
  return parameters.length > 0 ? extent(parameters, frame.cursorKind) : layout.boxes[0]!.x.range;
}

/** Maps the cursor's range to 0..1. */
function cursorScale(frame: Frame, [lo, hi]: Range): Pick<Scale, "toPixel" | "toValue"> {
  if (frame.cursorKind === "log") {
    return { toPixel: (value) => Math.log(value / lo) / Math.log(hi / lo), toValue: (share) => lo * (hi / lo) ** share };
  }
  return { toPixel: (value) => (value - lo) / (hi - lo), toValue: (share) => lo + share * (hi - lo) };
}

/** The sample of the first trace nearest to the value: a cursor never stands between samples. */
function snap(traces: Trace[], value: number): number {
  const x = traces[0]?.x ?? [];
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

/** "time 12 s", then "name value" of each trace at the cursor. */
function readings(frame: Frame, box: PaneBox, value: number): string[] {
  const parts: string[] = [];
  let at: number | null = null;
  for (const trace of box.pane.traces) {
    const list = trace.parameter ?? trace.x;
    const index = nearestIndex(list, value);
    const y = trace.y[index];
    if (index < 0 || typeof y !== "number") continue;
    at ??= list[index] ?? null;
    const x = trace.x[index];
    parts.push(trace.parameter && typeof x === "number" ? `${trace.name} ${short(x)} ${y < 0 ? "−" : "+"} ${short(Math.abs(y))}i` : `${trace.name} ${short(y)}`);
  }
  const [, name = frame.cursorLabel, unit = ""] = /^(.*?)(?: \((.*)\))?$/.exec(frame.cursorLabel) ?? [];
  return [`${name} ${short(at ?? value)}${unit ? ` ${unit}` : ""}`, ...parts];
}

function cursorNodes(frame: Frame, box: PaneBox, value: number, figures: boolean): ReturnType<typeof node>[] {
  const nodes: ReturnType<typeof node>[] = [];
  const parametric = box.pane.traces.some((trace) => trace.parameter);
  const x = box.x.toPixel(value);
  if (!parametric) {
    if (!(x >= box.left - 1 && x <= box.left + box.width + 1)) return [];
    nodes.push(node("path", { d: `M${x} ${box.top}V${box.top + box.height}`, stroke: "var(--text)", "stroke-width": 1, fill: "none" }));
  }
  for (const trace of box.pane.traces) {
    const index = nearestIndex(trace.parameter ?? trace.x, value);
    const px = box.x.toPixel(trace.x[index] ?? NaN);
    const py = box.y.toPixel(trace.y[index] ?? NaN);
    const inside = px >= box.left - 1 && px <= box.left + box.width + 1 && py >= box.top - 1 && py <= box.top + box.height + 1;
    if (inside) nodes.push(node("circle", { cx: px, cy: py, r: 3.5, fill: "var(--surface)", "stroke-width": 2, stroke: lineOf(trace.look)["stroke"]! }));
  }
  if (figures) nodes.push(...readoutNodes(box, readings(frame, box, value), parametric ? box.left + box.width : x));
  return nodes;
}

/** The figures in one line where they fit, else one under the other, on the side away from the cursor. */
function readoutNodes(box: PaneBox, parts: string[], cursorX: number): ReturnType<typeof node>[] {
  const width = (text: string): number => text.length * 6.6 + 10;
  const oneLine = parts.join(" · ");
  const lines = width(oneLine) < box.width - 4 || parts.length * 16 + 6 > box.height ? [oneLine] : parts;
  const widest = Math.max(...lines.map(width));
  const onRight = lines.length === 1 || cursorX < box.left + box.width / 2;
  const anchor = onRight ? box.left + box.width - 4 : box.left + 4;
  const rect = node("rect", {
    x: onRight ? anchor - widest : anchor,
    y: box.top + 3,
    width: widest,
    height: lines.length * 16 + 4,
    fill: "var(--surface)",
    "fill-opacity": 0.88,
  });
  const texts = lines.map((line, index) =>
    node("text", { x: onRight ? anchor - 5 : anchor + 5, y: box.top + 16 + 16 * index, "text-anchor": onRight ? "end" : "start", fill: "var(--text)", "font-size": 12 }, line),
  );
  return [rect, ...texts];
}
