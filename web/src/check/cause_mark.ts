// The mark of a cause: its shape says how certain the cause is, its colour only repeats the words next to it.
import type { LoopCheck } from "../api/types.ts";
import { h, node, svgElement } from "../dom.ts";
import type { TreeNode } from "../dom.ts";
import { confidenceWords, toneOf, verdictWords } from "../words/check.ts";
import type { Confidence } from "../words/check.ts";

const SIZE = 14;
const LINE = { fill: "none", stroke: "currentColor", "stroke-width": 1.6 };
const RING = node("circle", { cx: 7, cy: 7, r: 5.2, ...LINE });

/** A full disc is sure, a half one likely, a ring open. */
const SHAPES: Record<Confidence, TreeNode[]> = {
  sure: [node("circle", { cx: 7, cy: 7, r: 6, fill: "currentColor" })],
  likely: [RING, node("path", { d: "M7 1.8A5.2 5.2 0 0 0 7 12.2Z", fill: "currentColor" })],
  open: [RING],
};

const shape = (confidence: Confidence): SVGElement =>
  svgElement(
    node(
      "svg",
      { width: SIZE, height: SIZE, viewBox: `0 0 ${SIZE} ${SIZE}`, "aria-hidden": "true", focusable: "false" },
      ...(SHAPES[confidence] ?? SHAPES.open),
    ),
  );

/** "Sticking valve, likely", with its mark; of an open cause the words say so themselves. */
export function causeMark(cause: Pick<LoopCheck["cause"], "verdict" | "confidence">): HTMLElement {
  const sureness = cause.confidence === "open" ? "" : `, ${confidenceWords(cause.confidence)}`;
  return h(
    "span",
    { class: `cause ${toneOf(cause)}` },
    shape(cause.confidence),
    h("span", {}, verdictWords(cause.verdict), h("span", { class: "sureness" }, sureness)),
  );
}
