// "Only Ku and Pu": the result of an experiment with a proportional controller, and the settings that rules make of it.
import type { FieldError, Result, TuningRequest } from "../../api/types.ts";
import { h } from "../../dom.ts";
import { textField } from "../../form/controls.ts";
import type { FormErrors } from "../../form/errors.ts";
import { parseNumber } from "../../form/number.ts";
import { formatSetting, quotient, withUnit } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";

export interface UltimateCard {
  element: HTMLFormElement;
  read(): { ultimate: Record<string, number>; errors: FieldError[] };
  load(request: TuningRequest): void;
  /** As typed, by the fields' names. */
  texts(): Record<string, string>;
  setTexts(texts: Record<string, string>): void;
}

export function ultimateCard(errors: FormErrors, onTune: () => void): UltimateCard {
  const field = (label: string, name: string, hint: string) =>
    textField({ label, hint, pointer: () => `/ultimate/${name}` }, errors);
  const fields = {
    Ku: field("Ku", "Ku", "gain at which the loop oscillates"),
    Pu: field("Pu", "Pu", "period of that oscillation"),
    K: field("Static gain K", "K", "if it is known"),
  };
  const element = h(
    "form",
    { class: "card", novalidate: true, "aria-labelledby": "ultimate-title" },
    h("h2", { id: "ultimate-title" }, "Only Ku and Pu"),
    h(
      "p",
      { class: "hint" },
      "You raised a proportional gain until the loop oscillated, and have no other data. Rules give settings, but the robustness of the loop is unknown.",
    ),
    h(
      "details",
      {},
      h("summary", {}, "Enter them"),
      h(
        "div",
        { class: "stack" },
        h("div", { class: "fields" }, Object.values(fields).map(({ element: one }) => one)),
        h("div", { class: "actions" }, h("button", { type: "submit", class: "primary" }, "Settings by these rules")),
      ),
    ),
  );
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    onTune();
  });
  return {
    element,
    read() {
      const ultimate: Record<string, number> = {};
      const faults: FieldError[] = [];
      for (const [name, { input }] of Object.entries(fields)) {
        if (name === "K" && input.value.trim() === "") continue;
        const parsed = parseNumber(input.value, name);
        if (parsed.ok) ultimate[name] = parsed.value;
        else faults.push({ pointer: `/ultimate/${name}`, detail: parsed.sentence });
      }
      return { ultimate, errors: faults };
    },
    texts: () => Object.fromEntries(Object.entries(fields).map(([name, { input }]) => [name, input.value])),
    setTexts(texts) {
      for (const [name, { input }] of Object.entries(fields)) input.value = texts[name] ?? "";
    },
    load(request) {
      const given = (request["ultimate"] ?? {}) as Record<string, number>;
      for (const [name, { input }] of Object.entries(fields)) input.value = given[name] === undefined ? "" : String(given[name]);
      const details = element.querySelector("details");
      if (details) details.open = request["ultimate"] !== undefined;
    },
  };
}

/** True if the answer is for Ku and Pu alone: settings without the figures of a loop. */
export const isOfUltimate = (request: TuningRequest | undefined): boolean => request?.["ultimate"] !== undefined;

/** The settings of every rule in a table, below a sentence on what is unknown. */
export function showUltimate(verdict: HTMLElement, result: Result, units: UnitNames): void {
  const heads = ["Rule", withUnit("Kp", quotient(units.u, units.y)), ...["Ti", "Td", "Tf"].map((name) => withUnit(name, units.time))];
  const cell = (value: unknown): string => (typeof value === "number" ? formatSetting(value) : "–");
  const rows = result.controllers.flatMap((entry) => {
    const { controller } = entry;
    if (!controller) return [h("tr", {}, h("th", { scope: "row" }, entry.title ?? entry.method), h("td", { colspan: 4 }, entry.error?.detail ?? ""))];
    const { Kp, Ti, Td, filter } = controller;
    return [h("tr", {}, h("th", { scope: "row" }, entry.title ?? entry.method), [Kp, Ti, Td, filter?.Tf].map((value) => h("td", {}, cell(value))))];
  });
  verdict.className = "verdict warn";
  const table = h(
    "table",
    { class: "figures" },
    h("thead", {}, h("tr", {}, heads.map((head) => h("th", { scope: "col" }, head)))),
    h("tbody", {}, rows),
  );
  verdict.replaceChildren(
    h("h2", {}, result.verdict?.[0]?.text ?? ""),
    h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Settings of every rule" }, table),
  );
}
