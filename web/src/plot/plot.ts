// One plot on the page: stacked panes over one x axis, with cursor, zoom, keys, data table and exports.
import { closesItself, h, node, say, setAttribute, svgElement, svgWriter, uniqueId } from "../dom.ts";
import { joinLink, moveCursor, zoomTogether } from "./cursor.ts";
import type { CursorPosition, Listener } from "./cursor.ts";
import { dataTable } from "./data_table.ts";
import { download, exportHeight, fileNameOf, frameToCsv, frameToSvg, lightPalette, svgToPng } from "./export.ts";
import { enlarging } from "./enlarge.ts";
import type { Frame } from "./frame.ts";
import { isGrab } from "./grab.ts";
import type { Place } from "./grab.ts";
import { KEYS_SENTENCE } from "./keys.ts";
import { layoutFrame, wholeView } from "./layout.ts";
import type { Layout, PaneBox, View } from "./layout.ts";
import { pointLabel } from "./labels.ts";
import { drawLayout, pointNear, swatch } from "./marks.ts";
import { cursorNodes, cursorRange, cursorScale, readings, valueAt } from "./readout.ts";
import { stretchOf, zoomAbout, zoomToRectangle } from "./zoom.ts";

export interface Plot {
  element: HTMLElement;
  update(frame: Frame): void;
  /** While a control that changes the frame is held, its axes only grow; they settle on release. */
  hold(held: boolean): void;
  dispose(): void;
}

/** Elements on top of the drawing, positioned from its upper left corner, which follow its layout. */
export interface PlotHandles {
  element: HTMLElement;
  place(layout: Layout): void;
}

/** Announces a sentence to readers who do not see the plot. */
export type Announce = (sentence: string) => void;

const DRAG_MIN_PX = 6;
const NAME_PX = 9;

