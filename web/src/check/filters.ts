// What is shown of the work list: causes and their numbers as buttons, owner, and a part of the name.
import { h } from "../dom.ts";
import type { ListView } from "../routes.ts";
import { ownerWords, verdictOrder, verdictWords } from "../words/check.ts";
import { causeMark } from "./loop_name.ts";
import { counts } from "./columns.ts";
import type { WorkRow } from "./columns.ts";
import type { Confidence } from "../words/check.ts";

export interface Filters {
  element: HTMLElement;
  /** The causes and owners to choose from. */
  build(rows: readonly WorkRow[]): void;
  show(view: ListView, shown: number, all: number): void;
}

/** The mark of a button: full, or a ring for verdicts that leave the cause open. */
const sureness = (verdict: string, rows: readonly WorkRow[]): Confidence =>
  rows.some(({ loop }) => loop.cause.verdict === verdict && loop.cause.confidence !== "open") ? "sure" : "open";

/** `before`: the choice of an earlier check. */
export function workFilters(onChange: (change: Partial<ListView>) => void, before: HTMLElement): Filters {
  let causes = new Map<string, HTMLButtonElement>();
  const list = h("div", { class: "causes", role: "group", "aria-label": "Causes" });
  const owner = h("select", { id: "work-owner", onchange: () => onChange({ owner: owner.value }) });
  const text = h("input", { type: "text", id: "work-find", autocomplete: "off", spellcheck: "false", placeholder: "part of its name" });
  text.addEventListener("input", () => onChange({ text: text.value.trim() }));
  const found = h("p", { class: "hint", role: "status" });
  const all = h("button", { type: "button", class: "quiet", hidden: true, onclick: showAll }, "Show all");

  function showAll(): void {
    text.focus();
    onChange({ cause: "", owner: "", text: "" });
  }

  function button(cause: string, content: (Node | string)[]): HTMLButtonElement {
    return h("button", { type: "button", class: "quiet", "aria-pressed": "false", onclick: () => onChange({ cause }) }, content);
  }

  return {
    element: h(
      "div",
      { class: "work-filters" },
      list,
      h(
        "div",
        { class: "work-narrow" },
        h("label", { for: "work-owner" }, "Owner"),
        owner,
        h("label", { for: "work-find" }, "Loop"),
        text,
        before,
        found,
        all,
      ),
    ),
    build(rows) {
      const numbers = counts(rows, ({ loop }) => loop.cause.verdict, verdictOrder);
      causes = new Map([
        ["", button("", ["All loops ", h("strong", {}, rows.length)])],
        ...numbers.map(([cause, count]): [string, HTMLButtonElement] => {
          const verdict = cause as WorkRow["loop"]["cause"]["verdict"];
          const label = causeMark({ verdict, confidence: sureness(cause, rows) });
          label.querySelector(".sureness")?.remove();
          return [cause, button(cause, [label, h("strong", {}, count)])];
        }),
      ]);
      list.replaceChildren(...causes.values());
      const owners = counts(rows, ({ loop }) => loop.action.owner, () => 0).filter(([code]) => code !== "nobody");
      owner.replaceChildren(
        h("option", { value: "" }, "all"),
        ...owners.map(([code, count]) => h("option", { value: code }, `${ownerWords(code)} (${count})`)),
      );
    },
    show(view, shown, count) {
      for (const [cause, element] of causes) element.setAttribute("aria-pressed", String(cause === view.cause));
      owner.value = view.owner;
      if (text.value.trim() !== view.text) text.value = view.text;
      all.hidden = shown === count;
      const words = shown === count ? "" : `${shown} of ${count} loops`;
      if (found.textContent !== words) found.textContent = words;
    },
  };
}

/** Verdict and number of each cause, for speech. */
export const countsSentence = (rows: readonly WorkRow[]): string =>
  counts(rows, ({ loop }) => loop.cause.verdict, verdictOrder)
    .map(([cause, count]) => `${verdictWords(cause)}: ${count}`)
    .join(", ");
