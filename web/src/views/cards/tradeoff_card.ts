// Servo against regulation on Design and Compare: charts and figures of controllers that have them, computed on request
// for others.
import { sentenceOf } from "../../api/client.ts";
import { tradeoffProfile, tradeoffsOf } from "../../api/evaluate.ts";
import type { Entry, Plant, Tradeoff } from "../../api/types.ts";
import {
  degradationFrame,
  isKnown,
  levelsFrame,
  profileOf,
  tradeoffFrame,
  tradeoffRows,
  whyUnknown,
} from "../../charts/tradeoff.ts";
import type { TradeoffItem } from "../../charts/tradeoff.ts";
import { h, uniqueId } from "../../dom.ts";
import { plotGrid } from "../../plot/grid.ts";
import { DASH, formatNumber } from "../../words/numbers.ts";

export interface TradeoffCard {
  element: HTMLElement;
  show(shown: { name: string; entry: Entry }[], plant: Plant | undefined, time: string): void;
  dispose(): void;
}

export function tradeoffCard(announce: (sentence: string) => void): TradeoffCard {
  let shown: { name: string; entry: Entry }[] = [];
  let plant: Plant | undefined;
  let time = "s";
  // Figures computed here, as long as the page shows this job.
  const computed = new WeakMap<Entry, Tradeoff>();
  const profiles = new Map<string, Tradeoff["profile"]>();
  const title = h("h2", { id: uniqueId("tradeoff") }, "Set point against load");
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const reason = h("p", { class: "hint", hidden: true });
  const button = h("button", { type: "button", onclick: () => void compute() }, "Compute the trade-off");
  const table = h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Trade-off figures" });
  const charts = plotGrid(announce);
  const element = h(
    "section",
    { class: "card tradeoff", "aria-labelledby": title.id },
    h(
      "div",
      { class: "tradeoff-head" },
      title,
      h(
        "p",
        { class: "hint" },
        "J_r and J_d are the errors of a controller after a set-point step and a load step, compared with the least that each could be alone. Deg is the cost of robustness. The curves are the tuning rule of Arrieta, Vilanova and Alfaro on this plant.",
      ),
      h("div", { class: "actions" }, button),
      trouble,
      reason,
      table,
    ),
    charts.element,
  );

  const items = (): TradeoffItem[] => {
    const profile = profiles.get(JSON.stringify(plant));
    return shown.map(({ name, entry }) => {
      const tradeoff = entry.tradeoff ?? computed.get(entry);
      return { name, tradeoff: tradeoff && profile ? { ...tradeoff, profile: tradeoff.profile ?? profile } : tradeoff };
    });
  };

  async function compute(): Promise<void> {
    if (!plant) return;
    const asked = plant;
    const missing = shown.filter(({ entry }) => !entry.tradeoff && !computed.has(entry) && entry.controller);
    trouble.hidden = true;
    button.disabled = true;
    try {
      if (missing.length > 0) {
        const answers = await tradeoffsOf(
          asked,
          missing.map(({ entry }) => entry.controller!),
        );
        answers.forEach((tradeoff, index) => tradeoff && computed.set(missing[index]!.entry, tradeoff));
      }
      if (!profileOf(items()) && items().some(isKnown))
        profiles.set(JSON.stringify(asked), await tradeoffProfile(asked));
    } catch (error) {
      trouble.textContent = sentenceOf(error);
      trouble.hidden = false;
    } finally {
      button.disabled = false;
      draw();
    }
  }

  function draw(): void {
    const list = items();
    const known = list.filter(isKnown);
    const reasons = [...new Set(list.map(whyUnknown).filter(Boolean))];
    reason.textContent = reasons.join(" ");
    reason.hidden = reasons.length === 0;
    const asked = list.every((item) => isKnown(item) || whyUnknown(item) !== "");
    button.hidden = asked && (known.length === 0 || profileOf(known) !== null);
    charts.show("plane", tradeoffFrame(known, time));
    charts.show("degradation", degradationFrame(known));
    charts.show("levels", levelsFrame(known, time));
    table.hidden = known.length === 0;
    table.replaceChildren(...(known.length > 0 ? [figuresTable(known, time)] : []));
  }

  return {
    element,
    show(next, on, unit) {
      time = unit;
      shown = next.filter(({ entry }) => entry.controller && !entry.error);
      plant = on;
      // Without a first-order model there is nothing to compare with.
      element.hidden = shown.length === 0 || !plant;
      trouble.hidden = true;
      draw();
    },
    dispose: charts.dispose,
  };
}

const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** One column for each controller, two if its plant is not the model itself. */
function figuresTable(items: TradeoffItem[], time: string): HTMLElement {
  const columns = items.flatMap(({ name, tradeoff }) => {
    const { model, plant } = tradeoff ?? {};
    if (!model || !plant || same(model, plant)) return [{ name, figures: model ?? plant }];
    return [
      { name: `${name}, on the model`, figures: model },
      { name: `${name}, on the plant`, figures: plant },
    ];
  });
  return h(
    "table",
    { class: "figures" },
    h("caption", { class: "visually-hidden" }, "Figures of the trade-off"),
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        h("td", {}),
        columns.map((column) => h("th", { scope: "col" }, column.name)),
      ),
    ),
    h(
      "tbody",
      {},
      tradeoffRows(time).map((row) =>
        h(
          "tr",
          {},
          h("th", { scope: "row", class: "explained" }, row.label, h("span", {}, row.meaning)),
          columns.map(({ figures }) => {
            const value = figures?.[row.name];
            return typeof value === "number"
              ? h("td", {}, formatNumber(value))
              : h("td", { title: figures?.why_null?.[row.name] ?? "The service gave no figure." }, DASH);
          }),
        ),
      ),
    ),
  );
}
