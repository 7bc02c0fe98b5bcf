// "Was the test good enough?"
import type { Model } from "../../api/types.ts";
import { h, uniqueId } from "../../dom.ts";
import type { UnitNames } from "../../words/numbers.ts";
import { qualityOf } from "../../words/quality.ts";

export interface QualityCard {
  element: HTMLElement;
  show(model: Model, units: UnitNames): void;
}

export function qualityCard(): QualityCard {
  const title = h("h2", { id: uniqueId("quality") }, "Was the test good enough?");
  const body = h("div", { class: "stack" });
  const element = h("section", { class: "card quality", "aria-labelledby": title.id }, title, body);
  return {
    element,
    show(model, units) {
      const words = qualityOf(model, units);
      const open = body.querySelector("details")?.open ?? false;
      body.replaceChildren(
        h("p", { class: `verdict-line ${words.level}` }, words.head),
        ...(words.warnings.length > 0
          ? [
              h(
                "ul",
                { class: "notes" },
                words.warnings.map((warning) => h("li", {}, warning.detail)),
              ),
            ]
          : []),
        ...(words.notes.length > 0
          ? [
              h(
                "ul",
                { class: "notes quiet-notes" },
                words.notes.map((note) => h("li", {}, note)),
              ),
            ]
          : []),
        h(
          "details",
          { open },
          h("summary", {}, "Details of the record"),
          h(
            "dl",
            {},
            words.rows.flatMap(([name, text]) => [h("dt", {}, name), h("dd", {}, text)]),
          ),
        ),
      );
    },
  };
}
