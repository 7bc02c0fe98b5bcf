// The result of a range without its schedule: the verdict, the one setting, its cost at each point, remarks.
import type { OneSetting, Plant, RangeContent } from "../api/types.ts";
import { h, uniqueId } from "../dom.ts";
import { DASH, formatNumber, formatSetting, product, withMinus, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { plantWords } from "../words/plant.ts";
import { placeWords, settingsOfOne, settingWords, verdictOf, worstWords } from "../words/range.ts";
import { LEVEL_CLASS } from "../views/cards/verdict_card.ts";

export interface ResultCards {
  verdict: HTMLElement;
  one: HTMLElement;
  points: HTMLElement;
  warnings: HTMLElement;
  /** All except the verdict, which changes with the rows. `moved`: the result of moved rows, whose remarks then
      replace the others. */
  show(designed: RangeContent, moved: RangeContent | null, units: UnitNames): void;
}

/** The verdict of a range, in the place of the verdict on one loop. */
export function showRangeVerdict(card: HTMLElement, content: RangeContent): void {
  const finding = verdictOf(content);
  const [head, ...rest] = withMinus(finding.text).split(/(?<=\.)\s+(?=[A-Z])/);
  card.className = `verdict ${LEVEL_CLASS[finding.level]}`;
  card.replaceChildren(
    h("h2", { "data-code": finding.code }, head),
    ...(rest.length > 0 ? [h("p", {}, rest.join(" "))] : []),
  );
}

export function resultCards(): ResultCards {
  const verdict = h("section", { class: "verdict", "aria-label": "Verdict" });
  const one = h("section", { class: "card one-setting", "aria-label": "One setting" });
  const points = h("section", { class: "card range-table", "aria-label": "The points" });
  const warnings = h("section", { class: "card", "aria-label": "Remarks" });
  return {
    verdict,
    one,
    points,
    warnings,
    show(designed, moved, units) {
      showOne(one, designed, units);
      showPoints(points, designed, units);
      const remarks = (moved ?? designed).warnings;
      warnings.hidden = remarks.length === 0;
      warnings.replaceChildren(
        h("h2", {}, remarks.length === 1 ? "1 note" : `${remarks.length} notes`),
        h(
          "ul",
          { class: "notes" },
          remarks.map((remark) => h("li", {}, withMinus(remark.detail))),
        ),
      );
    },
  };
}

function showOne(card: HTMLElement, content: RangeContent, units: UnitNames): void {
  const { one, scheduling } = content;
  const why = content.why_null?.["one"];
  card.hidden = !one && !why;
  card.replaceChildren(
    h("h2", {}, "One setting for the whole range"),
    ...(one ? oneSetting(one, content, units) : [h("p", {}, why ?? "")]),
  );
  if (one)
    card.append(
      h(
        "ul",
        { class: "notes quiet-notes" },
        worstWords(content.worst.one, scheduling).map((text) => h("li", {}, text)),
      ),
    );
}

function oneSetting(one: OneSetting, { scheduling }: RangeContent, units: UnitNames): HTMLElement[] {
  const worst = formatNumber(one.worst_relative_IAE);
  const place = placeWords(one.worst_at, scheduling);
  return [
    h("p", { class: "setting-line" }, settingWords(settingsOfOne(one), units)),
    h(
      "p",
      {},
      `Its IAE is up to ${worst} times each point's own optimum, at ${place}; ${formatNumber(one.mean_relative_IAE)} times on average.`,
    ),
  ];
}

/** The optimum of each point by itself, and the cost of the one setting there. */
export function pointRows(content: RangeContent, units: UnitNames): { head: string[]; rows: string[][] } {
  const { name, unit } = content.scheduling;
  const IAE = product(units.y, units.time);
  const head = [
    withUnit(name || "at", unit ?? ""),
    "Plant",
    "Own optimum",
    withUnit("Own IAE", IAE),
    ...(content.one ? [withUnit("IAE", IAE), "IAE over own", "Ms"] : []),
  ];
  const rows = content.points.map(({ at, plant, model }, index) => {
    const point = content.one?.points[index];
    const fit = model ? `, fit ${formatNumber(model.fit_percent)} %` : "";
    return [
      formatSetting(at),
      `${placePlant(content, at, plant, units)}${fit}`,
      point ? settingWords({ ...point.own, Tf: point.own.filter?.Tf ?? 0 }, units) : DASH,
      formatNumber(point?.own_IAE),
      ...(content.one ? [formatNumber(point?.IAE), formatNumber(point?.relative_IAE), formatNumber(point?.Ms)] : []),
    ];
  });
  return { head, rows };
}

/** For a plant without a gain and times of its own, those of the curves at that place. */
function placePlant({ curves }: RangeContent, at: number, plant: Plant, units: UnitNames): string {
  const words = plantWords(plant, units);
  const index = curves.at.indexOf(at);
  if (typeof plant["K"] === "number" || index < 0) return words;
  const [K, T, L] = [curves.K[index], curves.T[index], curves.L[index]];
  return typeof K === "number" && typeof T === "number" ? plantWords({ type: "fopdt", K, T, L: L ?? 0 }, units) : words;
}

function showPoints(card: HTMLElement, content: RangeContent, units: UnitNames): void {
  const { head, rows } = pointRows(content, units);
  const id = uniqueId("points");
  const wordy = (index: number): string | null => (index === 1 || index === 2 ? "words" : null);
  card.replaceChildren(
    h("h2", { id }, "At each point"),
    h("p", { class: "hint" }, content.stated),
    h(
      "div",
      { class: "scroll", role: "region", "aria-label": "Figures at each point", tabindex: 0 },
      h(
        "table",
        { class: "figures", "aria-labelledby": id },
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            head.map((text, index) => h("th", { scope: "col", class: wordy(index) }, text)),
          ),
        ),
        h(
          "tbody",
          {},
          rows.map(([at, ...cells]) =>
            h(
              "tr",
              {},
              h("th", { scope: "row" }, at),
              cells.map((text, index) => h("td", { class: wordy(index + 1) }, text)),
            ),
          ),
        ),
      ),
    ),
  );
}
