// The settings to enter: the chosen controller in the user's product or in a textbook form, with today's values.
import { breakable, h, say, uniqueId } from "../../dom.ts";
import { explained } from "../../reach/explanation.ts";
import type { AnswerRow } from "../../words/answer.ts";
import { tableText } from "../../words/answer.ts";
import { copyButton } from "../copy.ts";

export interface Answer {
  /** "Type into", and into what: the picker of the card shows the second part already. */
  heading: [visible: string, spoken: string];
  /** Whose settings they are, and how they came about. */
  whose: string;
  rows: AnswerRow[];
  /** For the clipboard. */
  text: string;
  /** The part after the rows, always visible. */
  below: HTMLElement[];
  /** The part that is folded away. */
  details: HTMLElement[];
  /** A newer answer is on its way. */
  outdated: boolean;
  /** Other values can be typed in the place of these. `choices`: by a row's name; empty: a number. */
  choices: ((name: string) => string[]) | null;
}

export interface AnswerCardEvents {
  announce(sentence: string): void;
  /** Values were typed in place of those shown: all texts by the rows' names. */
  onType(texts: Record<string, string>): Promise<void>;
}

export interface AnswerCard {
  element: HTMLElement;
  show(answer: Answer): void;
  /** The reason why there is nothing to enter. */
  complain(heading: Answer["heading"], sentence: string): void;
  setBusy(busy: boolean): void;
  /** Says why typed values are not shown; "": they are. */
  refuse(sentence: string): void;
}

export interface AnswerCardParts {
  /** The picker of the controller, in the line of the heading. */
  picker: HTMLElement;
  /** Text directly below the picker: what is wrong, and the next step. */
  notes: HTMLElement[];
  /** Folded parts at the end of the card. */
  folded: HTMLElement[];
}

export function answerCard({ announce, onType }: AnswerCardEvents, parts: AnswerCardParts): AnswerCard {
  let shown: Answer | null = null;
  let lines: RowElements[] = [];
  /** The names of the rows on the screen, and whether they have today's values: others need new elements. */
  let made = "";
  /** The values are fields in which others can be typed. */
  let typing = false;
  /** Typed values that are being converted. */
  let converting = 0;
  const spoken = h("span", { class: "visually-hidden" });
  const visible = h("span", {});
  const title = h("h2", { id: uniqueId("answer") }, visible, spoken);
  const whose = h("p", { class: "whose" });
  const caption = h("caption", { class: "visually-hidden" });
  const list = h("table", { class: "typed" });
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const change = h("button", { type: "button", class: "quiet", "aria-pressed": "false", onclick: toggle }, "Type other values");
  const refused = h("p", { class: "trouble", role: "status", hidden: true });
  const copies = h(
    "div",
    { class: "copies" },
    change,
    copyButton({ label: "Copy as table", look: "quiet", text: () => shown && tableText(shown.rows) }, announce),
    copyButton({ label: "Copy", spoken: "Copy all with units", text: () => shown?.text ?? null }, announce),
  );
  const below = h("div", { class: "answer-below" });
  const rest = h("div", { class: "typed-rest" });
  const details = h("details", {}, h("summary", {}, "How it computes them"), rest);
  const body = h("div", { class: "typed-body" }, list, refused, below);
  const element = h(
    "section",
    { class: "card settings typed-card", "aria-labelledby": title.id },
    h("div", { class: "head" }, title, parts.picker),
    h("div", { class: "line" }, whose, copies),
    parts.notes,
    trouble,
    body,
    h("div", { class: "folds" }, details, parts.folded),
  );

  function make(rows: readonly AnswerRow[], withToday: boolean): void {
    const heads = ["", ...(withToday ? ["today"] : []), "new", "unit", ""];
    const head = heads.map((text) => h(text ? "th" : "td", text ? { scope: "col", class: text } : {}, text));
    lines = rows.map((row, index) =>
      rowElements(row, {
        withToday,
        current: () => shown?.rows[index]?.value ?? null,
        choices: typing ? (shown?.choices?.(row.name) ?? null) : null,
        announce,
        onType: typed,
      }),
    );
    list.replaceChildren(
      caption,
      withToday ? h("thead", {}, h("tr", {}, head)) : "",
      h("tbody", {}, lines.map(({ element: line }) => line)),
    );
  }

  function toggle(): void {
    typing = !typing;
    change.setAttribute("aria-pressed", String(typing));
    refuse("");
    if (shown) showRows(shown.rows);
    if (typing) list.querySelector<HTMLElement>("input, select")?.focus();
  }

  function typed(): void {
    if (!shown) return;
    const texts = shown.rows.map(({ name, value }, index) => [name, lines[index]!.text() ?? value] as const);
    for (const line of lines) line.handIn();
    if (texts.every(([, text], index) => text === shown!.rows[index]!.value)) return refuse("");
    converting += 1;
    void onType(Object.fromEntries(texts)).finally(() => (converting -= 1));
  }

  function refuse(sentence: string): void {
    say(refused, sentence);
    refused.hidden = sentence === "";
  }

  function showRows(rows: readonly AnswerRow[]): void {
    const withToday = rows.some(({ today }) => today !== "");
    const wanted = JSON.stringify([withToday, typing, rows.map(({ label, about, explains }) => [label, about, explains])]);
    if (wanted !== made) make(rows, withToday);
    made = wanted;
    rows.forEach((row, index) => lines[index]!.write(row, converting > 0 || (shown?.outdated ?? false)));
  }

  function setTitle([first, second]: Answer["heading"]): void {
    say(visible, first);
    say(spoken, second);
  }

  return {
    element,
    show(answer) {
      shown = answer;
      setTitle(answer.heading);
      say(whose, answer.whose);
      say(caption, `${answer.heading.join("")}; ${answer.whose}`);
      if (!answer.choices) typing = false;
      change.hidden = !answer.choices;
      change.setAttribute("aria-pressed", String(typing));
      refuse("");
      showRows(answer.rows);
      below.replaceChildren(...answer.below);
      rest.replaceChildren(...answer.details);
      details.hidden = answer.details.length === 0;
      copies.hidden = false;
      trouble.hidden = true;
      body.hidden = false;
    },
    complain(heading, sentence) {
      shown = null;
      setTitle(heading);
      say(whose, "");
      say(trouble, sentence);
      trouble.hidden = sentence === "";
      copies.hidden = true;
      body.hidden = true;
      details.hidden = true;
    },
    setBusy(busy) {
      if (busy) element.setAttribute("aria-busy", "true");
      else element.removeAttribute("aria-busy");
    },
    refuse,
  };
}

