// The oscillation of a relay test in figures, and the measured points of the frequency response.
import type { FrequencyPoint, LimitCycle, UltimatePoint } from "../../api/types.ts";
import { h, uniqueId } from "../../dom.ts";
import { cycleRows } from "../../words/cycle.ts";
import { formatNumber, quotient, withUnit } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";

export interface CycleCard {
  element: HTMLElement;
  show(
    cycle: LimitCycle | undefined,
    ultimate: UltimatePoint | null | undefined,
    points: FrequencyPoint[] | undefined,
    units: UnitNames,
  ): void;
}

export function cycleCard(): CycleCard {
  const title = h("h2", { id: uniqueId("cycle") }, "Oscillation");
  const body = h("div", { class: "stack" });
  const element = h("section", { class: "card cycle", "aria-labelledby": title.id, hidden: true }, title, body);
  return {
    element,
    show(cycle, ultimate, points = [], units) {
      element.hidden = !cycle && points.length === 0;
      title.textContent = cycle ? "Limit cycle" : "Frequency response";
      body.replaceChildren(
        ...(cycle ? [cycleTable(cycle, ultimate, units)] : []),
        ...(points.length > 0 ? [pointsTable(points, units, !cycle)] : []),
      );
    },
  };
}

function cycleTable(cycle: LimitCycle, ultimate: UltimatePoint | null | undefined, units: UnitNames): HTMLElement {
  return h(
    "table",
    { class: "figures" },
    h("caption", { class: "visually-hidden" }, "Limit cycle"),
    h(
      "tbody",
      {},
      cycleRows(cycle, ultimate, units).map((row) =>
        h(
          "tr",
          {},
          h("th", { scope: "row", class: "explained" }, row.label, h("span", {}, row.meaning)),
          h("td", {}, row.text),
        ),
      ),
    ),
  );
}

function pointsTable(points: FrequencyPoint[], units: UnitNames, open: boolean): HTMLElement {
  const gain = quotient(units.y, units.u);
  return h(
    "details",
    { open },
    h("summary", {}, `${points.length} measured ${points.length === 1 ? "point" : "points"} of G(jω)`),
    h(
      "div",
      { class: "scroll", tabindex: 0, role: "region", "aria-label": "Measured points of the frequency response" },
      h(
        "table",
        { class: "figures" },
        h("caption", { class: "visually-hidden" }, "Measured points of the frequency response"),
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            [`ω (rad/${units.time})`, withUnit("Re G", gain), withUnit("Im G", gain), "± std"].map((name) =>
              h("th", { scope: "col" }, name),
            ),
          ),
        ),
        h(
          "tbody",
          {},
          points.map((point) =>
            h(
              "tr",
              {},
              [formatNumber(point.omega, 4), formatNumber(point.re, 4), formatNumber(point.im, 4)].map((text) =>
                h("td", {}, text),
              ),
              h("td", {}, formatNumber(point.std, 2)),
            ),
          ),
        ),
      ),
    ),
  );
}
