// Options for reading and identifying a record: columns, kind, model, method. The same fields on Start and on Identify.
import type { FieldError, Preview, RecordedTest } from "../api/types.ts";
import { h } from "../dom.ts";
import { choiceField, textField } from "./controls.ts";
import type { Field } from "./controls.ts";
import type { FormErrors } from "./errors.ts";
import { openAround } from "./errors.ts";
import { parseNumber, parseNumbers } from "./number.ts";
import { defined } from "./tuning_request.ts";

export type Identify = Record<string, unknown>;

export interface RecordFields {
  elements: HTMLElement[];
  /** The members that the fields add to a record and to `identify`. */
  read(): { record: RecordedTest; identify: Identify; errors: FieldError[] };
  load(record: RecordedTest, identify: Identify | undefined): void;
  /** The columns to choose from, and the roles that were found. */
  offer(preview: Preview): void;
  /** Shows the choice of the times' unit, even if it is folded away. */
  askUnit(): void;
}

type ColumnName = "t" | "u" | "y" | "r" | "mode" | "d";

const COLUMN_LABELS: Record<ColumnName, string> = {
  t: "Time",
  u: "Controller output (u)",
  y: "Measurement (y)",
  r: "Set point",
  mode: "Mode (auto, manual)",
  d: "Measured disturbance",
};

export const TIME_UNITS = [
  ["", "as in the file, else seconds"],
  ["ms", "milliseconds"],
  ["s", "seconds"],
  ["min", "minutes"],
  ["h", "hours"],
  ["d", "days"],
] as const;

/** A column is chosen by its heading; by its number if it has none, or one that occurs twice. */
export function columnChoices(preview: Preview): [value: string, text: string][] {
  return preview.columns.map(({ heading, first }, index) => {
    const twice = preview.columns.filter((other) => other.heading === heading).length > 1;
    const number = String(index + 1);
    if (heading === "" || twice) return [number, `column ${number}${heading ? `, ${heading}` : first ? `: ${first}...` : ""}`];
    return [/^[1-9]\d*$/.test(heading) ? number : heading, heading];
  });
}

/** The runs of a file whose times start again. */
const runChoices = ({ runs }: Preview): [value: string, text: string][] =>
  runs.map(({ first_line, last_line, rows, tests }, index) => [
    String(index + 1),
    `${index + 1}: lines ${first_line} to ${last_line}, ${rows} rows${tests ? "" : ", no test"}`,
  ]);

const KINDS = [
  ["auto", "automatic"],
  ["step", "step test"],
  ["relay", "relay test"],
  ["general", "any other movement"],
] as const;

const MODELS = [
  ["auto", "automatic"],
  ["fopdt", "first order with dead time"],
  ["sopdt", "second order with dead time"],
  ["sopdt_zero", "second order with a zero"],
  ["ipdt", "integrating with dead time"],
  ["ipdt_lag", "integrating with a lag"],
] as const;

const METHODS = [
  ["auto", "automatic"],
  ["output_error", "fit of the whole record"],
  ["relay_fourier", "relay formulas alone"],
  ["two_point", "two points of the step"],
] as const;

const FOUND = "detected";
const COLUMN_NAMES = ["t", "u", "y", "r", "mode", "d"] as const;
/** Words for an unchosen column if none was found. */
const UNCHOSEN: Partial<Record<ColumnName, string>> = { r: "none, or detected", mode: "none, or detected", d: "none" };

const known = (choices: readonly (readonly [string, string])[], value: unknown): string =>
  typeof value === "string" && choices.some(([id]) => id === value) ? value : "auto";

