// The controller as a program: Structured Text, C or Python, to read, copy and save.
import type { TextFile } from "../../api/client.ts";
import { ApiError, sentenceOf } from "../../api/client.ts";
import { getCode } from "../../api/products.ts";
import type { CodeQuestion, Language } from "../../api/products.ts";
import { latest } from "../../api/latest.ts";
import type { FieldError } from "../../api/types.ts";
import { h, uniqueId } from "../../dom.ts";
import { textField } from "../../form/controls.ts";
import { FormErrors } from "../../form/errors.ts";
import { parseNumber } from "../../form/number.ts";
import { tabs } from "../../form/tabs.ts";
import { download } from "../../plot/export.ts";
import type { MyController } from "../../my_controller.ts";
import type { UnitNames } from "../../words/numbers.ts";
import { copyButton } from "../copy.ts";

export interface CodeSubject {
  job: string;
  index: CodeQuestion["index"];
  name: string;
  units: UnitNames;
}

export interface CodeCard {
  element: HTMLElement;
  /** null: there is no controller for a program. */
  show(subject: CodeSubject | null): void;
  /** Shows the text at once. */
  open(): void;
  /** Proposes the sample time and limits of the user's own controller. */
  propose(mine: MyController | null): void;
  dispose(): void;
}

const LANGUAGES: readonly (readonly [Language, string])[] = [
  ["st", "Structured Text"],
  ["c", "C"],
  ["python", "Python"],
];

export function codeCard(announce: (sentence: string) => void): CodeCard {
  let subject: CodeSubject | null = null;
  let file: TextFile | null = null;
  let asked = "";
  const errors = new FormErrors();
  const number = (label: string, name: string, hint: string): ReturnType<typeof textField> => {
    const field = textField({ label, hint, pointer: () => `/${name}` }, errors);
    field.input.addEventListener("change", ask);
    return field;
  };
  const period = number("Sample time", "sample_time", "Empty: one that suits the controller is proposed.");
  const low = number("Least u", "u_min", "Empty: no limit.");
  const high = number("Largest u", "u_max", "Empty: no limit.");
  const text = h("code", {});
  const block = h("pre", { class: "code", tabindex: 0, role: "region", "aria-label": "Source text" }, text);
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const copy = copyButton({ label: "Copy the text", text: () => file?.text ?? null }, announce);
  const save = h("button", { type: "button", onclick: saveFile }, "Download");
  const whose = h("p", { class: "hint" });
  const shelf = tabs(
    LANGUAGES.map(([id, label]) => ({ id, label })),
    { label: "Language", panel: [block, h("div", { class: "actions" }, copy, save)], onSelect: () => ask() },
  );
  const summary = h("summary", { id: uniqueId("code") }, "Controller as code: Structured Text, C, Python");
  const details = h(
    "details",
    {},
    summary,
    whose,
    h("div", { class: "fields" }, period.element, low.element, high.element),
    trouble,
    shelf.element,
  );
  const element = h("section", { class: "card code-card", "aria-labelledby": summary.id, hidden: true }, details);
  details.addEventListener("toggle", ask);

  const calls = latest<CodeQuestion, TextFile>(getCode, {
    onBusy: (busy) => block.setAttribute("aria-busy", String(busy)),
    onAnswer(answer) {
      file = answer;
      text.textContent = answer.text;
      save.textContent = answer.name ? `Download ${answer.name}` : "Download";
      trouble.hidden = true;
      shelf.element.hidden = false;
    },
    onError(error) {
      const listed = error instanceof ApiError ? (error.problem.errors ?? []) : [];
      const others = errors.mark("", listed);
      const said = listed.length > 0 ? others.map((item) => item.detail) : [sentenceOf(error)];
      trouble.textContent = said.join(" ");
      trouble.hidden = said.length === 0;
      file = null;
      asked = "";
      shelf.element.hidden = said.length > 0;
    },
  });

  function saveFile(): void {
    if (file) download(new Blob([file.text], { type: "text/plain" }), file.name || "controller.txt");
  }

  /** Only while the card is open: otherwise nobody reads the text. */
  function ask(): void {
    if (!subject || !details.open) return;
    const faults: FieldError[] = [];
    const read = (field: typeof period, label: string, name: string): number | undefined => {
      if (field.input.value.trim() === "") return undefined;
      const parsed = parseNumber(field.input.value, label);
      if (parsed.ok) return parsed.value;
      faults.push({ pointer: `/${name}`, detail: parsed.sentence });
      return undefined;
    };
    const question: CodeQuestion = {
      job: subject.job,
      index: subject.index,
      language: shelf.selected() as Language,
      sample_time: read(period, "Sample time", "sample_time"),
      u_min: read(low, "Least u", "u_min"),
      u_max: read(high, "Largest u", "u_max"),
    };
    errors.mark("", faults);
    const key = JSON.stringify(question);
    if (faults.length > 0 || key === asked) return;
    asked = key;
    calls.send(question);
  }

  return {
    element,
    show(next) {
      subject = next;
      element.hidden = !next;
      if (!next) return;
      const what = next.index === "schedule" ? `The schedule over ${next.name}` : next.index === "all" ? next.name : `The controller of ${next.name}`;
      whose.textContent = `${what} as a separate program, for a controller without a PID block or for a simulation. All times in it are in seconds.`;
      period.setUnit(next.units.time);
      low.setUnit(next.units.u);
      high.setUnit(next.units.u);
      ask();
    },
    open() {
      details.open = true;
      summary.focus();
    },
    propose(mine) {
      const write = (field: typeof period, value: number | undefined): void => {
        field.input.value = value === undefined ? "" : String(value);
      };
      write(period, mine?.sample_time);
      write(low, mine?.u_span?.[0]);
      write(high, mine?.u_span?.[1]);
      ask();
    },
    dispose: calls.drop,
  };
}
