// The form of a range: points or equations, the variation of the plant, the requested design.
import { parsePlant } from "../api/plants.ts";
import type { RangeExample, RangeRequest } from "../api/range.ts";
import type { FieldError, Method, Preview } from "../api/types.ts";
import { h } from "../dom.ts";
import { choiceField } from "../form/controls.ts";
import { equationFields } from "../form/equation_fields.ts";
import type { FormErrors } from "../form/errors.ts";
import { recordFields } from "../form/record_fields.ts";
import { tabs } from "../form/tabs.ts";
import { robustOf } from "../words/limits.ts";
import { unitNames } from "../words/numbers.ts";
import { pointFields } from "./points.ts";
import { EMPTY_POINTS, readRange, textsOf } from "./request.ts";
import type { PointTexts } from "./request.ts";
import { labelFields, termFields, wayFields } from "./terms.ts";

export interface RangeForm {
  element: HTMLFormElement;
  read(): { request: RangeRequest; errors: FieldError[] };
  load(request: RangeRequest): void;
  setExamples(examples: RangeExample[]): void;
  setMethods(methods: readonly Method[]): void;
  /** The example from which the form was filled; "" for none. */
  choose(id: string): void;
  setBusy(busy: boolean): void;
}

export interface RangeFormEvents {
  onDesign(): void;
  onCancel(): void;
  onJob(): void;
  onExample(id: string): void;
}

/** A tank with an outflow of its own: the smallest example that uses every field. */
const FIRST_EQUATIONS = {
  type: "nonlinear",
  states: { h: 20 },
  parameters: { A: 2, k: 0.5 },
  equations: { h: "(q - k*sqrt(h))/A" },
  input: { name: "q", nominal: 2.2, min: 0 },
  output: "h",
};

export const EMPTY = "empty";

export function rangeForm(errors: FormErrors, events: RangeFormEvents): RangeForm {
  let rest: RangeRequest = {};
  const example = choiceField({ label: "Fill from an example", choices: [], pointer: () => null }, errors);
  const labels = labelFields(errors);
  const points = pointFields(errors, () => mode() === "points", {
    onChange: fit,
    onPreview: offer,
    onError: complain,
  });
  const reading = recordFields(errors, false);
  const records = h(
    "details",
    { class: "range-records", hidden: true },
    h("summary", {}, "How the records are read: columns, kind of test, model"),
    h("div", { class: "stack" }, reading.elements),
  );
  const equations = equationFields(
    errors,
    () => mode() === "equations",
    () => undefined,
  );
  const way = wayFields(errors, () => mode() === "equations");
  const ofPoints = h("div", { class: "stack" }, points.element, records);
  const ofEquations = h("div", { class: "stack", hidden: true }, equations.element, way.element);
  const kinds = tabs(
    [
      { id: "points", label: "Points" },
      { id: "equations", label: "Equations" },
    ],
    { label: "How the plant is known", panel: [ofPoints, ofEquations], onSelect: fit },
  );
  const mode = (): "points" | "equations" => kinds.selected() as "points" | "equations";
  const terms = termFields(errors);
  const design = h("button", { type: "submit", class: "primary" }, "Design");
  const cancel = h("button", { type: "button", hidden: true, onclick: () => events.onCancel() }, "Cancel");
  const job = h("button", { type: "button", onclick: () => events.onJob() }, "Send as a job");
  const element = h(
    "form",
    { class: "card range-form", novalidate: true, "aria-label": "The range" },
    example.element,
    labels.scheduling,
    kinds.element,
    terms.element,
    labels.others,
    h("div", { class: "actions" }, design, cancel, job),
  );

  function fit(): void {
    ofPoints.hidden = mode() !== "points";
    ofEquations.hidden = mode() !== "equations";
    const some = mode() === "points" && points.read().some((point) => point.record);
    records.hidden = !some;
    terms.offerRegion(some);
  }

  function offer(preview: Preview): void {
    reading.offer(preview);
    if (preview.problems.length === 0) return;
    records.hidden = false;
    errors.show(preview.problems);
  }

  function complain(error: unknown): void {
    errors.fail(error);
  }

  /** The service writes a plant given by parameters as a text. */
  async function writeOut(shown: PointTexts[]): Promise<void> {
    const texts = await Promise.all(shown.map(textByService));
    const untouched = JSON.stringify(points.read()) === JSON.stringify(shown);
    if (untouched && texts.some((point, index) => point !== shown[index])) points.show(texts);
  }

  async function textByService(point: PointTexts): Promise<PointTexts> {
    const plant = point.given?.plant;
    if (point.text !== "" || plant === undefined || typeof plant === "string") return point;
    // Without a text the plant stays unchanged.
    const text = (await parsePlant({ plant }).catch(() => null))?.text ?? "";
    return text === "" ? point : { ...point, text, given: { text, plant } };
  }

  element.addEventListener("submit", (event) => {
    event.preventDefault();
    events.onDesign();
  });
  example.input.addEventListener("change", () => events.onExample(example.input.value));
  element.addEventListener("change", () => equations.setUnits(unitNames(labels.read().units)));
  element.addEventListener("dragover", (event) => {
    if (mode() !== "points") return;
    event.preventDefault();
    element.classList.add("over");
  });
  element.addEventListener("dragleave", () => element.classList.remove("over"));
  element.addEventListener("drop", (event) => {
    event.preventDefault();
    element.classList.remove("over");
    if (mode() === "points") void points.takeFiles([...(event.dataTransfer?.files ?? [])]);
  });

  points.show(EMPTY_POINTS);
  equations.load(FIRST_EQUATIONS);
  fit();

  return {
    element,
    read() {
      const texts = {
        mode: mode(),
        ...labels.read(),
        points: points.read(),
        way: way.read(),
        terms: terms.read(),
        rest,
      };
      return readRange(texts, { equations: equations.read(), records: reading.read() });
    },
    load(request) {
      errors.clear();
      const texts = textsOf(request);
      rest = texts.rest;
      labels.show(texts);
      points.show(texts.points);
      void writeOut(texts.points);
      reading.load({}, request.identify);
      if (request.plant) equations.load(request.plant);
      equations.setUnits(unitNames(request.units));
      way.show(texts.way);
      terms.show(texts.terms);
      kinds.select(texts.mode);
      fit();
    },
    setExamples(examples) {
      example.input.replaceChildren(
        h("option", { value: "" }, "choose one"),
        ...examples.map(({ id, title }) => h("option", { value: id }, title)),
        h("option", { value: EMPTY }, "Nothing: start empty"),
      );
    },
    setMethods(methods) {
      terms.setDefaults(robustOf(methods));
    },
    choose(id) {
      example.input.value = id;
    },
    setBusy(busy) {
      design.disabled = busy;
      cancel.hidden = !busy;
    },
  };
}
