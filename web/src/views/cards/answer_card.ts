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
  /** They are those of everything that was typed and moved; else newer ones are on their way, and what was typed stays. */
  current: boolean;
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
  /** The texts of the last typing that no answer has shown yet; null: there are none. */
  let sent: string[] | null = null;
  /** The values are fields in which others can be typed. */
  let typing = false;
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
    const before = new Map(lines.map((line) => [line.name, line]));
    const focused = lines.find(({ element: line }) => line.contains(document.activeElement))?.name;
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
    for (const line of lines) line.resume(before.get(line.name), line.name === focused);
  }

  function toggle(): void {
    typing = !typing;
    change.setAttribute("aria-pressed", String(typing));
    refuse("");
    sent = null;
    if (shown) showRows({ ...shown, current: true });
    if (typing) list.querySelector<HTMLElement>("input, select")?.focus();
  }

  function typed(): void {
    if (!shown) return;
    const { rows } = shown;
    const texts = rows.map(({ value }, index) => lines[index]!.text() ?? value);
    const known = sent ?? rows.map(({ value }) => value);
    if (texts.every((text, index) => text === known[index])) return refuse("");
    sent = texts;
    void onType(Object.fromEntries(rows.map(({ name }, index) => [name, texts[index]!])));
  }

  function refuse(sentence: string): void {
    say(refused, sentence);
    refused.hidden = sentence === "";
  }

  function showRows({ rows, current }: Answer): void {
    const withToday = rows.some(({ today }) => today !== "");
    const wanted = JSON.stringify([withToday, typing, rows.map(({ label, about, explains }) => [label, about, explains])]);
    if (wanted !== made) make(rows, withToday);
    made = wanted;
    if (current) sent = null;
    rows.forEach((row, index) => lines[index]!.write(row, current));
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
      showRows(answer);
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
  name: string;
  element: HTMLElement;
  /** A text that is being typed is never rewritten; one that was typed only by the values of that typing. */
  write(row: AnswerRow, current: boolean): void;
  /** Goes on with what was typed in the row that stood in its place. */
  resume(before: RowElements | undefined, focused: boolean): void;
  typed: "no" | "left" | "being typed";
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

function rowElements({ name, label, about, explains }: AnswerRow, options: RowOptions): RowElements {
  const before = h("td", { class: "today" });
  const field = fieldOf(label, options);
  const cell = h("td", { class: "value" }, field);
  const dimension = h("td", { class: "unit" });
  const copy = copyButton({ label: "Copy", spoken: `Copy ${label}`, look: "quiet", text: options.current }, options.announce);
  const row: RowElements = {
    name,
    typed: "no",
    element: h(
      "tr",
      { title: about || null },
      h("th", { scope: "row" }, explains ? explained(explains, breakable(label)) : breakable(label)),
      options.withToday ? before : "",
      cell,
      dimension,
      h("td", {}, copy),
    ),
    write({ value, unit, today }, current) {
      say(before, today);
      say(dimension, unit);
      if (!field) return say(cell, value);
      if (row.typed === "being typed" || (row.typed === "left" && !current)) return;
      row.typed = "no";
      if (field.value !== value) field.value = value;
    },
    resume(other, focused) {
      const text = other?.text() ?? null;
      if (!field) return;
      if (other && other.typed !== "no" && text !== null) {
        row.typed = other.typed;
        field.value = text;
      }
      if (focused) field.focus();
    },
    text: () => field?.value ?? null,
  };
  field?.addEventListener("input", () => (row.typed = "being typed"));
  field?.addEventListener("change", () => (row.typed = "left"));
  return row;
}

function fieldOf(label: string, { choices, onType }: RowOptions): HTMLInputElement | HTMLSelectElement | null {
  if (!choices || choices.length === 1) return null;
  const attributes = { "aria-label": `${label}, new`, onchange: onType };
  if (choices.length > 1) return h("select", attributes, choices.map((text) => h("option", {}, text)));
  return h("input", { type: "text", autocomplete: "off", spellcheck: "false", ...attributes });
}
