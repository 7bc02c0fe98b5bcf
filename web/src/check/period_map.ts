// The plant's map of periods: each loop that oscillates with its spectrum over one axis of periods, loops that oscillate
// together joined by a line, the likely source marked.
import type { CheckContent } from "../api/types.ts";
import { h, node, svgElement } from "../dom.ts";
import type { Child, TreeNode } from "../dom.ts";
import { explained } from "../reach/explanation.ts";
import { timeWords } from "../words/check.ts";
import { counted } from "../words/range.ts";
import { loopLink } from "./loop_name.ts";
import type { LoopAddress } from "./loop_name.ts";
import { alongAxis, periodGroups, periodOf, periodRange, periodTicks, ridge } from "./periods.ts";
import type { PeriodGroup } from "./periods.ts";

/** Of a row's drawing, which is stretched to the width of its cell. */
const WIDTH = 1000;
const HEIGHT = 24;
const TICKS = 8;
const COLOURS = ["var(--series-1)", "var(--series-2)", "var(--series-3)", "var(--series-4)"];

type Range = readonly [number, number];

const place = (period: number, range: Range): number => Math.round(WIDTH * alongAxis(period, range));

const upright = (x: number, look: Record<string, string | number>): TreeNode =>
  node("path", { d: `M${x} 0V${HEIGHT}`, fill: "none", "vector-effect": "non-scaling-stroke", ...look });

function drawing(children: TreeNode[]): SVGElement {
  const attributes = { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none", "aria-hidden": "true", focusable: "false" };
  return svgElement(node("svg", attributes, ...children));
}

function loopDrawing(content: CheckContent, loop: number, range: Range, group: { period: number; colour: string } | null): SVGElement {
  const curve = ridge(content.loops[loop]!.shape, range).map(([at, power]) => `L${Math.round(WIDTH * at)} ${(HEIGHT - 1 - (HEIGHT - 4) * power).toFixed(1)}`);
  const colour = group?.colour ?? "var(--muted)";
  const x = place(periodOf(content, loop), range);
  return drawing([
    ...periodTicks(range, TICKS).map(([tick]) => upright(place(tick, range), { stroke: "var(--grid)" })),
    // A batch has no spectra.
    ...(curve.length > 0 ? [node("path", { d: `M0 ${HEIGHT - 1}${curve.join("")}L${WIDTH} ${HEIGHT - 1}`, fill: colour, "fill-opacity": 0.18, stroke: colour, "vector-effect": "non-scaling-stroke" })] : []),
    ...(group ? [upright(place(group.period, range), { stroke: colour, "stroke-width": 2 })] : []),
    node("path", { d: `M${x} ${HEIGHT / 2}h0`, stroke: colour, "stroke-width": 10, "stroke-linecap": "round", "vector-effect": "non-scaling-stroke" }),
  ]);
}

/** The names of the ticks above the drawings, at their places. */
function axis(range: Range): HTMLElement {
  return h(
    "span",
    { class: "period-axis" },
    periodTicks(range, TICKS).map(([tick, text]) => {
      const name = h("span", {}, text);
      name.style.left = `${(100 * alongAxis(tick, range)).toFixed(2)}%`;
      return name;
    }),
  );
}

const title = ({ cluster, places }: PeriodGroup): Child[] =>
  cluster
    ? [h("strong", {}, `${places.length} loops together.`), " ", cluster.detail]
    : [h("strong", {}, `${counted(places.length, "loop")} alone`)];

/** A table, so that it is read without the drawing too; null if no loop oscillates. */
export function periodMap(content: CheckContent, address: LoopAddress): HTMLElement | null {
  const range = periodRange(content);
  if (!range) return null;
  const bodies = periodGroups(content).map((group, index) => {
    const { cluster } = group;
    const joined = cluster ? { period: cluster.period, colour: COLOURS[index % COLOURS.length]! } : null;
    const rows = group.places.map((loop) =>
      h(
        "tr",
        {},
        h(
          "th",
          { scope: "row" },
          loopLink(loop, content.loops[loop]!.tag, address),
          cluster?.source === loop ? h("span", { class: "source" }, "source") : "",
        ),
        h("td", {}, timeWords(periodOf(content, loop))),
        h("td", { class: "ridge" }, loopDrawing(content, loop, range, joined)),
      ),
    );
    return h("tbody", {}, h("tr", { class: "group" }, h("th", { scope: "rowgroup", colspan: 3 }, title(group))), rows);
  });
  const table = h(
    "table",
    { class: "figures period-map" },
    h("caption", { class: "visually-hidden" }, "Periods of the loops that oscillate"),
    h(
      "thead",
      {},
      h("tr", {}, h("th", { scope: "col" }, "Loop"), h("th", { scope: "col" }, explained("period", "Period")), h("th", { scope: "col", class: "ridge" }, h("span", { class: "visually-hidden" }, "Spectrum of the error"), axis(range))),
    ),
    bodies,
  );
  return h("div", { class: "scroll work-scroll", role: "region", "aria-label": "Loops over their periods", tabindex: 0 }, table);
}
