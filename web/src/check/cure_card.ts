// New settings for a loop whose cause is its tuning, next to today's; or the test that would show them; or what ends the
// cycle of a sticking valve until it is repaired. Asked for when the loop's page is opened: it takes up to some seconds.
import { sentenceOf } from "../api/client.ts";
import { cureOf } from "../api/check.ts";
import type { CheckLoop, LoopCheck, LoopCure, Units } from "../api/types.ts";
import { h } from "../dom.ts";
import type { Child } from "../dom.ts";
import { explained } from "../reach/explanation.ts";
import type { ExplainedName } from "../words/explained.ts";
import { figureUnit } from "../words/figure_units.ts";
import { DASH, formatNumber, formatSetting, unitNames, withMinus, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";

export interface CureCard {
  element: HTMLElement;
  /** `sent`: the loop with its record; null if it is not known. Hidden unless the loop needs tuning or the repair of a valve. */
  show(loop: LoopCheck, sent: CheckLoop | null, units: Units | undefined): void;
  dispose(): void;
}

const TITLE = "New settings";
const UNTIL_REPAIR = "Until the valve is repaired";

type Controller = NonNullable<LoopCure["settings"]>;

const SETTINGS: readonly (readonly [ExplainedName, (controller: Controller) => unknown])[] = [
  ["Kp", ({ Kp }) => Kp],
  ["Ti", ({ Ti }) => Ti],
  ["Td", ({ Td }) => Td],
  ["Tf", ({ filter }) => filter?.Tf],
  ["b", ({ b }) => b],
];

const number = (value: unknown): number | null => (typeof value === "number" ? value : null);

function settingsTable({ today, settings }: LoopCure, units: UnitNames): HTMLElement | null {
  const sides = [today, settings].filter((side): side is Controller => side !== undefined);
  if (sides.length === 0) return null;
  const heads = [...(today ? ["Today"] : []), ...(settings ? ["New"] : [])];
  const unitOf = (name: string): string => (name === "Kp" ? figureUnit("IdealController", "Kp", units) : name === "b" ? "" : units.time);
  const rows = SETTINGS.filter(([, read]) => sides.some((side) => number(read(side)))).map(([name, read]) =>
    h(
      "tr",
      {},
      h("th", { scope: "row" }, explained(name, withUnit(name, unitOf(name)))),
      sides.map((side) => h("td", {}, formatSetting(number(read(side))))),
    ),
  );
  return h(
    "table",
    { class: "figures" },
    h("caption", { class: "visually-hidden" }, "Settings, ideal form"),
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Ideal form"), heads.map((head) => h("th", { scope: "col" }, head)))),
    h("tbody", {}, rows),
  );
}

function testList({ test }: LoopCure, units: UnitNames): HTMLElement | null {
  if (!test) return null;
  const signal = test.kind === "output-steps" ? "u" : "y";
  const unit = units[signal] ? ` ${units[signal]}` : "";
  const rows: [string, Child][] = [
    [test.kind === "output-steps" ? "Steps of the output, in manual" : "Steps of the set point, in automatic", `${test.steps}`],
    ["Size of each", [`${formatNumber(test.size)}${unit}`, test.beyond_seen ? h("span", { class: "hint" }, " more than the range in the record: ask operations first") : ""]],
    ["Held for", `${formatNumber(test.hold)} ${units.time}`],
    ["Duration of the test", `${formatNumber(test.duration)} ${units.time}`],
  ];
  return h("dl", {}, rows.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
}

function figureList(cure: LoopCure): HTMLElement | null {
  if (!cure.settings) return null;
  const text = (name: "worst_Ms" | "error_ratio"): Child => {
    const value = cure[name];
    return typeof value === "number" ? formatNumber(value) : [DASH, h("span", { class: "hint" }, ` ${cure.why_null?.[name] ?? ""}`)];
  };
  return h(
    "dl",
    {},
    [h("dt", {}, explained("worst_Ms", "Worst Ms")), h("dd", {}, text("worst_Ms"))],
    [h("dt", {}, explained("error_ratio", "Mean error, new over old")), h("dd", {}, text("error_ratio"))],
  );
}

function titleOf(cure: LoopCure): string {
  if (cure.valve) return UNTIL_REPAIR;
  return cure.settings ? TITLE : "The test that is missing for new settings";
}

function stopList({ valve }: LoopCure): HTMLElement | null {
  if (!valve || valve.stops.length === 0) return null;
  return h("ul", {}, valve.stops.map(({ detail }) => h("li", {}, withMinus(detail))));
}

export function cureCard(announce: (sentence: string) => void): CureCard {
  const heading = h("h2", { id: "loop-cure" }, TITLE);
  const body = h("div", { class: "stack" });
  const element = h("section", { class: "card loop-cure", "aria-labelledby": "loop-cure", hidden: true }, heading, body);
  const known = new WeakMap<CheckLoop, LoopCure>();
  let asked: AbortController | null = null;

  function fill(cure: LoopCure | null, units: UnitNames): void {
    element.hidden = cure === null;
    if (!cure) return;
    heading.textContent = titleOf(cure);
    body.replaceChildren(
      ...[settingsTable(cure, units), figureList(cure), testList(cure, units), stopList(cure)].filter((part) => part !== null),
      h("p", { class: "hint" }, withMinus(cure.detail)),
    );
  }

  async function ask(sent: CheckLoop, units: Units | undefined, title: string): Promise<void> {
    const mine = new AbortController();
    asked = mine;
    heading.textContent = title;
    body.replaceChildren(h("p", { class: "hint" }, "Looking for settings..."));
    element.hidden = false;
    try {
      const cure = await cureOf(sent, units, mine.signal);
      if (mine.signal.aborted) return;
      if (cure) known.set(sent, cure);
      fill(cure, unitNames(units));
      if (cure) announce(`${heading.textContent}. ${cure.detail}`);
    } catch (error) {
      if (mine.signal.aborted) return;
      const again = h("button", { type: "button", onclick: () => void ask(sent, units, title) }, "Try again");
      body.replaceChildren(h("p", {}, sentenceOf(error)), h("p", { class: "actions" }, again));
    }
  }

  return {
    element,
    show(loop, sent, units) {
      asked?.abort();
      const found = loop.cure ?? (sent ? known.get(sent) : undefined);
      if (found) return fill(found, unitNames(units));
      element.hidden = true;
      if (sent && loop.action.code === "retune") void ask(sent, units, TITLE);
      if (sent && loop.action.code === "repair-valve") void ask(sent, units, UNTIL_REPAIR);
    },
    dispose: () => asked?.abort(),
  };
}
