// The choice of methods with their options, built from the answer of GET /v1/methods.
import type { FieldError, Method, TuneEntry } from "../../api/types.ts";
import { h, uniqueId } from "../../dom.ts";
import { pick, place } from "../../form/cases.ts";
import { choiceField, textField } from "../../form/controls.ts";
import type { Field } from "../../form/controls.ts";
import type { Control, FormErrors } from "../../form/errors.ts";
import { fieldsOf, readField, typedText } from "../../form/fields.ts";
import { typedParts } from "../../form/typed.ts";
import type { FieldKind, FieldSpec } from "../../form/fields.ts";
import { asksForAll } from "../../form/tuning_request.ts";
import { formatRoute } from "../../routes.ts";
import { objectOf } from "../../form/kept_note.ts";
import { defaultOf, robustOf } from "../../words/limits.ts";
import { mentions } from "../../words/methods.ts";
import { namedUnit, unitNames } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";

export interface MethodsCard {
  element: HTMLElement;
  setMethods(methods: Method[]): void;
  setUnits(units: UnitNames): void;
  read(): { tune: TuneEntry[]; errors: FieldError[] };
  load(tune: TuneEntry[] | string | undefined): void;
  /** The choice as typed, by names for an address; empty for the default. */
  texts(): Record<string, string>;
  setTexts(texts: Record<string, string>): void;
  /** A new loop: the default again, unless methods were chosen for this one. */
  beginLoop(): void;
  /** The displayed choice belongs to this loop. */
  endLoop(): void;
}

/** With more methods than this, there is a search field. */
const SEARCHED_FROM = 10;

interface Row {
  method: Method;
  element: HTMLElement;
  chosen: HTMLInputElement;
  fields: { spec: FieldSpec; field: Field<Control["input"]> }[];
  /** Options of a loaded request that have no field here: sent unchanged. */
  rest: Record<string, unknown>;
  options: HTMLElement;
}

