// A plant in one line, with its formula or its fault below. The service parses it.
import { sentenceOf } from "../api/client.ts";
import { latest } from "../api/latest.ts";
import { parsePlant } from "../api/plants.ts";
import type { PlantAnswer, PlantQuestion } from "../api/types.ts";
import { h } from "../dom.ts";
import { textField } from "../form/controls.ts";
import type { Field } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
import { formulaNodes } from "../form/formula.ts";
import { pointerOf } from "./question.ts";
import type { FieldSpec } from "./structures.ts";

export interface PlantLine {
  element: HTMLElement;
  field: Field<HTMLInputElement>;
  /** The text was set, or the unit of time has changed. */
  read(time: string): void;
  dispose(): void;
}

const TYPED = "2 e^(-8s)/(30s+1)";

export function plantLine(spec: FieldSpec, value: string, errors: FormErrors, time: () => string): PlantLine {
  const field = textField({ label: spec.label, bare: true, value, placeholder: spec.placeholder ?? TYPED, pointer: () => pointerOf(spec.key) }, errors);
  const formula = h("div", { class: "formula small", role: "status" });
  const say = (sentence: string, look: string): void => formula.replaceChildren(h("span", { class: look }, sentence));
  const calls = latest<PlantQuestion, PlantAnswer>(parsePlant, {
    onBusy: () => undefined,
    onAnswer(answer) {
      if (answer.fault !== undefined) say(answer.fault, "error");
      else formula.replaceChildren(...formulaNodes(answer.formula));
    },
    onError: (error) => say(sentenceOf(error), "error"),
  });

  function read(unit: string): void {
    const text = field.input.value.trim();
    if (text !== "" && text !== "0") return calls.send({ text, units: { time: unit } });
    calls.drop();
    say(text === "0" ? "no path" : spec.optional ? "the plant itself" : "", "hint");
  }

  field.input.addEventListener("input", () => read(time()));
  read(time());
  return {
    element: h("div", { class: "plant-line" }, field.element, formula),
    field,
    read,
    dispose() {
      calls.drop();
      errors.remove(field.control);
    },
  };
}
