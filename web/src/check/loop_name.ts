// How a loop is named in cells and sentences: a link to its page, and the mark of its cause. The shape of the mark says how
// certain the cause is, its colour only repeats the words next to it.
import type { LoopCheck } from "../api/types.ts";
import { h, node, svgElement } from "../dom.ts";
import type { Child, TreeNode } from "../dom.ts";
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

/** Of a loop's page, by its place. */
export type LoopAddress = (place: number) => string;

export const loopLink = (place: number, tag: string, address: LoopAddress): HTMLAnchorElement =>
  h("a", { href: address(place), "data-loop": place }, tag);

/** "A, B and C", as links. */
export const listed = (links: HTMLElement[]): Child[] =>
  links.flatMap((link, index): Child[] => [index === 0 ? "" : index === links.length - 1 ? " and " : ", ", link]);

/** What is shown of the work list is a part of the address: it is written when a link is followed or copied, so that it is
    that of the list as it is then. */
export function followAddress(part: HTMLElement, address: LoopAddress): void {
  const write = (event: Event): void => {
    const link = event.target instanceof Element ? event.target.closest<HTMLAnchorElement>("a[data-loop]") : null;
    if (link) link.href = address(Number(link.dataset["loop"]));
  };
  for (const event of ["pointerdown", "focusin", "click"]) part.addEventListener(event, write, { capture: true });
}