export function methodsCard(errors: FormErrors): MethodsCard {
  let rows: Row[] = [];
  let units = unitNames(undefined);
  /** A choice as typed that waits for the list of methods. */
  let typedChoice: Record<string, string> = {};
  /** Null: the default of the contract. */
  let given: TuneEntry[] | null = null;
  const list = h("div", { class: "methods" }, h("p", { class: "hint" }, "Asking the service for its methods..."));
  /** The default method is shown with its default limits. */
  function standard(): TuneEntry[] {
    const robust = robustOf(rows.map(({ method }) => method));
    const limits = ["Ms", "Mt"].map((name) => [name, defaultOf(robust, name)]).filter(([, value]) => value !== null);
    return [{ method: "robust", ...Object.fromEntries(limits) }];
  }
  const wanted = (): TuneEntry[] => given ?? standard();

  const element = h(
    "section",
    { class: "card", "aria-labelledby": "methods-title" },
    h("h2", { id: "methods-title" }, "How to tune"),
    h(
      "p",
      { class: "hint" },
      "The first is a good choice: the best load rejection within the robustness you set. Choose several to compare them.",
    ),
    list,
  );

  const search = h("input", { type: "text", id: uniqueId("search"), autocomplete: "off", spellcheck: "false" });
  const found = h("span", { class: "hint", role: "status" });
  const searchLine = h(
    "div",
    { class: "method-search" },
    h("label", { for: search.id }, "Find a method"),
    search,
    found,
  );
  search.addEventListener("input", filter);
  const typed = typedParts([list]);

  /** Chosen methods stay visible, whatever the search. */
  function filter(): void {
    const others = rows.slice(1);
    for (const row of others) row.element.hidden = !row.chosen.checked && !mentions(row.method, search.value);
    const chosen = others.filter((row) => row.chosen.checked).length;
    found.textContent = `${others.filter((row) => !row.element.hidden).length} shown, ${chosen} chosen`;
  }

  /** In the order of `tune`: as in the loaded request, then as listed here. */
  function chosenRows(): Row[] {
    const place = (row: Row): number => {
      const at = wanted().findIndex((entry) => entry.method === row.method.id);
      return at < 0 ? wanted().length : at;
    };
    return rows.filter((row) => row.chosen.checked).sort((a, b) => place(a) - place(b));
  }

  function makeRow(method: Method): Row {
    const chosen = h("input", { type: "checkbox", id: `method-${method.id}` });
    const row: Row = { method, chosen, fields: [], rest: {}, element: h("div"), options: h("div") };
    const pointer = (path: string[]) => (): string | null =>
      chosen.checked ? `/tune/${chosenRows().indexOf(row)}/${path.join("/")}` : null;
    row.fields = fieldsOf(method.options)
      .filter((spec) => spec.path[0] !== "method")
      .map((spec) => ({ spec, field: optionField(spec, pointer(spec.path), errors) }));
    const main = row.fields.filter(({ spec }) => method.options?.properties?.[spec.path[0]!]?.["x-main"]);
    const others = row.fields.filter((item) => !main.includes(item));
    row.options = h(
      "div",
      { class: "options", hidden: true },
      main.length > 0
        ? h(
            "div",
            { class: "fields" },
            main.map(({ field }) => field.element),
          )
        : null,
      others.length > 0
        ? h(
            "details",
            {},
            h("summary", {}, "More options"),
            h(
              "div",
              { class: "fields" },
              others.map(({ field }) => field.element),
            ),
          )
        : null,
      h(
        "p",
        { class: "hint" },
        [method.needs && `Needs ${method.needs}.`, method.validity && `Valid: ${method.validity}.`, method.source]
          .filter(Boolean)
          .join(" ")
          .replaceAll("..", "."),
        " ",
        h("a", { href: formatRoute({ screen: "methods", id: method.id }) }, `About ${method.title}`),
      ),
    );
    chosen.addEventListener("change", () => {
      row.options.hidden = !chosen.checked;
      filter();
    });
    row.element = h(
      "div",
      { class: "method" },
      h(
        "div",
        { class: "check" },
        chosen,
        h("label", { for: chosen.id }, method.title, h("code", {}, ` ${method.id}`)),
      ),
      row.options,
    );
    return row;
  }

  function fill(row: Row, entry: TuneEntry | undefined): void {
    row.chosen.checked = entry !== undefined;
    row.options.hidden = entry === undefined;
    row.rest = {};
    if (!entry) return;
    const known = new Set(row.fields.map(({ spec }) => spec.path[0]!));
    for (const [name, value] of Object.entries(entry))
      if (name !== "method" && !known.has(name)) row.rest[name] = value;
    for (const { spec, field } of row.fields) field.input.value = typedText(pick(entry, spec.path), spec);
  }

  function writeUnits(): void {
    for (const row of rows) for (const { spec, field } of row.fields) field.setUnit(namedUnit(spec.unit, units));
  }

  function show(): void {
    for (const row of rows)
      fill(
        row,
        wanted().find((entry) => entry.method === row.method.id),
      );
    if (wanted().some((entry) => entry.method !== rows[0]?.method.id))
      list.querySelector("details.rules")?.setAttribute("open", "");
    filter();
  }

  function load(tune: TuneEntry[] | string | undefined): void {
    typed.forget();
    // A comparison of all methods is a button; it does not choose each of them.
    given = tune === undefined || asksForAll(tune) ? null : (tune as TuneEntry[]);
    show();
  }

  const nameOf = (row: Row, spec: FieldSpec): string => `how.${row.method.id}.${spec.path.join(".")}`;

  /** Of methods that are chosen, unless they are the default ones. */
  function texts(): Record<string, string> {
    if (rows.length === 0) return typedChoice;
    const chosen = chosenRows();
    const options = chosen.flatMap((row) => row.fields.map(({ spec, field }) => [nameOf(row, spec), field.input.value.trim()]));
    const rests = chosen.flatMap(({ method, rest }) =>
      Object.keys(rest).length > 0 ? [[`how.${method.id}`, JSON.stringify(rest)]] : [],
    );
    const all = { how: chosen.map((row) => row.method.id).join(" "), ...Object.fromEntries([...options, ...rests]) };
    return JSON.stringify(all) === JSON.stringify(standardTexts()) ? {} : all;
  }

  function standardTexts(): Record<string, string> {
    const [entry] = standard();
    const row = rows.find(({ method }) => method.id === entry!.method);
    const options = (row?.fields ?? []).map(({ spec }) => [nameOf(row!, spec), typedText(pick(entry!, spec.path), spec)]);
    return { how: entry!.method, ...Object.fromEntries(options) };
  }

  function writeTexts(typedTexts: Record<string, string>): void {
    typedChoice = typedTexts;
    if (rows.length === 0 || !typedTexts["how"]) return;
    const ids = typedTexts["how"].split(" ");
    given = ids.map((id) => ({ method: id, ...objectOf(typedTexts[`how.${id}`]) }));
    typedChoice = {};
    show();
    for (const row of rows.filter(({ chosen }) => chosen.checked))
      for (const { spec, field } of row.fields) field.input.value = typedTexts[nameOf(row, spec)] ?? field.input.value;
  }

  return {
    element,
    texts,
    setTexts(typedTexts) {
      typed.forget();
      if (!typedTexts["how"]) return load(undefined);
      typed.note([""]);
      writeTexts(typedTexts);
    },
    setMethods(methods) {
      for (const row of rows) for (const { field } of row.fields) errors.remove(field.control);
      rows = methods.filter((method) => method.id !== "all").map(makeRow);
      const [first, ...others] = rows.map((row) => row.element);
      list.replaceChildren(
        ...(first ? [first] : []),
        ...(others.length > 0
          ? [
              h(
                "details",
                { class: "rules" },
                h("summary", {}, `Compare with ${others.length} other ${others.length === 1 ? "method" : "methods"}`),
                others.length > SEARCHED_FROM ? searchLine : null,
                h("div", { class: "method-rows" }, others),
              ),
            ]
          : []),
      );
      show();
      writeTexts(typedChoice);
      writeUnits();
    },
    setUnits(next) {
      units = next;
      writeUnits();
    },
    read() {
      // Without the service's list the default of the contract applies.
      if (rows.length === 0) return { tune: wanted(), errors: [] };
      const faults: FieldError[] = [];
      const tune = chosenRows().map((row, index) => {
        const entry: TuneEntry = { method: row.method.id, ...row.rest };
        for (const { spec, field } of row.fields) {
          const parsed = readField(spec, field.input.value);
          if (parsed.ok) place(entry, spec.path, parsed.value);
          else faults.push({ pointer: `/tune/${index}/${spec.path.join("/")}`, detail: parsed.sentence });
        }
        for (const [name, option] of Object.entries(row.method.options?.properties ?? {}))
          if (option["x-draws"]) entry[name] ??= true;
        return entry;
      });
      if (tune.length === 0) faults.push({ pointer: "/tune", detail: "No method is chosen. Choose at least one." });
      return { tune, errors: faults };
    },
    load,
    beginLoop() {
      if (!typed.has("")) load(undefined);
    },
    endLoop: typed.forget,
  };
}

