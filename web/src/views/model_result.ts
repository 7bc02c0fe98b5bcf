// The identification from the record: the model, its fit, the other candidates.
import type { Model } from "../api/types.ts";
import { h } from "../dom.ts";
import { plantFormula, rounded } from "../form/formula.ts";
import { formatError, formatNumber } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { parameterUnit, plantTitle, plantWords } from "../words/plant.ts";

export function modelResult(model: Model, units: UnitNames): HTMLElement {
  const parameters = Object.entries(model.plant).filter(
    (pair): pair is [string, number] => typeof pair[1] === "number",
  );
  const candidates = model.candidates ?? [];
  return h(
    "section",
    { class: "card", "aria-labelledby": "model-title" },
    h("h2", { id: "model-title" }, "Model from the record"),
    plantFormula(rounded(model.plant)),
    h(
      "table",
      { class: "figures" },
      h("caption", { class: "visually-hidden" }, "Identified parameters"),
      h(
        "thead",
        {},
        h("tr", {}, h("td", {}), h("th", { scope: "col" }, "value"), h("th", { scope: "col" }, "± std. error")),
      ),
      h(
        "tbody",
        {},
        h("tr", {}, h("th", { scope: "row" }, "Fit (%)"), h("td", {}, formatNumber(model.fit_percent)), h("td", {})),
        parameters.map(([name, value]) => {
          const unit = parameterUnit(model.plant, name, units);
          return h(
            "tr",
            {},
            h("th", { scope: "row" }, unit ? `${name} (${unit})` : name),
            h("td", {}, formatNumber(value, 4)),
            h("td", {}, formatError(model.standard_errors?.[name], value)),
          );
        }),
      ),
    ),
    model.choice_reason ? h("p", { class: "hint" }, model.choice_reason) : null,
    candidates.length > 1
      ? h(
          "details",
          {},
          h("summary", {}, `${candidates.length} candidates`),
          h(
            "ul",
            { class: "plain" },
            candidates.map((candidate) =>
              h(
                "li",
                {},
                `${plantTitle(candidate.plant.type)}: fit ${formatNumber(candidate.fit_percent)} %, ${plantWords(candidate.plant, units)}`,
              ),
            ),
          ),
        )
      : null,
    (model.warnings ?? []).length > 0
      ? h(
          "ul",
          { class: "notes" },
          (model.warnings ?? []).map((warning) => h("li", {}, warning.detail)),
        )
      : null,
  );
}
