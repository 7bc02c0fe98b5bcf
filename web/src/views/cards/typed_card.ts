// The settings in the product's own list: the values to type, the effect in the block, and the deviations.
import type { AsEntered, Entry, Product } from "../../api/types.ts";
import { breakable, h, uniqueId } from "../../dom.ts";
import {
  builtRows,
  builtTroubles,
  differenceSentence,
  evidenceSentence,
  noteTimes,
  productTitle,
  samplingSentences,
  splitNotes,
  typedRows,
  typedText,
} from "../../words/products.ts";
import type { BuiltRow, TypedRow } from "../../words/products.ts";
import { copyButton } from "../copy.ts";

export interface TypedSettings {
  product: Product;
  /** The owner of the settings. */
  name: string;
  entered: AsEntered;
  /** The ideal loop, and the implemented one if it is known; null for settings that are tried by hand. */
  judged: Pick<Entry, "robustness" | "performance" | "implemented" | "warnings" | "longest_sample_time" | "verdict"> | null;
  time: string;
}

export interface TypedCard {
  element: HTMLElement;
  show(typed: TypedSettings): void;
  /** The reason why there is nothing to type. */
  complain(sentence: string): void;
  hide(): void;
  setBusy(busy: boolean): void;
}

export function typedCard(announce: (sentence: string) => void, ...below: HTMLElement[]): TypedCard {
  let copied = "";
  const title = h("h2", { id: uniqueId("typed") });
  const whose = h("p", { class: "hint" });
  const list = h("table", { class: "typed" });
  const all = copyButton({ label: "Copy all with units", text: () => copied }, announce);
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const body = h("div", { class: "typed-body" });
  const rest = h("div", { class: "typed-rest" });
  body.append(whose, list, h("div", { class: "actions" }, all), rest);
  const element = h("section", { class: "card typed-card", "aria-labelledby": title.id, hidden: true }, title, trouble, body, below);

  function rowOf({ label, value, unit, about }: TypedRow): HTMLElement {
    const copy = copyButton({ label: "Copy", spoken: `Copy ${label}`, look: "quiet", text: () => value }, announce);
    return h(
      "tr",
      { title: about || null },
      h("th", { scope: "row" }, breakable(label)),
      h("td", { class: "value" }, value),
      h("td", { class: "unit" }, unit),
      h("td", {}, copy),
    );
  }

  return {
    element,
    show({ product, name, entered, judged, time }) {
      const heading = productTitle(product);
      const rows = typedRows(product, entered);
      copied = typedText(`${heading}: ${name}`, rows);
      title.textContent = `Type into ${heading}`;
      whose.textContent = `Settings of ${name}, by the names of its own list.`;
      list.replaceChildren(
        h("caption", { class: "visually-hidden" }, `Settings of ${name} for ${heading}`),
        h("tbody", {}, rows.map(rowOf)),
      );
      const { deviations, remarks } = splitNotes(entered.notes);
      const open = rest.querySelector("details")?.open ?? false;
      rest.replaceChildren(
        ...judgement(judged, time),
        ...noteList("Where this product differs", deviations),
        ...(entered.notes.length > 0 ? [h("p", { class: "hint" }, noteTimes(time))] : []),
        h("p", { class: "evidence" }, h("strong", {}, "Evidence. "), evidenceSentence(product.evidence)),
        remarks.length === 0
          ? ""
          : h("details", { open }, h("summary", {}, "How this was calculated"), noteItems(remarks)),
      );
      trouble.hidden = true;
      body.hidden = false;
      element.hidden = false;
    },
    complain(sentence) {
      title.textContent = "Nothing to type";
      trouble.textContent = sentence;
      trouble.hidden = false;
      body.hidden = true;
      element.hidden = false;
    },
    hide() {
      element.hidden = true;
    },
    setBusy(busy) {
      element.setAttribute("aria-busy", String(busy));
    },
  };
}

const noteItems = (notes: AsEntered["notes"]): HTMLElement =>
  h(
    "ul",
    { class: "notes" },
    notes.map((note) => h("li", {}, note.detail)),
  );

const noteList = (heading: string, notes: AsEntered["notes"]): HTMLElement[] =>
  notes.length === 0 ? [] : [h("h3", {}, heading), noteItems(notes)];

/** The implemented loop next to the ideal one, after the most important remarks. */
function judgement(judged: TypedSettings["judged"], time: string): HTMLElement[] {
  if (!judged) return [h("p", { class: "hint" }, "Manual settings: the figures next to the sliders are those of the loop with an ideal controller.")];
  const { implemented } = judged;
  const differs = implemented ? differenceSentence(implemented) : "";
  const sampling = samplingSentences(judged, time).join(" ");
  return [
    ...builtTroubles(judged).map((warning) =>
      h("p", { class: warning.code === "unstable-as-built" ? "trouble bad" : "trouble" }, warning.detail),
    ),
    ...(differs ? [h("p", { class: "trouble" }, differs)] : []),
    implemented
      ? builtTable(builtRows(judged, implemented))
      : h("p", { class: "hint" }, "The implemented loop was not evaluated: only the settings were converted."),
    ...(sampling ? [h("p", { class: "hint" }, sampling)] : []),
  ];
}

function builtTable(rows: BuiltRow[]): HTMLElement {
  const head = (text: string): HTMLElement => h("th", { scope: "col" }, text);
  return h(
    "table",
    { class: "figures built" },
    h("caption", { class: "visually-hidden" }, "The implemented loop compared with the ideal one"),
    h("thead", {}, h("tr", {}, h("td", {}), head("ideal"), head("implemented"), head("difference"))),
    h(
      "tbody",
      {},
      rows.map(({ label, ideal, built, difference, far }) =>
        h(
          "tr",
          {},
          h("th", { scope: "row" }, label),
          h("td", {}, ideal),
          h("td", {}, built),
          h("td", { class: far ? "far" : null }, difference),
        ),
      ),
    ),
  );
}
