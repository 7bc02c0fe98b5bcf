// The cards of a checked loop: its cause with the evidence, what to do first, and its figures.
import type { CheckContent } from "../api/types.ts";
import { h, uniqueId } from "../dom.ts";
import type { Child } from "../dom.ts";
import { explained } from "../reach/explanation.ts";
import { actionWords, changeWords, effortWords, gainWords, loopFigures, ownerWords, periodText, toneOf, verdictWords } from "../words/check.ts";
import type { LoopFigure, LoopFigures } from "../words/check.ts";
import { figureUnit } from "../words/figure_units.ts";
import { DASH, formatNumber, formatShare, withMinus, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { causeMark, listed, loopLink } from "./loop_name.ts";
import type { LoopAddress } from "./loop_name.ts";
import type { WorkRow } from "./columns.ts";
import { clusterOf } from "./periods.ts";

export interface LoopShown {
  content: CheckContent;
  row: WorkRow;
  units: UnitNames;
  address: LoopAddress;
}

const card = (title: string, look: string, ...content: Child[]): HTMLElement => {
  const heading = h("h2", { id: uniqueId("loop-card") }, title);
  return h("section", { class: `card ${look}`, "aria-labelledby": heading.id }, heading, content);
};

function linkTo({ content, address }: LoopShown, place: number): HTMLElement {
  return loopLink(place, content.loops[place]!.tag, address);
}

/** What the loop has to do with others. */
function neighbours(shown: LoopShown): HTMLElement[] {
  const { content, row } = shown;
  const cluster = clusterOf(content, row.place);
  const others = cluster?.loops.filter((place) => place !== row.place) ?? [];
  const together = cluster ? [h("li", {}, "It oscillates together with ", listed(others.map((place) => linkTo(shown, place))), ". ", cluster.detail)] : [];
  const pairs = content.cascades.flatMap(({ master, slave }) =>
    slave === row.place
      ? [h("li", {}, linkTo(shown, master), " gives it its set point.")]
      : master === row.place
        ? [h("li", {}, "It gives ", linkTo(shown, slave), " its set point.")]
        : [],
  );
  return [...together, ...pairs];
}

export function causeCard(shown: LoopShown): HTMLElement {
  const { content, row } = shown;
  const { cause, quality } = row.loop;
  const evidence = cause.evidence.map(({ detail }) => h("li", {}, withMinus(detail)));
  const others = cause.alternatives.map((verdict) => verdictWords(verdict)).join(", ");
  const heading = h("h2", { id: uniqueId("cause") }, causeMark(cause));
  // The reason for an open cause may be one of them.
  const remarks = quality.remarks.filter(({ detail }) => detail !== cause.why_open).map(({ detail }) => h("li", {}, withMinus(detail)));
  const relations = neighbours(shown);
  const part = (name: string, items: HTMLElement[]): Child => (items.length > 0 ? [h("h3", {}, name), h("ul", {}, items)] : "");
  return h(
    "section",
    { class: `verdict ${toneOf(cause)}`, "aria-labelledby": heading.id },
    heading,
    cause.why_open ? h("p", {}, withMinus(cause.why_open)) : "",
    evidence.length > 0 ? h("ul", {}, evidence) : "",
    others ? h("p", {}, `Not excluded: ${others}.`) : "",
    row.change ? part(`Since ${content.since}`, [h("li", {}, changeWords(row.change))]) : "",
    part("About the record", remarks),
    part("How the file was read", quality.readings.map((sentence) => h("li", {}, withMinus(sentence)))),
    part("Other loops", relations),
  );
}

/** `steps`: links to go on with the record. */
export function actionCard(shown: LoopShown, steps: HTMLElement[]): HTMLElement {
  const { loop, standing } = shown.row;
  const gain = gainWords(standing, loop, shown.units);
  const rows: [Child, Child][] = [
    ["Owner", ownerWords(loop.action.owner)],
    ["Effort", effortWords(standing.effort)],
    [explained("mending_gain", "Gain"), gain || [DASH, why(standing.why_null?.["share"])]],
    ...(typeof standing.money === "number" ? [[explained("mending_money", "Money per hour"), formatNumber(standing.money)] as [Child, Child]] : []),
    ...(standing.after === undefined ? [] : [["Mend first", linkTo(shown, standing.after)] as [Child, Child]]),
  ];
  return card(
    `What to do: ${actionWords(loop.action.code)}`,
    "loop-action",
    h("p", {}, withMinus(loop.action.detail)),
    h("dl", {}, rows.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])),
    steps.length > 0 ? h("p", { class: "actions" }, steps) : "",
  );
}

const why = (reason: string | undefined): Child => (reason ? h("span", { class: "hint" }, ` ${reason}`) : "");

const figureRow = ({ label, about, text, why: reason }: LoopFigure): HTMLElement =>
  h(
    "tr",
    {},
    h("th", { scope: "row" }, about ? explained(about, label) : label),
    h("td", {}, text, reason ? h("span", { class: "hint" }, ` ${reason}`) : ""),
  );

const figuresPart = ({ title, rows }: LoopFigures): HTMLElement =>
  h("tbody", {}, h("tr", { class: "group" }, h("th", { scope: "rowgroup", colspan: 2 }, title)), rows.map(figureRow));

export function figuresCard({ row, units }: LoopShown): HTMLElement {
  return card(
    "Figures",
    "loop-figures",
    oscillationTable(row, units),
    h("table", { class: "figures" }, h("caption", { class: "visually-hidden" }, "Figures of the loop"), loopFigures(row.loop, units).map(figuresPart)),
  );
}

function oscillationTable({ loop }: WorkRow, units: UnitNames): HTMLElement {
  const { periods } = loop.oscillation;
  if (periods.length === 0) return h("p", { class: "hint" }, "No regular oscillation was found.");
  const head = [
    explained("period", withUnit("Period", units.time)),
    explained("regularity", "Regularity"),
    explained("period_share", "Share (%)"),
    explained("amplitude", withUnit("Amplitude", figureUnit("LoopPeriod", "amplitude", units))),
  ];
  const rows = periods.map((period) =>
    h(
      "tr",
      {},
      h("th", { scope: "row" }, periodText(period)),
      h("td", {}, formatNumber(period.regularity, 2)),
      h("td", {}, formatShare(period.share)),
      h("td", {}, formatNumber(period.amplitude)),
    ),
  );
  return h(
    "div",
    { class: "scroll", role: "region", "aria-label": "Oscillations", tabindex: 0 },
    h(
      "table",
      { class: "figures" },
      h("caption", { class: "visually-hidden" }, "Regular oscillations of the error, the strongest first"),
      h("thead", {}, h("tr", {}, head.map((name) => h("th", { scope: "col" }, name)))),
      h("tbody", {}, rows),
    ),
  );
}
