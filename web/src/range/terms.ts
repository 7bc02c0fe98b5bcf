// The requirements for a range: the limits, the controller's interpolation of its schedule, and names of loop and
// signals.
import type { Method, Units } from "../api/types.ts";
import { h, uniqueId } from "../dom.ts";
import { choiceField, textField } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
import { defaultOf } from "../words/limits.ts";
import { INTERPOLATIONS } from "../words/range.ts";
import type { RangeTexts, TermTexts, WayTexts } from "./request.ts";

export interface TermFields {
  element: HTMLElement;
  read(): TermTexts;
  show(terms: TermTexts): void;
  /** Limits over the region of records are offered only for records. */
  offerRegion(records: boolean): void;
  /** The defaults of empty limits. */
  setDefaults(method: Method | undefined): void;
}

export function termFields(errors: FormErrors): TermFields {
  const field = (name: string, label: string, hint: string, placeholder = "") =>
    textField({ label, hint, placeholder, pointer: () => `/schedule/${name}` }, errors);
  const controller = choiceField(
    {
      label: "Controller",
      choices: [
        ["PID", "PID"],
        ["PI", "PI"],
      ],
      pointer: () => "/schedule/controller",
    },
    errors,
  );
  const Ms = field("Ms", "Ms", "at most", "default");
  const Mt = field("Mt", "Mt", "at most", "default");
  const interpolation = choiceField(
    {
      label: "Between the rows",
      hint: "the interpolation of your controller",
      choices: INTERPOLATIONS,
      pointer: () => "/schedule/interpolation",
    },
    errors,
  );
  const rows = field("rows", "Rows", "empty: as few as possible", "fewest");
  const allowance = field("allowance", "Allowance", "IAE above the optimum");
  allowance.setUnit("%");
  const box = h("input", { type: "checkbox", id: uniqueId("region") });
  const region = h(
    "label",
    { class: "check", for: box.id, hidden: true },
    box,
    "Keep the limits on every plant that fits the records",
  );
  const element = h(
    "fieldset",
    { class: "range-terms" },
    h("legend", {}, "Limits and schedule"),
    h(
      "div",
      { class: "fields" },
      [controller, Ms, Mt, interpolation, rows, allowance].map((item) => item.element),
    ),
    region,
  );
  interpolation.element.classList.add("broad");
  return {
    element,
    read: () => ({
      controller: controller.input.value,
      Ms: Ms.input.value,
      Mt: Mt.input.value,
      interpolation: interpolation.input.value,
      rows: rows.input.value,
      allowance: allowance.input.value,
      identified: box.checked,
    }),
    show(terms) {
      controller.input.value = terms.controller;
      Ms.input.value = terms.Ms;
      Mt.input.value = terms.Mt;
      interpolation.input.value = terms.interpolation;
      rows.input.value = terms.rows;
      allowance.input.value = terms.allowance;
      box.checked = terms.identified;
    },
    offerRegion(records) {
      region.hidden = !records;
    },
    setDefaults(method) {
      Ms.input.placeholder = String(defaultOf(method, "Ms") ?? "default");
      Mt.input.placeholder = String(defaultOf(method, "Mt") ?? "default");
    },
  };
}

export interface WayFields {
  element: HTMLElement;
  read(): WayTexts;
  show(way: WayTexts): void;
}

const ALONG = [
  ["output", "the output's steady value"],
  ["input", "the input's steady value"],
  ["parameter", "a parameter"],
] as const;

/** Fields for a range of steady states of a plant that is given by equations. */
export function wayFields(errors: FormErrors, active: () => boolean): WayFields {
  const own = (name: string) => (): string | null => (active() ? `/range/${name}` : null);
  const along = choiceField({ label: "Along", choices: ALONG, pointer: own("along") }, errors);
  const parameter = textField(
    { label: "Parameter", hint: "its name in the equations", pointer: own("parameter") },
    errors,
  );
  const from = textField({ label: "From", pointer: own("from") }, errors);
  const to = textField({ label: "To", pointer: own("to") }, errors);
  const box = h("input", { type: "checkbox", id: uniqueId("hold") });
  const hold = h("label", { class: "check", for: box.id }, box, "The input keeps the output constant");
  const element = h(
    "fieldset",
    {},
    h("legend", {}, "Range of steady states"),
    h("div", { class: "fields" }, along.element, from.element, to.element, parameter.element),
    hold,
  );
  along.element.classList.add("broad");
  const fit = (): void => {
    const moved = along.input.value === "parameter";
    parameter.element.hidden = !moved;
    hold.hidden = !moved;
  };
  along.input.addEventListener("change", fit);
  return {
    element,
    read: () => ({
      along: along.input.value as WayTexts["along"],
      parameter: parameter.input.value,
      from: from.input.value,
      to: to.input.value,
      holdOutput: box.checked,
    }),
    show(way) {
      along.input.value = way.along;
      parameter.input.value = way.parameter;
      from.input.value = way.from;
      to.input.value = way.to;
      box.checked = way.holdOutput;
      fit();
    },
  };
}

type Labels = Pick<RangeTexts, "name" | "scheduling" | "units">;

export interface LabelFields {
  /** The scheduling variable: needed to interpret a place. */
  scheduling: HTMLElement;
  others: HTMLElement;
  read(): Labels;
  show(labels: Labels): void;
}

export function labelFields(errors: FormErrors): LabelFields {
  const field = (label: string, pointer: string, hint = "", placeholder = "") =>
    textField({ label, hint, placeholder, pointer: () => pointer }, errors);
  const name = field("Loop", "/name", "its name, in jobs", "TIC-101");
  const variable = field("The plant varies with", "/scheduling/name", "what the controller reads", "load");
  const unit = field("in", "/scheduling/unit", "its unit", "%");
  const units: Record<keyof Units, ReturnType<typeof field>> = {
    time: field("Time in", "/units/time", "", "s"),
    u: field("u in", "/units/u", "", "%"),
    y: field("y in", "/units/y", "", "degC"),
  };
  return {
    scheduling: h("div", { class: "fields scheduling" }, variable.element, unit.element),
    others: h(
      "details",
      {},
      h("summary", {}, "Name of the loop, units"),
      h(
        "div",
        { class: "fields" },
        name.element,
        Object.values(units).map((item) => item.element),
      ),
    ),
    read: () => ({
      name: name.input.value,
      scheduling: { name: variable.input.value.trim(), unit: unit.input.value },
      units: { time: units.time.input.value, u: units.u.input.value, y: units.y.input.value },
    }),
    show(labels) {
      name.input.value = labels.name;
      variable.input.value = labels.scheduling.name;
      unit.input.value = labels.scheduling.unit;
      for (const key of ["time", "u", "y"] as const) units[key].input.value = labels.units[key];
    },
  };
}