/** `all`: also options that need knowledge of the record. */
export function recordFields(errors: FormErrors, all: boolean): RecordFields {
  const column = (name: ColumnName): Field<HTMLSelectElement> =>
    choiceField(
      { label: COLUMN_LABELS[name], choices: [["", UNCHOSEN[name] ?? FOUND]], pointer: () => `/record/columns/${name}` },
      errors,
    );
  const optional = (label: string, hint: string, pointer: string): Field<HTMLInputElement> =>
    textField({ label, hint, placeholder: "optional", pointer: () => pointer }, errors);
  const columns = {
    t: column("t"),
    u: column("u"),
    y: column("y"),
    r: column("r"),
    mode: column("mode"),
    d: column("d"),
  };
  const timeUnit = choiceField(
    { label: "Times are in", choices: TIME_UNITS, pointer: () => "/record/time_unit" },
    errors,
  );
  const run = choiceField({ label: "Run of the file", choices: [["", FOUND]], pointer: () => "/record/run" }, errors);
  run.element.hidden = true;
  const uStep = optional("u stepped from, to", "if the file has no u, such as 0 50", "/record/u_step");
  const kind = choiceField({ label: "Kind of test", choices: KINDS, pointer: () => "/record/kind" }, errors);
  const model = choiceField({ label: "Model", choices: MODELS, pointer: () => "/identify/model" }, errors);
  const method = all
    ? choiceField({ label: "Method", choices: METHODS, pointer: () => "/identify/method" }, errors)
    : null;
  const dt = optional("Sampling time (s)", "if there is no time column", "/record/dt");
  const numbers: Record<string, Field<HTMLInputElement>> = all
    ? {
        dt,
        u0: optional("u before", "output before the first sample", "/record/u0"),
        y0: optional("y before", "measurement before the first sample", "/record/y0"),
        shift: optional("Shift", "for relay formulas; 1/Pu if empty", "/identify/shift"),
      }
    : { dt };
  // Parts of a loaded request that have no field here: sent unchanged.
  let rest: { record: Partial<RecordedTest>; identify: Identify } = { record: {}, identify: {} };
  let moreDisturbances: (string | number)[] = [];

  /** A record may have several disturbances: the field shows the first; those of a loaded request follow it. */
  const asChosen = (name: string, value: string | number): string | number | (string | number)[] =>
    name === "d" ? [value, ...moreDisturbances] : value;

  return {
    elements: [
      h(
        "div",
        { class: "fields" },
        Object.values(columns).map((field) => field.element),
        timeUnit.element,
        dt.element,
        uStep.element,
        run.element,
      ),
      h(
        "div",
        { class: "fields" },
        kind.element,
        model.element,
        method?.element,
        Object.values(numbers)
          .filter((field) => field !== dt)
          .map((field) => field.element),
      ),
    ],
    read() {
      const record: RecordedTest = { ...rest.record };
      const identify: Identify = { ...rest.identify, model: model.input.value };
      const faults: FieldError[] = [];
      const named = Object.entries(columns).flatMap(([name, field]) =>
        field.input.value ? [[name, asChosen(name, columnOf(field.input.value))] as const] : [],
      );
      if (named.length > 0) record.columns = Object.fromEntries(named);
      if (run.input.value) record.run = Number(run.input.value);
      const step = uStep.input.value.trim();
      if (step !== "") {
        const levels = parseNumbers(step, "u_step");
        if (levels.ok && levels.value.length === 2) record.u_step = [levels.value[0]!, levels.value[1]!];
        else faults.push({ pointer: "/record/u_step", detail: "Write two numbers, from and to, such as 0 50." });
      }
      if (timeUnit.input.value) record.time_unit = timeUnit.input.value;
      if (kind.input.value !== "auto") record.kind = kind.input.value as NonNullable<RecordedTest["kind"]>;
      if (method && method.input.value !== "auto") identify["method"] = method.input.value;
      for (const [name, field] of Object.entries(numbers)) {
        if (field.input.value.trim() === "") continue;
        const parsed = parseNumber(field.input.value, name);
        const pointer = field.control.pointer()!;
        if (!parsed.ok) faults.push({ pointer, detail: parsed.sentence });
        else if (name === "shift") identify["shift"] = parsed.value;
        else record[name as "dt" | "u0" | "y0"] = parsed.value;
      }
      return { record, identify, errors: faults };
    },
    load(record, identify = {}) {
      for (const name of COLUMN_NAMES) choose(columns[name].input, String([record.columns?.[name] ?? ""].flat()[0]));
      moreDisturbances = record.columns?.d?.slice(1) ?? [];
      choose(timeUnit.input, record.time_unit ?? "");
      choose(run.input, record.run === undefined ? "" : String(record.run));
      run.element.hidden = record.run === undefined;
      uStep.input.value = record.u_step?.join(" ") ?? "";
      kind.input.value = known(KINDS, record.kind);
      model.input.value = known(MODELS, identify["model"]);
      if (method) method.input.value = known(METHODS, identify["method"]);
      for (const [name, field] of Object.entries(numbers)) {
        const value = name === "shift" ? identify["shift"] : record[name as "dt" | "u0" | "y0"];
        field.input.value = typeof value === "number" && !(name === "dt" && record.y) ? String(value) : "";
      }
      const { model: _model, method: given, shift, ...others } = identify;
      const { u0, y0, u_limits, from, to } = record;
      rest = {
        record: all ? defined({ u_limits }) : defined({ u0, y0, u_limits, from, to }),
        identify: all ? others : { ...others, ...defined({ method: given, shift }) },
      };
    },
    askUnit() {
      openAround(timeUnit.input);
      timeUnit.input.focus();
    },
    offer(preview) {
      const choices = columnChoices(preview);
      const runs = runChoices(preview);
      const chosen = run.input.value;
      run.element.hidden = runs.length === 0 && chosen === "";
      run.input.replaceChildren(
        h("option", { value: "" }, chosen === "" && preview.run ? `${FOUND}: run ${preview.run}` : FOUND),
        ...runs.map(([value, text]) => h("option", { value }, text)),
      );
      choose(run.input, chosen);
      for (const name of COLUMN_NAMES) {
        const { input } = columns[name];
        const now = input.value;
        const at = preview.columns.findIndex((found) => found.guess === name);
        const found = now === "" && at >= 0 ? `${FOUND}: ${choices[at]![1]}` : (UNCHOSEN[name] ?? FOUND);
        input.replaceChildren(
          h("option", { value: "" }, found),
          ...choices.map(([value, text]) => h("option", { value }, text)),
        );
        choose(input, now);
      }
    },
  };
}

