// "Replay of the record" on Design: the recorded time with the drawn controllers, as a plot among the others and as
// figures, or the reason why it is not known.
import type { Entry, Result } from "../../api/types.ts";
import type { Drawn } from "../../charts/drawn.ts";
import { replayFrame, withReplays } from "../../charts/replay.ts";
import { h, uniqueId } from "../../dom.ts";
import type { PlotGrid } from "../../plot/grid.ts";
import { swatch } from "../../plot/marks.ts";
import { figureUnit } from "../../words/figure_units.ts";
import { formatNumber, withUnit } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";

export interface ReplayCard {
  element: HTMLElement;
  /** `result`: of the job. `drawn`: its entries, or changed ones. Hides itself for a result without a record. */
  show(result: Result, drawn: Drawn[], units: UnitNames): void;
}

type Replay = NonNullable<Entry["replay"]>;

/** The reason why a design on the screen has no replay. */
export const CHANGED = "Changed settings are not replayed; a design is replayed when it is kept.";

/** `plots`: the grid for its plot. */
export function replayCard(plots: PlotGrid): ReplayCard {
  /** The replays on the card: they do not change while a slider moves. */
  let shown: unknown[] = [];
  const title = h("h2", { id: uniqueId("replay") }, "Replay of the record");
  const about = h("p", { class: "hint" });
  const table = h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Figures of the replay" });
  const reasons = h("ul", { class: "notes" });
  const element = h(
    "section",
    { class: "card replay", "aria-labelledby": title.id, hidden: true },
    title,
    about,
    table,
    reasons,
  );

  return {
    element,
    show(result, entries, units) {
      const recorded = result.replay;
      const drawn = withReplays(result, entries);
      const lines = drawn.flatMap(({ index, name, look, entry }) => [index, name, look, entry.replay]);
      const next = [recorded, units.y, units.u, units.time, ...lines];
      if (next.length === shown.length && next.every((value, at) => value === shown[at])) return;
      shown = next;
      element.hidden = !recorded;
      plots.show("replay", replayFrame(result, drawn, units));
      if (!recorded) return;
      const refused = recorded.refused?.text;
      about.textContent =
        refused ??
        "The set points and the disturbances of the record, with the drawn controllers on the model and within the known limits of u.";
      const replayed = drawn.filter(({ entry }) => entry.replay?.figures);
      table.hidden = Boolean(refused) || replayed.length === 0;
      if (!table.hidden) table.replaceChildren(figuresTable(recorded, replayed, units));
      const open = refused ? [] : drawn.filter(({ entry }) => entry.controller && !entry.replay?.figures);
      reasons.hidden = open.length === 0;
      reasons.replaceChildren(
        ...open.map(({ name, entry }) => h("li", {}, `${name}: ${entry.replay?.refused?.text ?? CHANGED}`)),
      );
    },
  };
}

function figuresTable(recorded: NonNullable<Result["replay"]>, replayed: Drawn[], units: UnitNames): HTMLElement {
  const columns: Pick<Replay, "figures">[] = [recorded, ...replayed.map(({ entry }) => entry.replay!)];
  const row = (label: string, values: string[]): HTMLElement =>
    h("tr", {}, h("th", { scope: "row" }, label), values.map((value) => h("td", {}, value)));
  const figures = (label: string, name: keyof NonNullable<Replay["figures"]>): HTMLElement =>
    row(withUnit(label, figureUnit("ReplayFigures", name, units)), columns.map((column) => formatNumber(column.figures?.[name])));
  return h(
    "table",
    { class: "figures" },
    h("caption", { class: "visually-hidden" }, "The recorded time, as it was and with each drawn controller"),
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        h("td", {}),
        h("th", { scope: "col" }, "recorded"),
        replayed.map(({ name, look }) => h("th", { scope: "col" }, swatch(look), name)),
      ),
    ),
    h(
      "tbody",
      {},
      row("IAE, divided by the record's", ["1", ...replayed.map(({ entry }) => ratioWords(entry.replay!))]),
      figures("IAE", "IAE"),
      figures("Largest error", "largest_error"),
      figures("Travel of u", "travel"),
      figures("Reversals of u", "reversals"),
    ),
  );
}

/** "0.71 (0.66 to 0.78)". */
const ratioWords = ({ IAE_ratio, IAE_ratio_low, IAE_ratio_high }: Replay): string =>
  `${formatNumber(IAE_ratio)} (${formatNumber(IAE_ratio_low)} to ${formatNumber(IAE_ratio_high)})`;