/** Notation of lists, if a number alone would not show it. */
const HOW_TO_WRITE: Partial<Record<FieldKind, string>> = {
  spread: "One number, or two as limits.",
  roots: "As -4 -4, or -3±2i for a pair.",
  cases: "As 10; -5; each may be followed by names with numbers, such as 10 initial.x 0.5.",
  names: "Spaces between the names.",
};

export function optionField(spec: FieldSpec, pointer: () => string | null, errors: FormErrors): Field<Control["input"]> {
  const hint = [spec.hint, HOW_TO_WRITE[spec.kind], spec.words.length > 0 ? `Also: ${spec.words.join(", ")}.` : ""]
    .filter(Boolean)
    .join(" ");
  const shared = { label: spec.label, hint, pointer };
  const standard = spec.defaultText ? `default (${spec.defaultText})` : "default";
  if (spec.kind === "choice")
    return choiceField(
      { ...shared, choices: [["", standard], ...spec.choices.map((item) => [item, item] as const)] },
      errors,
    );
  if (spec.kind === "boolean")
    return choiceField(
      {
        ...shared,
        choices: [
          ["", standard],
          ["true", "yes"],
          ["false", "no"],
        ],
      },
      errors,
    );
  return textField({ ...shared, placeholder: spec.defaultText || "optional" }, errors);
}
