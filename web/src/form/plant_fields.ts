// Fields for a plant: one line of text, or its kind and parameters; each shows the content of the other. The service
// parses the line and returns the formula. Used on Start and on the relay test's screen.
import { ApiError, whenBack } from "../api/client.ts";
import { latest } from "../api/latest.ts";
import { parsePlant } from "../api/plants.ts";
import type { Plant, PlantAnswer, PlantQuestion } from "../api/types.ts";
import { h, uniqueId } from "../dom.ts";
import { quotient } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { choiceField, textField } from "./controls.ts";
import type { Field } from "./controls.ts";
import type { FormErrors } from "./errors.ts";
import { formulaNodes } from "./formula.ts";
import { formOf, PLANT_FORMS, readPlant } from "./plant.ts";
import type { PlantForm, PlantReading } from "./plant.ts";

export interface PlantFields {
  elements: HTMLElement[];
  read(): PlantReading;
  /** Resolves when the service has parsed the typed line. */
  settled(): Promise<void>;
  /** False if these fields cannot show such a plant. */
  load(plant: Plant): boolean;
  loadTyped(form: string, values: Record<string, string>): void;
  /** A new loop: its plant counts as exactly known until uncertainty is entered. */
  beginLoop(): void;
  /** True if this input is the line for a plant, not a parameter. */
  isLine(input: EventTarget | null): boolean;
  /** The form's id and the texts as typed, for the address: those of its fields, and the line (`LINE`) if the plant
      was typed in it. */
  typed(): { form: string; values: Record<string, string> };
  setUnits(units: UnitNames): void;
}

/** The name of the typed line among the texts of an address. */
export const LINE = "line";
const INCOMPLETE = "The formula appears when the numbers are complete.";

