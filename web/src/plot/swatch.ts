// A short piece of a series' line, for legends and table headings.
import { h, node, svgElement } from "../dom.ts";
import type { Frame, Look } from "./frame.ts";
import { lineOf } from "./marks.ts";

export function swatch(look: Look, thin = false): Element {
  const line = node("path", { d: "M1 5H27", fill: "none", ...lineOf(look, thin) });
  return svgElement(
    node("svg", { width: 28, height: 10, viewBox: "0 0 28 10", "aria-hidden": "true", focusable: "false" }, line),
  );
}

/** The names of a frame's first pane with their lines; for plots whose traces stand in no other legend. */
export function paneLegend(frame: Frame): HTMLElement {
  const traces = frame.panes[0]?.traces ?? [];
  return h(
    "p",
    { class: "pane-legend" },
    traces.map((trace) => h("span", {}, swatch(trace.look, trace.thin), trace.name)),
  );
}
