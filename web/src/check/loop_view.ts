// A checked loop on a page of its own: cause and evidence, what to do, its pictures and figures; and the way to the next
// loop of the work list.
import type { LoopCheck } from "../api/types.ts";
import { loopFrames } from "../charts/loop_check.ts";
import { h, passFocus } from "../dom.ts";
import { plotGrid } from "../plot/grid.ts";
import type { UnitNames } from "../words/numbers.ts";
import { cureCard } from "./cure_card.ts";
import { actionCard, causeCard, figuresCard } from "./loop_cards.ts";
import type { LoopShown } from "./loop_cards.ts";
import { clusterOf } from "./periods.ts";
import type { WholeLoop } from "./source.ts";

/** Where a loop is in the work list. */
export interface LoopWays {
  /** Places of the loops in the order of the work list. */
  order: readonly number[];
  /** The address of the work list. */
  list: string;
}

/** The loop with its curves, and what can be done with its record. */
export interface LoopWhole extends WholeLoop {
  steps: HTMLElement[];
}

export interface LoopView {
  element: HTMLElement;
  show(shown: LoopShown, ways: LoopWays): void;
  /** What the list does not have follows when it is known. */
  complete(shown: LoopShown, whole: LoopWhole): void;
  /** A loop below it, on the same time axis, with its place; null: none. */
  drawWith(other: LoopCheck | null, place: number | null): void;
  /** It is not on the screen any more. */
  leave(): void;
  dispose(): void;
}

/** `onWith`: a loop to draw with this one was chosen, by its place. */
export function loopView(announce: (sentence: string) => void, onWith: (place: number | null) => void): LoopView {
  const back = h("a", { href: "#/check" }, "Work list");
  const before = h("a", { href: "#/check" });
  const after = h("a", { href: "#/check" });
  const at = h("span", { class: "hint" });
  const others = h("select", { id: "loop-with", onchange: () => onWith(others.value === "" ? null : Number(others.value)) });
  const together = h("span", { class: "work-before" }, h("label", { for: others.id }, "Draw with"), others);
  const cards = h("div", { class: "loop-cards" });
  const cure = cureCard(announce);
  const side = h("div", { class: "loop-side" });
  const plots = plotGrid(announce);
  let drawn: { loop: LoopCheck; units: UnitNames } | null = null;
  const element = h(
    "div",
    { class: "check-loop" },
    h("nav", { class: "loop-ways", "aria-label": "Loops" }, back, together, before, at, after),
    cards,
    cure.element,
    h("div", { class: "loop-body" }, plots.element, side),
  );

  /** Its name stays in the accessibility tree: "Next loop FIC101". */
  function lead(link: HTMLAnchorElement, word: string, place: number | undefined, { content, address }: LoopShown): void {
    if (place === undefined) passFocus(link, link === before ? after : before, back);
    link.hidden = place === undefined;
    if (place === undefined) return;
    link.href = address(place);
    link.replaceChildren(word, h("span", { class: "visually-hidden" }, ` ${content.loops[place]!.tag}`));
  }

  /** Loops that oscillate with it come first. */
  function offer({ content, row: { place } }: LoopShown, order: readonly number[]): void {
    const near = clusterOf(content, place)?.loops ?? [];
    const places = [...new Set([...near, ...order])].filter((other) => other !== place);
    others.replaceChildren(h("option", { value: "" }, "no other loop"), ...places.map((other) => h("option", { value: other }, content.loops[other]!.tag)));
    together.hidden = places.length === 0 || content.loops[place]!.trend.t.length < 2;
  }

  function draw(other: LoopCheck | null): void {
    if (!drawn) return;
    const { loop, units } = drawn;
    plots.setSubject(loop.tag);
    const frames = Object.entries(loopFrames(loop, units, other));
    for (const [key, frame] of frames) plots.show(key, frame);
    plots.element.classList.toggle("with-other", other !== null);
    plots.element.hidden = frames.every(([, frame]) => frame === null);
  }

  return {
    element,
    show(shown, { order, list }) {
      const { place } = shown.row;
      const index = order.indexOf(place);
      back.href = list;
      lead(before, "‹ Previous", index < 0 ? undefined : order[index - 1], shown);
      lead(after, "Next ›", index < 0 ? undefined : order[index + 1], shown);
      at.textContent = index < 0 ? "not in the list as filtered" : `${index + 1} of ${order.length}`;
      offer(shown, order);
      drawn = null;
      cards.replaceChildren(causeCard(shown), actionCard(shown, []));
      // Of a record that could not be read there are none.
      side.replaceChildren(...(shown.row.loop.quality.rows > 0 ? [figuresCard(shown)] : []));
      plots.element.hidden = true;
      cure.dispose();
      cure.element.hidden = true;
    },
    complete(shown, { loop: own, sent, units, steps }) {
      // Its neighbours may have changed its cause.
      const { cause, action } = shown.row.loop;
      const loop = { ...own, cause, action };
      cards.replaceChildren(causeCard(shown), actionCard(shown, steps));
      drawn = { loop, units: shown.units };
      draw(null);
      cure.show(loop, sent, units);
    },
    drawWith(other, place) {
      others.value = `${place ?? ""}`;
      draw(other);
    },
    leave: cure.dispose,
    dispose() {
      cure.dispose();
      plots.dispose();
    },
  };
}
