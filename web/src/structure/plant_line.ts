// A plant in one line, with its formula or its fault below: typed, or identified from the file of a recorded test. The
// service parses it.
import { ApiError, sentenceOf } from "../api/client.ts";
import { latest } from "../api/latest.ts";
import { identify, parsePlant } from "../api/plants.ts";
import { maxBodyBytes, previewFile } from "../api/records.ts";
import type { PlantAnswer, PlantQuestion, Units } from "../api/types.ts";
import { h } from "../dom.ts";
import { textField } from "../form/controls.ts";
import type { Field } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
import { formulaNodes, rounded } from "../form/formula.ts";
import { tooLarge } from "../form/record_preview.ts";
import { formatNumber } from "../words/numbers.ts";
import { pointerOf } from "./question.ts";
import type { FieldSpec } from "./structures.ts";

export interface PlantLine {
  element: HTMLElement;
  field: Field<HTMLInputElement>;
  /** Chooses the file of a test. */
  choose: HTMLButtonElement;
  /** The text was set, or the unit of time has changed. */
  read(time: string): void;
  dispose(): void;
}

const TYPED = "2 e^(-8s)/(30s+1)";

export function plantLine(spec: FieldSpec, value: string, errors: FormErrors, time: () => string): PlantLine {
  /** The test from which it comes. */
  let source = "";
  const field = textField({ label: spec.label, bare: true, value, placeholder: spec.placeholder ?? TYPED, pointer: () => pointerOf(spec.key) }, errors);
  const formula = h("div", { class: "formula small", role: "status" });
  const file = h("input", { type: "file", class: "visually-hidden", accept: ".csv,.txt,.tsv,text/csv,text/plain", tabindex: -1, "aria-label": `File of a test: ${spec.label}` });
  const choose = h("button", { type: "button", class: "quiet", title: "From a recorded test (CSV)", "aria-label": `CSV of a test: ${spec.label}`, onclick: () => file.click() }, "CSV");
  const element = h("div", { class: "plant-line" }, field.element, formula, file);
  const say = (sentence: string, look: string): void => formula.replaceChildren(h("span", { class: look }, sentence));
  const calls = latest<PlantQuestion, PlantAnswer>(parsePlant, {
    onBusy: () => undefined,
    onAnswer(answer) {
      if (answer.fault !== undefined) say(answer.fault, "error");
      else formula.replaceChildren(...formulaNodes(answer.formula), ...(source ? [h("span", { class: "hint" }, source)] : []));
    },
    onError: (error) => say(sentenceOf(error), "error"),
  });

  function read(unit: string): void {
    const text = field.input.value.trim();
    if (text !== "" && text !== "0") return calls.send({ text, units: { time: unit } });
    calls.drop();
    say(text === "0" ? "no path" : spec.optional ? "the plant itself" : "", "hint");
  }

  /** The model of the test is written into the line, in the unit of time of the structure. */
  async function takeFile(chosen: File): Promise<void> {
    calls.drop();
    say(`Reading ${chosen.name}...`, "hint");
    try {
      const large = tooLarge(chosen, await maxBodyBytes());
      if (large) return say(large, "error");
      const { text: csv } = await previewFile(chosen);
      const model = await identify({ record: { csv }, units: { time: time() as NonNullable<Units["time"]> } });
      const { text, fault } = await parsePlant({ plant: rounded(model.plant) });
      if (text === undefined) return say(fault ?? "This model cannot be written in one line.", "error");
      source = `${chosen.name}, fit ${formatNumber(model.fit_percent)} %`;
      field.input.value = text;
      field.input.dispatchEvent(new Event("change"));
      read(time());
    } catch (error) {
      const [first] = error instanceof ApiError ? (error.problem.errors ?? []) : [];
      say(first?.detail ?? sentenceOf(error), "error");
    }
  }

  field.input.addEventListener("input", () => {
    source = "";
    read(time());
  });
  file.addEventListener("change", () => {
    const [chosen] = file.files ?? [];
    if (chosen) void takeFile(chosen);
    file.value = "";
  });
  element.addEventListener("dragover", (event) => event.preventDefault());
  element.addEventListener("drop", (event) => {
    event.preventDefault();
    const [chosen] = event.dataTransfer?.files ?? [];
    if (chosen) void takeFile(chosen);
  });
  read(time());
  return {
    element,
    field,
    choose,
    read,
    dispose() {
      calls.drop();
      errors.remove(field.control);
    },
  };
}