export function createPlot(
  first: Frame,
  announce: Announce,
  handles: PlotHandles | null = null,
): Plot {
  let given = first;
  let other = false;
  const chosen = (): Frame => (other ? (given.alternative ?? given) : given);
  let frame = chosen();
  let view = wholeView(frame);
  let layout: Layout = layoutFrame(frame, 480, 300, view);
  let cursor: CursorPosition = { value: null, source: null };
  let held = false;
  /** The last measured size: measuring while drawing would cause one layout per plot. */
  let size = { width: 480, height: 300 };
  const self = {};
  const clip = uniqueId("pane");

  const title = h("h3", { id: uniqueId("plot-title") }, frame.title);
  const description = h("p", { class: "visually-hidden", id: uniqueId("plot-text") });
  const drawing = svgElement(node("g"));
  const write = svgWriter(drawing);
  const overlay = svgElement(node("g", { "pointer-events": "none" }));
  const svg = svgElement(
    node("svg", {
      role: "img",
      tabindex: 0,
      "aria-labelledby": title.id,
      "aria-describedby": description.id,
      class: "canvas",
    }),
  ) as unknown as SVGSVGElement;
  svg.append(drawing, overlay);

  const table = h("div", {
    class: "data-table",
    tabindex: 0,
    role: "region",
    "aria-label": `Data of ${frame.title}`,
    hidden: true,
  });
  const tableOf = h("span", { class: "visually-hidden" });
  const exportOf = h("span", { class: "visually-hidden" });
  const tableButton = h(
    "button",
    { type: "button", class: "quiet", "aria-expanded": "false", onclick: () => toggleTable() },
    "Table",
    tableOf,
  );
  const otherButton = h("button", { type: "button", class: "quiet", onclick: () => showOther() });
  const resetButton = h(
    "button",
    { type: "button", class: "quiet", hidden: true, onclick: () => setView(wholeView(frame)) },
    "Show all",
  );
  const exportMenu = h(
    "details",
    { class: "menu" },
    h("summary", {}, "Export", exportOf),
    h(
      "div",
      { class: "menu-items" },
      h("button", { type: "button", onclick: () => save("svg") }, "SVG"),
      h("button", { type: "button", onclick: () => save("png") }, "PNG"),
      h("button", { type: "button", onclick: () => save("csv") }, "CSV"),
    ),
  );
  closesItself(exportMenu);
  const largeOf = h("span", { class: "visually-hidden" });
  const largeButton = h("button", { type: "button", class: "quiet", title: "Enlarge (F)", onclick: () => large.toggle() }, h("span", { "aria-hidden": "true" }, "⤢"), largeOf);
  const legend = h("div", { class: "legend-slot", hidden: !frame.ownLegend });
  const element = h(
    "section",
    { class: "card plot", "aria-labelledby": title.id },
    h("header", {}, title, legend, h("div", { class: "tools" }, resetButton, otherButton, largeButton, tableButton, exportMenu)),
    description,
    handles?.element ?? null,
    svg,
    h("p", { class: "keys", "aria-hidden": "true" }, "← → cursor   + − zoom   0 all   T table   F enlarge"),
    table,
  );
  const large = enlarging(
    element,
    () => frame.title,
    (isLarge) => {
      largeButton.hidden = isLarge;
      svg.focus();
    },
  );
  table.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    event.preventDefault();
    toggleTable();
    svg.focus();
  });

  function draw(): void {
    const { width, height } = size;
    setAttribute(svg, "viewBox", `0 0 ${width} ${height}`);
    layout = layoutFrame(frame, width, height, view, held ? layout : null);
    write(drawLayout(frame, layout, clip));
    handles?.place(layout);
    resetButton.hidden = view.x === null && view.y.every((range) => range === null);
    drawCursor();
  }

  function drawCursor(): void {
    const value = cursor.value;
    overlay.replaceChildren(
      ...(value === null
        ? []
        : layout.boxes.flatMap((box) => cursorNodes(frame, box, value, showsFigures())).map(svgElement)),
    );
  }
  const showsFigures = (): boolean =>
    cursor.source === self || frame.panes.some((pane) => pane.traces.some((trace) => trace.parameter));

  function setView(next: View): void {
    view = next;
    draw();
    if (!frame.equal) zoomTogether(frame.link, view.x, link);
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
    const { subject } = given;
    const saved: Frame = subject ? { ...frame, subject } : frame;
    const file = `${fileNameOf(saved)}.${kind}`;
    if (kind === "csv") return download(new Blob([frameToCsv(saved)], { type: "text/csv" }), file);
    const markup = frameToSvg(saved, view, width, height, lightPalette());
    if (kind === "svg") download(new Blob([markup], { type: "image/svg+xml" }), file);
    else download(await svgToPng(markup, width, exportHeight(height)), file);
  }

  const moveTo = (value: number | null): void =>
    moveCursor(frame.link, { value, source: value === null ? null : self });

  /** The box at a vertical position of the SVG, or the nearest one. */
  const boxAt = (y: number): PaneBox =>
    layout.boxes.find((box) => y <= box.top + box.height + 7) ?? layout.boxes[layout.boxes.length - 1]!;
  const pointOf = (event: PointerEvent): Place => {
    const rectangle = svg.getBoundingClientRect();
    return { x: event.clientX - rectangle.left, y: event.clientY - rectangle.top };
  };

  const valuesAt = (box: PaneBox, point: Place): Place => ({ x: box.x.toValue(point.x), y: box.y.toValue(point.y) });

  /** Reports the position of what is dragged, in the pane in which it began. */
  function moveGrabbed(point: Place, released: boolean): void {
    const box = layout.boxes[taken!.pane]!;
    frame.drag?.(valuesAt(box, point), released, taken!.from);
  }

  const grabs = (point: Place, touch: boolean): boolean => frame.drag !== undefined && isGrab(layout, boxAt(point.y), point, touch);

  /** Shows the name of a quiet point under the pointer. */
  function showName(point: { x: number; y: number }): void {
    const box = boxAt(point.y);
    const named = pointNear(box, point, NAME_PX, (mark) => mark.quiet === true);
    if (named) overlay.append(svgElement(pointLabel(box, named)));
  }

  const pointers = new Map<number, { x: number; y: number }>();
  let drag: { x: number; y: number } | null = null;
  /** What is dragged: where it was pressed, the pointer that drags it, and its last place. */
  let taken: { pane: number; from: Place; pointer: number; last: Place } | null = null;

  function hover(point: { x: number; y: number }): void {
    const box = boxAt(point.y);
    if (point.x < box.left || point.x > box.left + box.width) return moveTo(null);
    moveTo(valueAt(box, point));
    showName(point);
    svg.classList.toggle("grabs", grabs(point, false));
  }

  svg.addEventListener("pointerdown", (event) => {
    const place = pointOf(event);
    if (!taken && event.button === 0 && grabs(place, event.pointerType !== "mouse")) {
      const box = boxAt(place.y);
      taken = { pane: layout.boxes.indexOf(box), from: valuesAt(box, place), pointer: event.pointerId, last: place };
      event.preventDefault();
      svg.setPointerCapture(event.pointerId);
      return;
    }
    pointers.set(event.pointerId, place);
    if (event.pointerType === "mouse" && event.button === 0) {
      drag = pointOf(event);
      svg.setPointerCapture(event.pointerId);
    }
  });
  svg.addEventListener("pointermove", (event) => {
    const point = pointOf(event);
    if (taken) {
      // A second finger neither drags nor zooms meanwhile.
      if (event.pointerId !== taken.pointer) return;
      taken.last = point;
      return moveGrabbed(point, false);
    }
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
    if (drag) drawBand(drag, point, frame.brush !== undefined && !event.shiftKey);
    else hover(point);
  });
  const release = (event: PointerEvent): void => {
    pointers.delete(event.pointerId);
    if (taken) {
      if (event.pointerId !== taken.pointer) return;
      // A pointer that the browser cancels has no place.
      moveGrabbed(event.type === "pointerup" ? pointOf(event) : taken.last, true);
      taken = null;
      return;
    }
    const start = drag;
    drag = null;
    if (event.type !== "pointerup") return drawCursor();
    const end = pointOf(event);
    if (event.pointerType !== "mouse") return hover(end);
    if (!start || Math.hypot(end.x - start.x, end.y - start.y) <= DRAG_MIN_PX) return drawCursor();
    if (frame.brush && !event.shiftKey) {
      drawCursor();
      return frame.brush(...stretchOf(layout.boxes[0]!, start.x, end.x));
    }
    setView(zoomToRectangle(frame, layout, view, boxAt(start.y), start, end));
  };
  svg.addEventListener("pointerup", release);
  svg.addEventListener("pointercancel", release);
  svg.addEventListener("pointerleave", (event) => {
    if (event.pointerType === "mouse" && !drag) moveTo(null);
  });
  // A finger on a handle drags it instead of scrolling the page.
  svg.addEventListener(
    "touchstart",
    (event) => {
      const touch = event.touches[0];
      const { left, top } = svg.getBoundingClientRect();
      if (touch && event.touches.length === 1 && grabs({ x: touch.clientX - left, y: touch.clientY - top }, true)) event.preventDefault();
    },
    { passive: false },
  );
  svg.addEventListener("dblclick", () => setView(wholeView(frame)));

  function drawBand(from: { x: number; y: number }, to: { x: number; y: number }, flat: boolean): void {
    const box = boxAt(from.y);
    const tall = !flat && (frame.equal || Math.abs(to.y - from.y) > 16);
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
      // Enlarged, it goes back first.
      ...(large.isLarge() ? {} : { Escape: () => setView(wholeView(frame)) }),
      f: large.toggle,
      F: large.toggle,
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
      announce(
        layout.boxes.map((box) => `${box.pane.y.label}: ${readings(frame, box, cursor.value!).join(", ")}`).join("; "),
      );
    }
  });

  function cursorPixel(): number {
    const box = layout.boxes[0]!;
    const value = cursor.value;
    const parametric = frame.panes[0]?.traces.some((trace) => trace.parameter) ?? false;
    if (value === null || parametric) return box.left + box.width / 2;
    return box.x.toPixel(value);
  }

  const link: Listener = {
    onCursor(position) {
      cursor = position;
      drawCursor();
    },
    onZoom(stretch) {
      if (frame.equal) return;
      view = { ...wholeView(frame), x: stretch };
      draw();
    },
  };
  const leave = joinLink(frame.link, link);
  const observer = new ResizeObserver(([entry]) => {
    const { width, height } = entry!.contentRect;
    if (width === 0) return;
    size = { width: Math.max(200, Math.round(width)), height: Math.max(140, Math.round(height)) };
    draw();
  });
  observer.observe(svg);
  const writeTexts = (): void => {
    say(title, frame.title);
    say(tableOf, ` of ${frame.title}`);
    say(largeOf, `Enlarge ${frame.title}`);
    say(exportOf, ` ${frame.title}`);
    setAttribute(table, "aria-label", `Data of ${frame.title}`);
    const alternative = other ? given : given.alternative;
    otherButton.hidden = !given.alternative;
    say(otherButton, alternative?.title ?? "");
    say(description, `${frame.description} ${KEYS_SENTENCE}`);
    if (frame.ownLegend) legend.replaceChildren(paneLegend(frame));
  };
  writeTexts();

  function showOther(): void {
    other = !other;
    take(given);
    announce(frame.description);
  }

  function take(next: Frame): void {
    given = next;
    const before = frame;
    frame = chosen();
    if (frame.panes.length !== before.panes.length) view = wholeView(frame);
    writeTexts();
    if (!table.hidden) table.replaceChildren(dataTable(frame));
    draw();
  }

  return {
    element,
    update: take,
    hold(now) {
      if (held === now) return;
      held = now;
      if (!held) draw();
    },
    dispose() {
      large.close();
      leave();
      observer.disconnect();
    },
  };
}

/** The names of a frame's first pane with their lines; for plots whose traces are in no other legend. */
function paneLegend(frame: Frame): HTMLElement {
  const traces = (frame.panes[0]?.traces ?? []).filter(({ quiet }) => !quiet);
  return h(
    "p",
    { class: "pane-legend" },
    traces.map((trace) => h("span", {}, swatch(trace.look, trace.thin), trace.name)),
  );
}
