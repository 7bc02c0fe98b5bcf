// A job about an operating range, on the job's screen: its schedule as a table and the link to its own screen.
import type { Job, RangeContent } from "../api/types.ts";
import { h, uniqueId } from "../dom.ts";
import { formatRoute } from "../routes.ts";
import { codeCard } from "../program/code_card.ts";
import type { CodeCard } from "../program/code_card.ts";
import { formatSetting, unitNames, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { counted, interpolationWords, settingHead, settingsOfOne, settingWords } from "../words/range.ts";

const SETTINGS = ["Kp", "Ti", "Td", "Tf", "b"] as const;

export interface RangeJobCard {
  element: HTMLElement;
  show(job: Job, content: RangeContent): void;
  dispose(): void;
}

export function rangeJobCard(announce: (sentence: string) => void): RangeJobCard {
  const title = h("h2", { id: uniqueId("range-job") });
  const body = h("div", { class: "stack" });
  let code: CodeCard | null = null; // made for the first range: most jobs are about one loop
  const settings = h("section", { class: "card range-job", "aria-labelledby": title.id }, title, body);
  const element = h("div", { class: "stack", hidden: true }, settings);
  return {
    element,
    show(job, content) {
      const units = unitNames(job.request?.units);
      const { schedule, one, why_null } = content;
      title.textContent = schedule ? `Schedule: ${counted(schedule.rows.length, "row")}` : "No schedule";
      body.replaceChildren(
        ...(job.result?.partial
          ? [h("p", { class: "hint" }, "Stopped early: this is the best result until then.")]
          : []),
        ...(schedule
          ? [
              h("p", { class: "hint" }, `Between the rows: ${interpolationWords(schedule.interpolation)}.`),
              rowsTable(content, units),
            ]
          : [h("p", {}, why_null?.["schedule"] ?? "")]),
        ...(one ? [h("p", {}, `One setting for the whole range: ${settingWords(settingsOfOne(one), units)}.`)] : []),
        h(
          "p",
          { class: "actions" },
          h("a", { href: formatRoute({ screen: "range", example: "", job: job.id }) }, "Open in Range"),
          h("span", { class: "hint" }, "curves over the range, rows to move, runs"),
        ),
      );
      const name = content.scheduling.name || "at";
      if (!code) element.append((code = codeCard(announce)).element);
      code.show(schedule ? { job: job.id, index: "schedule", name, units } : null);
    },
    dispose: () => code?.dispose(),
  };
}

function rowsTable({ schedule, scheduling }: RangeContent, units: UnitNames): HTMLElement {
  const head = [
    withUnit(scheduling.name || "at", scheduling.unit ?? ""),
    ...SETTINGS.map((name) => settingHead(name, units)),
  ];
  const rows = schedule!.rows.map((row) =>
    h(
      "tr",
      {},
      h("th", { scope: "row" }, formatSetting(row.at)),
      SETTINGS.map((name) => h("td", {}, formatSetting(row[name]))),
    ),
  );
  return h(
    "div",
    { class: "scroll", role: "region", "aria-label": "Rows of the schedule", tabindex: 0 },
    h(
      "table",
      { class: "figures" },
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          head.map((text) => h("th", { scope: "col" }, text)),
        ),
      ),
      h("tbody", {}, rows),
    ),
  );
}