/** A name in the request is a choice too, even before the file has been previewed. */
function choose(select: HTMLSelectElement, value: string): void {
  if (![...select.options].some((option) => option.value === value)) select.append(h("option", { value }, value));
  select.value = value;
}

/** A column is named by its heading, or by its number from 1. */
const columnOf = (text: string): string | number => (/^[1-9]\d*$/.test(text) ? Number(text) : text);

/** A record given as numbers, converted to the text that a field shows. */
export function csvOf(record: RecordedTest): string {
  if (record.csv !== undefined) return record.csv;
  const { t, u = [], y = [], r, mode, dt = 1 } = record;
  const optional = [r && { name: "r", values: r }, mode && { name: "mode", values: mode }].filter((column) => !!column);
  const rows = y.map((value, index) =>
    [t?.[index] ?? index * dt, u[index] ?? "", value, ...optional.map(({ values }) => values[index] ?? "")].join(","),
  );
  return [["t,u,y", ...optional.map(({ name }) => name)].join(","), ...rows].join("\n");
}

/** The samples of a record without the options for reading it. */
export function samplesOf(record: RecordedTest): RecordedTest {
  const { csv, t, dt, u, y, r, mode } = record;
  if (csv !== undefined) return { csv };
  const optional = { ...(r ? { r } : {}), ...(mode ? { mode } : {}) };
  return { ...(t === undefined ? { dt: dt ?? 1 } : { t }), u: u ?? [], y: y ?? [], ...optional };
}