/** `active`: returns true if a request that is sent now is about these fields' plant. */
export function plantFields(errors: FormErrors, active: () => boolean, onChange: () => void): PlantFields {
  let form: PlantForm = PLANT_FORMS[0]!;
  let units: UnitNames = { time: "s", u: "", y: "" };
  let fields: { name: string; unit: "gain" | "slope" | "time" | ""; field: Field<HTMLInputElement> }[] = [];
  // The content of the line cannot be used until the service has parsed it.
  let fault: string | null = null;
  let waiting: (() => void)[] = [];
  let busy = false;
  let fromLine = false;
  const line = textField(
    {
      label: "Model in one line",
      hint: "a formula, K=2 T=10 L=3, or zeros and poles; times may have units, such as 3 min and 500 ms",
      placeholder: "2 e^(-3s)/((10s+1)(2s+1))",
      pointer: () => (active() ? "/plant" : null),
      wide: true,
    },
    errors,
  );
  const kind = choiceField(
    {
      label: "Kind of process",
      choices: PLANT_FORMS.map((candidate) => [candidate.id, candidate.title] as const),
      pointer: () => (active() ? "/plant/type" : null),
      wide: true,
    },
    errors,
  );
  const parameters = h("div", { class: "fields" });
  const formula = h("div", { class: "formula", id: uniqueId("formula") });
  line.input.setAttribute("aria-describedby", `${line.input.getAttribute("aria-describedby") ?? ""} ${formula.id}`);

  const typed = (name: string): string => fields.find((item) => item.name === name)?.field.input.value ?? "";
  const texts = (): Record<string, string> =>
    Object.fromEntries(fields.map((item) => [item.name, item.field.input.value]));
  const unitText = (unit: string): string => {
    const ratio = quotient(units.y, units.u);
    if (unit === "gain") return ratio;
    if (unit === "slope") return ratio ? `${ratio}/${units.time}` : `1/${units.time}`;
    return unit === "time" ? units.time : "";
  };
  const say = (sentence: string): void => formula.replaceChildren(h("span", { class: "hint" }, sentence));

  const calls = latest<PlantQuestion, PlantAnswer>(parsePlant, {
    onBusy: setBusy,
    onAnswer(answer, question) {
      if (question.text === undefined) {
        // A line that was typed since then stays.
        if (answer.text !== undefined && !fromLine) line.input.value = answer.text;
      } else if (question.text === line.input.value) {
        fault = answer.plant ? null : (answer.fault ?? "");
        if (answer.plant) showPlant(answer.plant);
      }
      if (answer.fault !== undefined) say(answer.fault);
      else formula.replaceChildren(...formulaNodes(answer.formula));
    },
    onError(error, question) {
      const sentence = error instanceof ApiError ? error.message : String(error);
      if (question.text !== undefined) fault = sentence;
      say(sentence);
      // Repeated only if no other call was made: the text may have changed by then.
      const said = formula.firstChild;
      void whenBack(error, () => {
        if (formula.firstChild !== said) return;
        if (fromLine) askText();
        else askFields();
      });
    },
  });

  function setBusy(now: boolean): void {
    busy = now;
    if (now) return;
    for (const done of waiting) done();
    waiting = [];
  }

  function askText(): void {
    fromLine = true;
    fault = "";
    calls.send({ text: line.input.value, units: { time: units.time } });
  }

  /** Requests the formula and the line for the content of the fields. */
  function askFields(): void {
    fromLine = false;
    fault = null;
    const reading = readPlant(form, typed);
    if (reading.errors.length === 0) return calls.send({ plant: reading.plant });
    calls.drop();
    setBusy(false);
    line.input.value = "";
    say(INCOMPLETE);
  }

  /** Shows the typed plant; the parameters' uncertainty, which a line cannot express, is kept. */
  function showPlant(plant: Plant): void {
    const match = formOf(plant);
    if (!match) return;
    const before = texts();
    choose(match, {
      ...Object.fromEntries(match.fields.map((field) => [field.name, field.write(plant[field.name])])),
      ...(before["uncertainty"] ? { uncertainty: before["uncertainty"] } : {}),
    });
  }

  function choose(next: PlantForm, values: Record<string, string>): void {
    const same = next === form && fields.length > 0;
    form = next;
    kind.input.value = form.id;
    if (same) {
      for (const item of fields) item.field.input.value = values[item.name] ?? "";
      return;
    }
    for (const item of fields) errors.remove(item.field.control);
    fields = form.fields.map((item) => ({
      name: item.name,
      unit: item.unit,
      field: textField(
        {
          label: item.name,
          hint: item.hint,
          unit: unitText(item.unit),
          value: values[item.name] ?? "",
          pointer: () => (active() ? `/plant/${item.name}` : null),
          wide: item.example.includes(" ") || item.name === "num" || item.name === "uncertainty",
        },
        errors,
      ),
    }));
    parameters.replaceChildren(...fields.map((item) => item.field.element));
  }

  const examples = (of: PlantForm): Record<string, string> =>
    Object.fromEntries(of.fields.map((field) => [field.name, field.example]));
  const settled = (): Promise<void> => (busy ? new Promise((done) => waiting.push(done)) : Promise.resolve());

  kind.input.addEventListener("change", () => {
    const next = PLANT_FORMS.find((candidate) => candidate.id === kind.input.value) ?? PLANT_FORMS[0]!;
    choose(next, examples(next));
    askFields();
    onChange();
  });
  parameters.addEventListener("input", askFields);
  parameters.addEventListener("change", () => onChange());
  line.input.addEventListener("input", askText);
  line.input.addEventListener("change", () => void settled().then(() => fault === null && onChange()));
  choose(form, examples(form));
  askFields();

  return {
    elements: [line.element, formula, kind.element, parameters],
    read() {
      const reading = readPlant(form, typed);
      if (fault === null) return reading;
      return { plant: reading.plant, errors: [{ pointer: "/plant", detail: fault }] };
    },
    settled,
    load(plant) {
      const match = formOf(plant);
      if (!match) return false;
      choose(match, Object.fromEntries(match.fields.map((field) => [field.name, field.write(plant[field.name])])));
      askFields();
      return true;
    },
    loadTyped(id, values) {
      const match = PLANT_FORMS.find((candidate) => candidate.id === id);
      if (!match) return;
      const { [LINE]: text, ...others } = values;
      choose(match, match.fields.some(({ name }) => name in others) ? others : examples(match));
      if (!text) return askFields();
      line.input.value = text;
      askText();
    },
    beginLoop() {
      const known = fields.find((item) => item.name === "uncertainty")?.field.input;
      if (known && known !== document.activeElement) known.value = "";
    },
    isLine: (input) => input === line.input,
    typed: () => ({ form: form.id, values: { ...texts(), ...(fromLine ? { [LINE]: line.input.value } : {}) } }),
    setUnits(next) {
      const changed = next.time !== units.time;
      units = next;
      for (const item of fields) item.field.setUnit(unitText(item.unit));
      // A line with its own units now has other numbers.
      if (changed && fromLine) askText();
    },
  };
}
