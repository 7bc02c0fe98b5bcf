// The schedule as a table: its rows can be edited; its state is shown above.
import type { RangeContent, ScheduleRow } from "../api/types.ts";
import { h, passFocus, uniqueId } from "../dom.ts";
import { textField } from "../form/controls.ts";
import type { Field } from "../form/controls.ts";
import { FormErrors } from "../form/errors.ts";
import { parseNumber } from "../form/number.ts";
import { plainSetting, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { counted, interpolationWords, settingHead, worstWords } from "../words/range.ts";

const COLUMNS = ["at", "Kp", "Ti", "Td", "Tf", "b"] as const;
type Column = (typeof COLUMNS)[number];
type Cells = Record<Column, Field<HTMLInputElement>>;

export interface ScheduleCard {
  element: HTMLElement;
  /** The current rows, and their answer; `moved`: they differ from the design's. */
  show(content: RangeContent, rows: readonly ScheduleRow[], moved: boolean, units: UnitNames): void;
  /** While a row is moved only its place changes. */
  follow(rows: readonly ScheduleRow[]): void;
  complain(error: unknown): void;
}

export interface ScheduleEvents {
  onChange(index: number, row: ScheduleRow): void;
  onBack(): void;
}

export function scheduleCard(events: ScheduleEvents): ScheduleCard {
  const errors = new FormErrors();
  const title = h("h2", { id: uniqueId("schedule") }, "Schedule");
  const how = h("p", { class: "hint" });
  const holds = h("p", { class: "verdict-line" });
  const heads = h("tr", {});
  const body = h("tbody", {});
  const table = h(
    "table",
    { class: "figures schedule" },
    h("caption", { class: "visually-hidden" }, "Rows of the schedule"),
    h("thead", {}, heads),
    body,
  );
  const scroll = h(
    "div",
    { class: "scroll", role: "region", "aria-label": "Rows of the schedule", tabindex: 0 },
    table,
  );
  const worst = h("ul", { class: "notes quiet-notes" });
  const back = h("button", { type: "button", hidden: true, onclick: () => events.onBack() }, "Back to the design");
  const element = h(
    "section",
    { class: "card schedule-card", "aria-labelledby": title.id },
    title,
    how,
    holds,
    errors.summary,
    scroll,
    h("div", { class: "actions" }, back),
    worst,
  );
  let cells: Cells[] = [];
  let rows: readonly ScheduleRow[] = [];

  /** Typed texts count once the whole row can be read. */
  function take(index: number): void {
    const row = { ...rows[index]! };
    const faults = COLUMNS.flatMap((name) => {
      const { input } = cells[index]![name];
      // A cell shows fewer digits than the row has.
      if (input.value === plainSetting(row[name])) return [];
      const parsed = parseNumber(input.value, name);
      if (!parsed.ok) return [{ pointer: pointerOf(index, name), detail: parsed.sentence }];
      row[name] = parsed.value;
      return [];
    });
    errors.clear();
    if (faults.length > 0) return errors.show(faults);
    events.onChange(index, row);
  }

  function makeRows(count: number): void {
    for (const row of cells) for (const cell of Object.values(row)) errors.remove(cell.control);
    cells = Array.from({ length: count }, (_, index) => {
      const fields = COLUMNS.map((name) => [name, cellOf(index, name, errors)] as const);
      return Object.fromEntries(fields) as Cells;
    });
    body.replaceChildren(
      ...cells.map((row, index) => {
        const line = h(
          "tr",
          {},
          COLUMNS.map((name) => h("td", {}, row[name].element)),
        );
        line.addEventListener("change", () => take(index));
        return line;
      }),
    );
  }

  function write(next: readonly ScheduleRow[]): void {
    rows = next;
    if (cells.length !== next.length) makeRows(next.length);
    next.forEach((row, index) => {
      for (const name of COLUMNS) {
        const { input } = cells[index]![name];
        const text = plainSetting(row[name]);
        if (input.value !== text) input.value = text;
      }
    });
  }

  return {
    element,
    show(content, next, moved, units) {
      const { schedule, scheduling } = content;
      errors.clear();
      for (const part of [how, scroll, worst]) part.hidden = !schedule;
      if (!moved) passFocus(back, scroll);
      back.hidden = !moved;
      if (!schedule) {
        title.textContent = "No schedule";
        holds.textContent = content.why_null?.["schedule"] ?? "None was found.";
        holds.className = "verdict-line bad";
        return;
      }
      title.textContent = moved ? "Schedule, moved by hand" : `Schedule: ${counted(next.length, "row")}`;
      how.textContent = `Between the rows: ${interpolationWords(schedule.interpolation)}. Drag the rows on the plot, or type.`;
      holds.textContent = holdWords(schedule);
      holds.className = `verdict-line ${!schedule.holds_limits ? "bad" : schedule.within_allowance ? "good" : "warn"}`;
      heads.replaceChildren(
        ...COLUMNS.map((name) =>
          h(
            "th",
            { scope: "col" },
            name === "at" ? withUnit(scheduling.name || "at", scheduling.unit ?? "") : settingHead(name, units),
          ),
        ),
      );
      write(next);
      worst.replaceChildren(...worstWords(content.worst.schedule, scheduling).map((text) => h("li", {}, text)));
    },
    follow: write,
    complain(error) {
      back.hidden = false;
      errors.fail(error);
    },
  };
}

const pointerOf = (index: number, name: Column): string => `/schedule/given/${index}/${name}`;

const cellOf = (index: number, name: Column, errors: FormErrors): Field<HTMLInputElement> =>
  textField(
    {
      label: `${name === "at" ? "Place" : name} of row ${index + 1}`,
      bare: true,
      pointer: () => pointerOf(index, name),
    },
    errors,
  );

function holdWords({ holds_limits, within_allowance }: NonNullable<RangeContent["schedule"]>): string {
  if (!holds_limits) return "The limits do not hold everywhere.";
  return within_allowance
    ? "Limits hold everywhere, within the allowance."
    : "Limits hold everywhere; the IAE is above the allowance.";
}