interface RowElements {
  element: HTMLElement;
  /** `keep`: the answer is older than what was handed in; a text that was not handed in yet stays in any case. */
  write(row: AnswerRow, keep: boolean): void;
  /** The text of its field is on its way to the service. */
  handIn(): void;
  /** The text of its field; null: it has none. */
  text(): string | null;
}

interface RowOptions {
  withToday: boolean;
  /** The value on the screen when it is copied. */
  current(): string | null;
  /** The texts from which one can be chosen; empty: a text is typed; null: the value is only shown. */
  choices: string[] | null;
  announce(sentence: string): void;
  onType(): void;
}

function rowElements({ label, about, explains }: AnswerRow, options: RowOptions): RowElements {
  const before = h("td", { class: "today" });
  const field = fieldOf(label, options);
  const cell = h("td", { class: "value" }, field);
  const dimension = h("td", { class: "unit" });
  /** The text was changed since it was written: by the user, and handed in or not. */
  let [changed, handedIn] = [false, true];
  field?.addEventListener("input", () => ([changed, handedIn] = [true, false]));
  const copy = copyButton({ label: "Copy", spoken: `Copy ${label}`, look: "quiet", text: options.current }, options.announce);
  return {
    element: h(
      "tr",
      { title: about || null },
      h("th", { scope: "row" }, explains ? explained(explains, breakable(label)) : breakable(label)),
      options.withToday ? before : "",
      cell,
      dimension,
      h("td", {}, copy),
    ),
    write({ value, unit, today }, keep) {
      say(before, today);
      say(dimension, unit);
      if (!field) return say(cell, value);
      if (!handedIn || (changed && keep)) return;
      field.value = value;
      changed = false;
    },
    handIn: () => (handedIn = true),
    text: () => field?.value ?? null,
  };
}

function fieldOf(label: string, { choices, onType }: RowOptions): HTMLInputElement | HTMLSelectElement | null {
  if (!choices || choices.length === 1) return null;
  const attributes = { "aria-label": `${label}, new`, onchange: onType };
  if (choices.length > 1) return h("select", attributes, choices.map((text) => h("option", {}, text)));
  return h("input", { type: "text", autocomplete: "off", spellcheck: "false", ...attributes });
}
