// Two-level tuning on Design: the classical settings, the PID that follows the nonlinear controller, and its quality.
import type { Controller, EmulatedScenario, Entry, Plant, Tuned } from "../../api/types.ts";
import { costOf, emulationFrame, LEVEL_ONE_LOOKS } from "../../charts/emulation.ts";
import type { OwnRun } from "../../charts/emulation.ts";
import { h, uniqueId } from "../../dom.ts";
import { choiceField } from "../../form/controls.ts";
import { FormErrors } from "../../form/errors.ts";
import { plotGrid } from "../../plot/grid.ts";
import {
  boundWords,
  emulationFacts,
  levelRows,
  scenarioNotes,
  scenarioWords,
  tunedParameters,
  unitOf,
} from "../../words/emulation.ts";
import type { LevelRow } from "../../words/emulation.ts";
import { DASH, formatNumber, formatSetting, withUnit } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";
import { manualSettings } from "../manual_settings.ts";

const formatBound = (value: number): string => formatSetting(Number(value.toPrecision(3)));

export interface EmulationCard {
  element: HTMLElement;
  /** Hides itself if the entry is of another method. */
  show(entry: Entry, plant: Plant | undefined, units: UnitNames): void;
  dispose(): void;
}

/** `onTry`: receives settings that are tried by hand; null when they are no longer tried. */
export function emulationCard(
  announce: (sentence: string) => void,
  onTry: (controller: Controller | null) => void,
): EmulationCard {
  let shown: { entry: Entry; plant: Plant | undefined; units: UnitNames } | null = null;
  /** Indices of the classical settings that are drawn, in the order in which they were chosen. */
  let chosen: number[] = [];
  let own: OwnRun | null = null;
  const title = h("h2", { id: uniqueId("emulation") }, "Emulation of a nonlinear controller");
  const judgement = h("p", {});
  const table = h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Settings of both levels" });
  const facts = h("dl", {});
  const note = h("p", { class: "hint", hidden: true });
  const charts = plotGrid(announce);
  const scenario = choiceField({ label: "Scenario", choices: [], pointer: () => null }, new FormErrors());
  const manual = manualSettings({
    onRun(run) {
      own = run;
      sayCost();
      draw();
    },
    onTry,
  });
  scenario.input.addEventListener("change", () => manual.setScenario(scenarioShown()));
  const element = h(
    "section",
    { class: "card emulation", "aria-labelledby": title.id, hidden: true },
    h("div", { class: "emulation-head" }, title, judgement, table, facts, scenario.element, note, manual.element),
    charts.element,
  );

  const scenarioShown = (): EmulatedScenario | undefined =>
    shown?.entry.emulation?.scenarios?.[Number(scenario.input.value) || 0];

  /** Compared with the same sum over the emulating PID's own samples, so that both have the same accuracy. */
  function sayCost(): void {
    const emulation = shown?.entry.emulation;
    const at = scenarioShown();
    if (!own || !emulation || !at?.t || !at.y || !at.u) return manual.say("");
    const [tried, best] = [costOf(emulation, at, own), costOf(emulation, at, { t: at.t, y: at.y, u: at.u })];
    manual.say(tried === null ? "" : `J of this scenario ${formatNumber(tried)}; of the optimum ${formatNumber(best)}`);
  }

  function draw(): void {
    const emulation = shown?.entry.emulation;
    if (!shown || !emulation) return;
    const at = scenarioShown();
    note.textContent = at ? scenarioNotes(at) : "";
    note.hidden = note.textContent === "";
    const rows = levelRows(shown.entry);
    const names = chosen.map((index) => ({ index, name: rows[index]!.title }));
    charts.show(
      "run",
      emulationFrame(emulation, Number(scenario.input.value) || 0, names, shown.plant, shown.units, own),
    );
  }

  function choose(index: number, draws: boolean): void {
    chosen = draws ? [...chosen, index] : chosen.filter((other) => other !== index);
    for (const box of table.querySelectorAll<HTMLInputElement>("input"))
      box.disabled = !box.checked && chosen.length >= LEVEL_ONE_LOOKS.length;
    // Only the first scenario is simulated with them.
    if (scenario.input.value !== "0" && draws) {
      scenario.input.value = "0";
      manual.setScenario(scenarioShown());
    }
    draw();
  }

  function showTable(): void {
    const { entry, units } = shown!;
    const emulation = entry.emulation!;
    const parameters = tunedParameters(emulation);
    const head = (text: string): HTMLElement => h("th", { scope: "col" }, text);
    table.replaceChildren(
      h(
        "table",
        { class: "figures levels" },
        h("caption", { class: "visually-hidden" }, "Classical settings of level 1, the emulating settings of level 2"),
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            h("th", { scope: "col" }, "Settings"),
            parameters.map((name) => head(withUnit(name, unitOf(name, units)))),
            head("J"),
          ),
        ),
        h(
          "tbody",
          {},
          levelRows(entry).map((row) => settingsRow(row, entry)),
          boundsRow(entry),
        ),
      ),
    );
  }

  function settingsRow(row: LevelRow, entry: Entry): HTMLElement {
    const emulation = entry.emulation!;
    const own = row.level1 === null;
    const name = h("span", {}, row.title, row.origin ? h("span", { class: "origin" }, row.origin) : null);
    const parameters = tunedParameters(emulation);
    const refused = row.settings.Kp === undefined;
    return h(
      "tr",
      { class: own ? "own" : null },
      h("th", { scope: "row" }, own ? name : h("label", { class: "check" }, drawBox(row), name)),
      refused
        ? h("td", { class: "refused", colspan: parameters.length + 1 }, row.why)
        : [
            parameters.map((parameter) => settingCell(row, parameter, own ? boundWords(emulation, parameter) : "")),
            h("td", { title: row.why || null }, formatNumber(row.J)),
          ],
    );
  }

  function settingCell(row: LevelRow, parameter: Tuned, bound: string): HTMLElement {
    const value = row.settings[parameter];
    const text = typeof value === "number" ? formatSetting(value) : DASH;
    return h("td", { class: bound ? "at-bound" : null }, text, bound ? h("span", {}, bound) : null);
  }

  function drawBox(row: LevelRow): HTMLInputElement {
    const index = row.level1!;
    const box = h("input", {
      type: "checkbox",
      checked: chosen.includes(index),
      disabled: !row.drawable,
      "aria-label": `Draw ${row.title} ${row.origin}`.trim(),
    });
    box.addEventListener("change", () => choose(index, box.checked));
    return box;
  }

  function boundsRow(entry: Entry): HTMLElement | null {
    const { bounds } = entry.emulation!;
    if (!bounds) return null;
    return h(
      "tr",
      { class: "bounds" },
      h("th", { scope: "row" }, "Bounds of the search"),
      tunedParameters(entry.emulation!).map((name) => {
        const range = bounds[name];
        return h("td", {}, range ? `${formatBound(range[0])} … ${formatBound(range[1])}` : "");
      }),
      h("td", {}),
    );
  }

  return {
    element,
    show(entry, plant, units) {
      const emulation = entry.emulation;
      element.hidden = !emulation;
      if (!emulation) return;
      const same = shown?.entry === entry;
      shown = { entry, plant, units };
      if (!same) {
        chosen = [];
        const { fit } = emulation;
        judgement.textContent = fit?.sentence ?? "";
        judgement.hidden = !fit?.sentence;
        judgement.className = fit?.adequate === false ? "trouble" : "hint";
        showTable();
        facts.replaceChildren(
          ...emulationFacts(emulation, units).flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]),
        );
        const scenarios = emulation.scenarios ?? [];
        scenario.element.hidden = scenarios.length < 2;
        scenario.input.replaceChildren(
          ...scenarios.map((item, index) => h("option", { value: index }, scenarioWords(item))),
        );
        manual.show(entry, plant, units);
        manual.setScenario(scenarios[0]);
      }
      draw();
    },
    dispose() {
      manual.dispose();
      charts.dispose();
    },
  };
}
