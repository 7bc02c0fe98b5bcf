// Revised IMC on Design: a slider for its one parameter, the effect of this parameter, and the figures next to those of
// the full controller.
import { ApiError, sentenceOf } from "../../api/client.ts";
import type { Entry, Plant } from "../../api/types.ts";
import { fullControllerFrame, interpolate, rimcFrame, rimcRows } from "../../charts/rimc.ts";
import { h, uniqueId } from "../../dom.ts";
import { FormErrors } from "../../form/errors.ts";
import { slider } from "../../form/slider.ts";
import { plotGrid } from "../../plot/grid.ts";
import { DASH, formatNumber } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";

export interface RimcCard {
  element: HTMLElement;
  /** Hides itself if the entry is of another method. */
  show(entry: Entry, model: Plant | undefined, units: UnitNames): void;
  dispose(): void;
}

/** `retune`: designs again with this lambda and shows the answer. */
export function rimcCard(announce: (sentence: string) => void, retune: (lambda: number) => Promise<void>): RimcCard {
  let shown: { entry: Entry; tau: number; units: UnitNames } | null = null;
  const errors = new FormErrors();
  const title = h("h2", { id: uniqueId("rimc") }, "Revised IMC: speed against robustness");
  const table = h("div", {});
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const drawButton = h(
    "button",
    { type: "button", onclick: () => void release(shown!.entry.rimc!.lambda) },
    "Draw the chart",
  );
  const charts = plotGrid(announce);
  const lambda = slider(
    {
      label: "λ",
      hint: "Left is faster, right more robust. The design follows when you release the slider.",
      log: true,
      pointer: () => null,
      spoken: (value) => `lambda ${formatNumber(value)}${shown ? ` ${shown.units.time}${figuresAt(value)}` : ""}`,
      onMove: () => draw(),
      onRelease: (value) => void release(value),
    },
    errors,
  );
  const element = h(
    "section",
    { class: "card rimc", "aria-labelledby": title.id, hidden: true },
    h(
      "div",
      { class: "rimc-head" },
      title,
      h("div", { class: "rimc-controls" }, lambda.element, drawButton, trouble),
      table,
    ),
    charts.element,
  );

  /** The figures of the curve at a lambda that was not designed yet. */
  function figuresAt(value: number): string {
    const curve = shown?.entry.rimc?.disturbance_peak_curve;
    if (!shown || !curve) return "";
    const Ms = interpolate(curve.lambda_over_tau, curve.Ms, value / shown.tau);
    return Ms === null ? "" : `, Ms ${formatNumber(Ms)}`;
  }

  async function release(value: number): Promise<void> {
    trouble.hidden = true;
    element.setAttribute("aria-busy", "true");
    try {
      await retune(value);
    } catch (error) {
      const first = error instanceof ApiError ? error.problem.errors?.[0]?.detail : undefined;
      trouble.textContent = first ?? sentenceOf(error);
      trouble.hidden = false;
      if (shown?.entry.rimc) lambda.set(shown.entry.rimc.lambda);
      draw();
    } finally {
      element.removeAttribute("aria-busy");
    }
  }

  function draw(): void {
    if (!shown?.entry.rimc) return;
    const { entry, tau, units } = shown;
    charts.show("curve", rimcFrame(entry.rimc!, tau, lambda.value(), units));
    charts.show("load", fullControllerFrame(entry.rimc!, entry.responses?.load, units));
  }

  function showTable(): void {
    const { entry, units } = shown!;
    const rows = rimcRows(entry, units);
    const full = rows.some((row) => row.full !== null && row.label !== rows[0]!.label);
    table.replaceChildren(
      h(
        "table",
        { class: "figures" },
        h("caption", { class: "visually-hidden" }, "Figures on the model of the design"),
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            h("td", {}),
            h("th", { scope: "col" }, "PID"),
            full ? h("th", { scope: "col" }, "full controller") : null,
          ),
        ),
        h(
          "tbody",
          {},
          rows.map((row) =>
            h(
              "tr",
              {},
              h(
                "th",
                { scope: "row", class: "explained" },
                row.label,
                h("span", {}, row.pid === null ? row.why || row.meaning : row.meaning),
              ),
              h("td", {}, row.pid === null ? DASH : formatNumber(row.pid)),
              full ? h("td", {}, row.full === null ? "" : formatNumber(row.full)) : null,
            ),
          ),
        ),
      ),
    );
  }

  return {
    element,
    show(entry, model, units) {
      const rimc = entry.rimc;
      element.hidden = !rimc;
      if (!rimc) return;
      const T = entry.reduced_model?.["T"] ?? model?.["T"];
      const tau = typeof T === "number" && T > 0 ? T : NaN;
      const same = shown?.entry === entry;
      shown = { entry, tau, units };
      lambda.field.setUnit(units.time);
      const curve = rimc.disturbance_peak_curve?.lambda_over_tau ?? [];
      drawButton.hidden = curve.length > 1;
      lambda.element.hidden = curve.length < 2 || Number.isNaN(tau);
      if (!same) {
        if (curve.length > 1) lambda.setLimits(curve[0]! * tau, curve[curve.length - 1]! * tau);
        lambda.set(rimc.lambda);
        showTable();
      }
      draw();
    },
    dispose: charts.dispose,
  };
}
