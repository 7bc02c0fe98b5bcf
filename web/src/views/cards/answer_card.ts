// The settings to enter: the chosen controller in the user's own controller or in a textbook form, with today's values.
import { breakable, h, uniqueId } from "../../dom.ts";
import type { AnswerRow } from "../../words/answer.ts";
import { copyButton } from "../copy.ts";

export interface Answer {
  heading: string;
  /** Whose settings they are, and how they came about. */
  whose: string;
  rows: AnswerRow[];
  /** For the clipboard. */
  text: string;
  /** What follows the rows, always visible. */
  below: HTMLElement[];
  /** What is folded away. */
  details: HTMLElement[];
}

export interface AnswerCard {
  element: HTMLElement;
  show(answer: Answer): void;
  /** The reason why there is nothing to enter. */
  complain(heading: string, sentence: string): void;
  setBusy(busy: boolean): void;
}

/** `picker`: what chooses the controller; `after`: what stands below everything. */
export function answerCard(announce: (sentence: string) => void, picker: HTMLElement, ...after: HTMLElement[]): AnswerCard {
  let shown: Answer | null = null;
  const title = h("h2", { id: uniqueId("answer") });
  const whose = h("p", { class: "whose" });
  const list = h("table", { class: "typed" });
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const copies = h(
    "div",
    { class: "copies" },
    copyButton({ label: "Copy", spoken: "Copy the settings as text", text: () => shown?.text ?? null }, announce),
    copyButton({ label: "Copy as table", look: "quiet", text: () => shown && tableText(shown.rows) }, announce),
  );
  const below = h("div", { class: "answer-below" });
  const rest = h("div", { class: "typed-rest" });
  const details = h("details", { class: "answer-details" }, h("summary", {}, "How the controller computes these settings"), rest);
  const body = h("div", { class: "typed-body" }, list, below, details);
  const element = h(
    "section",
    { class: "card settings typed-card", "aria-labelledby": title.id },
    h("div", { class: "head" }, title, whose, copies),
    picker,
    trouble,
    body,
    after,
  );

  function rowOf({ label, value, unit, today, about }: AnswerRow, withToday: boolean): HTMLElement {
    const copy = copyButton({ label: "Copy", spoken: `Copy ${label}`, look: "quiet", text: () => value }, announce);
    return h(
      "tr",
      { title: about || null },
      h("th", { scope: "row" }, breakable(label)),
      withToday ? h("td", { class: "today" }, today) : "",
      h("td", { class: "value" }, value),
      h("td", { class: "unit" }, unit),
      h("td", {}, copy),
    );
  }

  return {
    element,
    show(answer) {
      shown = answer;
      title.textContent = answer.heading;
      whose.textContent = answer.whose;
      const withToday = answer.rows.some(({ today }) => today !== "");
      const heads = ["", "today", "new", "unit", ""].map((text) => h(text ? "th" : "td", text ? { scope: "col" } : {}, text));
      list.replaceChildren(
        h("caption", { class: "visually-hidden" }, `${answer.heading}: ${answer.whose}`),
        withToday ? h("thead", {}, h("tr", {}, heads)) : "",
        h("tbody", {}, answer.rows.map((row) => rowOf(row, withToday))),
      );
      below.replaceChildren(...answer.below);
      rest.replaceChildren(...answer.details);
      details.hidden = answer.details.length === 0;
      copies.hidden = false;
      trouble.hidden = true;
      body.hidden = false;
    },
    complain(heading, sentence) {
      shown = null;
      title.textContent = heading;
      whose.textContent = "";
      trouble.textContent = sentence;
      trouble.hidden = false;
      copies.hidden = true;
      body.hidden = true;
    },
    setBusy(busy) {
      element.setAttribute("aria-busy", String(busy));
    },
  };
}

/** Tab-separated, with a head: for a spreadsheet. */
const tableText = (rows: readonly AnswerRow[]): string =>
  [["parameter", "today", "new", "unit"], ...rows.map(({ label, today, value, unit }) => [label, today, value, unit])]
    .map((cells) => cells.join("\t"))
    .join("\n");
