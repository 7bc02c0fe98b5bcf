// The runs of equations across their range: one passage at a time, with the schedule and with one setting.
import type { RangeContent, RangePassage } from "../api/types.ts";
import { passageFrame, runsOf } from "../charts/range.ts";
import { h, uniqueId } from "../dom.ts";
import { choiceField } from "../form/controls.ts";
import { FormErrors } from "../form/errors.ts";
import { plotGrid } from "../plot/grid.ts";
import { swatch } from "../plot/marks.ts";
import { withMinus } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { runFacts } from "../words/range.ts";

export interface RunsCard {
  element: HTMLElement;
  /** For moved rows the runs are those of the last simulation; `parameter`: the name of the parameter that moves, if
      it is one. */
  show(designed: RangeContent, moved: RangeContent | null, parameter: string | null, units: UnitNames): void;
  dispose(): void;
}

const NONLINEAR =
  "The nonlinear controller knows the equations and their states: its lead over the schedule is the most that any controller could gain.";

export function runsCard(announce: (sentence: string) => void, onAgain: () => void): RunsCard {
  const title = h("h2", { id: uniqueId("runs") }, "Runs across the range, on the equations");
  const choice = choiceField({ label: "Run", choices: [], pointer: () => null }, new FormErrors());
  const facts = h("div", { class: "scroll", role: "region", "aria-label": "Figures of the run", tabindex: 0 });
  const again = h("button", { type: "button", onclick: () => onAgain() }, "Run the present rows");
  const old = h(
    "div",
    { class: "trouble", hidden: true },
    h("p", {}, "The rows were moved; these runs still show the design."),
    h("p", { class: "actions" }, again),
  );
  const notes = h("ul", { class: "notes quiet-notes" });
  const plots = plotGrid(announce);
  const element = h(
    "section",
    { class: "card range-runs", "aria-labelledby": title.id, hidden: true },
    h("div", { class: "stack" }, title, choice.element, old, facts, notes),
    plots.element,
  );
  let passages: RangePassage[] = [];
  let about: { parameter: string | null; units: UnitNames } = { parameter: null, units: { time: "s", u: "", y: "" } };

  function draw(): void {
    const passage = passages[Number(choice.input.value) || 0];
    plots.show("run", passage ? passageFrame(passage, about.parameter, about.units) : null);
    if (!passage) return;
    const runs = runsOf(passage);
    const remarks = (passage.schedule?.warnings ?? []).map((remark) => withMinus(remark.detail));
    if (passage.nonlinear) remarks.push(NONLINEAR);
    notes.replaceChildren(...remarks.map((text) => h("li", {}, text)));
    const columns = runs.map(({ run }) => runFacts(run, about.units));
    facts.replaceChildren(
      h(
        "table",
        { class: "figures" },
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            h("td", {}),
            runs.map(({ name, look }) => h("th", { scope: "col" }, swatch(look), name)),
          ),
        ),
        h(
          "tbody",
          {},
          (columns[0] ?? []).map(([name], row) =>
            h(
              "tr",
              {},
              h("th", { scope: "row" }, name),
              columns.map((column) => h("td", {}, column[row]![1])),
            ),
          ),
        ),
      ),
    );
  }

  choice.input.addEventListener("change", draw);
  return {
    element,
    show(designed, moved, parameter, units) {
      about = { parameter, units };
      const base = designed.runs ?? [];
      // For moved rows there is no run with one setting: that of the design stays.
      passages = moved?.runs
        ? moved.runs.map((run) => ({ ...run, one: base.find(({ name }) => name === run.name)?.one }))
        : base;
      element.hidden = passages.length === 0;
      old.hidden = !moved || moved.runs !== undefined;
      const names = passages.map(({ name }) => name);
      if (names.join() !== [...choice.input.options].map((option) => option.text).join())
        choice.input.replaceChildren(...names.map((name, index) => h("option", { value: index }, name)));
      draw();
    },
    dispose: plots.dispose,
  };
}
