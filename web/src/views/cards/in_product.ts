// The text next to settings in the user's product: what is wrong with them, and how the block computes them.
import type { AsEntered, Entry, Product } from "../../api/types.ts";
import { h } from "../../dom.ts";
import { builtRows, builtTroubles, differenceSentence, evidenceSentence, noteTimes, samplingSentences, splitNotes } from "../../words/products.ts";
import type { BuiltRow } from "../../words/products.ts";

/** The ideal loop, and where it is known the implemented one. */
export type Judged = Pick<Entry, "robustness" | "performance" | "implemented" | "warnings" | "longest_sample_time" | "verdict">;

/** The remarks that must not be missed, and the sample time that the loop allows. `judged`: null for settings that are tried by hand. */
export function productTroubles(judged: Judged | null, time: string): HTMLElement[] {
  if (!judged) return [h("p", { class: "hint" }, "Manual settings: the figures next to the sliders are those of the loop with an ideal controller.")];
  const sampling = samplingSentences(judged, time).join(" ");
  const differs = judged.implemented ? differenceSentence(judged.implemented) : "";
  return [
    ...builtTroubles(judged).map((warning) =>
      h("p", { class: warning.code === "unstable-as-built" ? "trouble bad" : "trouble" }, warning.detail),
    ),
    ...(differs ? [h("p", { class: "trouble" }, differs)] : []),
    ...(sampling ? [h("p", { class: "hint" }, sampling)] : []),
  ];
}

/** The implemented loop next to the ideal one, the deviations of the block, and the evidence for its description. */
export function productDetails(product: Product, entered: AsEntered, judged: Judged | null, time: string): HTMLElement[] {
  const { deviations, remarks } = splitNotes(entered.notes);
  return [
    ...(judged ? implementedLoop(judged) : []),
    ...noteList("Where this product differs", deviations),
    ...(entered.notes.length > 0 ? [h("p", { class: "hint" }, noteTimes(time))] : []),
    h("p", { class: "evidence" }, h("strong", {}, "Evidence. "), evidenceSentence(product.evidence)),
    ...noteList("How this was calculated", remarks),
  ];
}

const noteItems = (notes: AsEntered["notes"]): HTMLElement =>
  h(
    "ul",
    { class: "notes" },
    notes.map((note) => h("li", {}, note.detail)),
  );

const noteList = (heading: string, notes: AsEntered["notes"]): HTMLElement[] =>
  notes.length === 0 ? [] : [h("h3", {}, heading), noteItems(notes)];

const implementedLoop = (judged: Judged): HTMLElement[] => [
  judged.implemented
    ? builtTable(builtRows(judged, judged.implemented))
    : h("p", { class: "hint" }, "The implemented loop was not evaluated: only the settings were converted."),
];

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
