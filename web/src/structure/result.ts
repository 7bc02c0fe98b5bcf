// The answer about a structure: verdict, settings to type, responses, peaks, figures next to what it is compared with.
import type { StructureAnswer, StructureRequest } from "../api/structure.ts";
import { levelChoices, structureResponses, structureSensitivities } from "../charts/structure.ts";
import { h } from "../dom.ts";
import { staleMark } from "../form/errors.ts";
import type { Frame } from "../plot/frame.ts";
import { plotGrid } from "../plot/grid.ts";
import { LEVEL_CLASS } from "../views/cards/verdict_card.ts";
import { copyButton } from "../views/copy.ts";
import { figuresTable } from "../views/figures_table.ts";
import { withMinus, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { conclusionWords, nameOfDesign, settingLines, settingsOfAnswer } from "../words/structure.ts";
import type { StructureDocuments } from "./documents.ts";
import type { OwnSettings } from "./own_settings.ts";
import type { BlockSettings } from "../words/structure.ts";
import { structureTables } from "./figures.ts";

export interface StructureResult {
  element: HTMLElement;
  /** `held`: a slider is held, and only what moves with it is drawn. */
  show(answer: StructureAnswer, request: StructureRequest, units: UnitNames, held: boolean): void;
  /** The current verdict, for speech. */
  sentence(): string;
  setStale(stale: boolean): void;
  /** There is no answer for the present structure. */
  clear(): void;
  hold(held: boolean): void;
  dispose(): void;
}

/** Of the steps of the run call by call. */
const sizesOf = ({ sampled }: StructureRequest): Record<string, number> => (sampled as { steps?: Record<string, number> } | undefined)?.steps ?? {};

/** Why there is no controller to compare with. */
function missingComparisons(answer: StructureAnswer): string[] {
  const why = ("why_null" in answer && answer.why_null) || {};
  return ["single", "pid"].flatMap((of) => (why[of] ? [`No ${nameOfDesign(of)}: ${why[of]}`] : []));
}

const NO_REMARKS = "There are no remarks on this answer.";

export function structureResult(announce: (sentence: string) => void, documents: StructureDocuments, own: OwnSettings): StructureResult {
  let shownPlots: string[] = [];
  let settings: BlockSettings[] = [];
  const verdict = h("section", { class: "verdict", "aria-label": "Verdict" });
  const rows = h("div", { class: "structure-settings" });
  const copy = copyButton({ label: "Copy all", text: () => settings.map(settingLines).join("\n\n") || null }, announce);
  const typing = h("section", { class: "card", "aria-label": "Settings to type" }, h("div", { class: "card-head" }, h("h2", {}, "Settings to type"), h("div", { class: "actions" }, copy, documents.actions)), documents.trouble, rows);
  const plots = plotGrid(announce);
  const tables = h("div", { class: "structure-tables" });
  const stale = staleMark(() => element);
  const element = h("div", { class: "structure-results", hidden: true }, stale.element, verdict, h("div", { class: "structure-typing" }, typing, own.element), plots.element, tables, documents.code);

  function showVerdict(answer: StructureAnswer, units: UnitNames): void {
    const [head, ...rest] = answer.verdict.map((conclusion) => conclusionWords(conclusion, units));
    verdict.className = `verdict ${head ? LEVEL_CLASS[head.level] : ""}`;
    verdict.replaceChildren(
      h("h2", { "data-code": head?.code }, withMinus(head?.text ?? NO_REMARKS)),
      ...missingComparisons(answer).map((why) => h("p", {}, why)),
      ...rest.map(({ code, level, text }) => h("p", { class: LEVEL_CLASS[level], "data-code": code }, withMinus(text))),
    );
  }

  function showSettings(answer: StructureAnswer, units: UnitNames): void {
    settings = settingsOfAnswer(answer, units);
    rows.replaceChildren(
      ...settings.map((one) =>
        h(
          "div",
          { class: "block-typing" },
          h("h3", {}, one.title, copyButton({ label: "Copy", spoken: `Copy ${one.title}`, look: "quiet", text: () => settingLines(one) }, announce)),
          h("dl", {}, one.settings.map(({ name, unit, text }) => h("div", {}, h("dt", {}, withUnit(name, unit)), h("dd", {}, text)))),
        ),
      ),
    );
  }

  function showPlots(answer: StructureAnswer, request: StructureRequest, units: UnitNames): void {
    const frames: [string, Frame | null][] = [...structureResponses(answer, units, sizesOf(request)), ["peaks", structureSensitivities(answer, units)], ["level", levelChoices(answer)]];
    const keys = frames.map(([key]) => key);
    // A new plot stands last: with other inputs all are made anew, in their order.
    if (keys.join() !== shownPlots.join()) for (const key of shownPlots) plots.show(key, null);
    for (const [key, frame] of frames) plots.show(key, frame);
    shownPlots = keys;
  }

  function showTables(answer: StructureAnswer, units: UnitNames): void {
    const cards = structureTables(answer, units).map(({ caption, columns, groups }) =>
      h(
        "div",
        { class: "card" },
        h("h2", {}, caption),
        figuresTable(caption, columns.map((entry) => ({ name: entry.title, entry, swatch: () => null })), groups),
      ),
    );
    tables.replaceChildren(...cards);
  }

  return {
    element,
    show(answer, request, units, held) {
      element.hidden = false;
      stale.set(false);
      showVerdict(answer, units);
      showPlots(answer, request, units);
      // Tables and settings below the plots would move them while a slider is held.
      if (held) return;
      showSettings(answer, units);
      own.show(answer);
      showTables(answer, units);
    },
    sentence: () => verdict.textContent ?? "",
    setStale: stale.set,
    clear() {
      element.hidden = true;
      stale.set(false);
    },
    hold: plots.hold,
    dispose: plots.dispose,
  };
}
