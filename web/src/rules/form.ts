// The form of a rule: formulas, a method or settings, and the problems that count.
import type { Method } from "../api/types.ts";
import { h } from "../dom.ts";
import { areaField, choiceField, textField } from "../form/controls.ts";
import type { Control, FormErrors } from "../form/errors.ts";
import { fieldsOf } from "../form/fields.ts";
import type { FieldSpec } from "../form/fields.ts";
import { tabs } from "../form/tabs.ts";
import { optionField } from "../views/cards/methods_card.ts";
import { documentAddress } from "../words/documents.ts";
import { STRUCTURE_WORDS } from "./words.ts";
import type { Library } from "./words.ts";
import { FORMULAS, kindOf, KINDS, OPTION } from "./question.ts";
import type { RuleKind, RuleTexts } from "./question.ts";

export interface RuleForm {
  element: HTMLElement;
  texts(): RuleTexts;
  show(texts: RuleTexts): void;
  setMethods(methods: readonly Method[]): void;
  /** The options of the chosen method. */
  options(): FieldSpec[];
}

const LABELS: Record<RuleKind, string> = { formula: "Formulas", method: "Method", settings: "Settings" };

/** The names in formulas. */
const NAMES: readonly (readonly [string, string])[] = [
  ["K, T, L", "of K e^(−Ls)/(T s + 1), the plant or its reduction; with an integrator K and T are infinite"],
  ["T2", "the second lag; with an integrator the lag beside it"],
  ["Kv", "K/T; with an integrator the slope"],
  ["tau", "L/(L + T); 0 with an integrator"],
  ["Ku, Pu", "ultimate gain and period"],
];

/** Options without effect on the load response, or those that a problem gives. */
const NOT_ASKED = ["method", "setpoint", "filter"];

type TextInput = HTMLInputElement | HTMLTextAreaElement | HTMLSelectElement;

/** `onChange`: a text was changed and left. */
export function ruleForm(errors: FormErrors, library: Library, onChange: () => void): RuleForm {
  let kind: RuleKind = "formula";
  let methods: readonly Method[] = [];
  /** Texts of options, also of methods that are not chosen. */
  let typed: RuleTexts = {};
  let specs: FieldSpec[] = [];
  const inputs = new Map<string, TextInput>();
  const optionControls: Control[] = [];
  const when = (of: RuleKind, pointer: string) => (): string | null => (kind === of ? pointer : null);

  const keep = <T extends TextInput>(name: string, made: { element: HTMLElement; input: T }): HTMLElement => {
    inputs.set(name, made.input);
    made.input.addEventListener("change", onChange);
    return made.element;
  };
  const formulas = FORMULAS.map((name) => {
    const hint = { Kp: "", Ti: "Empty: no integral action.", Td: "Empty: a PI controller." }[name];
    return keep(name, textField({ label: name, ...(hint ? { hint } : {}), placeholder: name === "Td" ? "L/2" : "", pointer: when("formula", `/tune/${name}`) }, errors));
  });
  const formulaPanel = h(
    "div",
    { class: "rule-formulas" },
    h("div", { class: "stack" }, formulas),
    h(
      "section",
      { class: "rule-names", "aria-label": "Names in formulas" },
      h("dl", {}, NAMES.map(([name, meaning]) => h("div", {}, h("dt", {}, h("code", {}, name)), h("dd", {}, meaning)))),
      h("p", { class: "hint" }, "Also + - * / ^, a > b ? x : y, min, max, sqrt, exp, log. ", h("a", { href: documentAddress("methods", "formula-a-rule-of-your-own"), target: "_blank" }, "Formulas")),
    ),
  );
  const method = choiceField({ label: "Method", choices: [], pointer: when("method", "/tune/method") }, errors);
  method.input.addEventListener("change", showOptions);
  const optionFields = h("div", { class: "fields" });
  const optionBox = h("details", {}, h("summary", {}, "Options"), h("p", { class: "hint" }, "Ms, Mt and controller follow each problem unless they are given here."), optionFields);
  const methodPanel = h("div", { class: "stack" }, keep("method", method), optionBox);
  const settings = areaField({ label: "Settings (CSV)", hint: "Columns problem, Kp, Ti and, for a PID, Td. The filter is the problem's own.", rows: 8, placeholder: "problem,Kp,Ti,Td\namigo/lag-delay/1/pi/1.4,0.4,1.05,", pointer: when("settings", "/settings") }, errors);
  const file = h("input", { type: "file", class: "visually-hidden", accept: ".csv,.txt,.tsv,text/csv,text/plain", tabindex: -1, "aria-label": "CSV file of settings" });
  file.addEventListener("change", () => void readFile(file.files?.[0]).then(() => (file.value = "")));
  settings.element.addEventListener("dragover", (event) => event.preventDefault());
  settings.element.addEventListener("drop", (event) => {
    event.preventDefault();
    void readFile(event.dataTransfer?.files[0]);
  });
  const settingsPanel = h("div", { class: "stack" }, keep("settings", settings), h("div", { class: "actions" }, h("button", { type: "button", onclick: () => file.click() }, "Choose file"), file));
  const panels: Record<RuleKind, HTMLElement> = { formula: formulaPanel, method: methodPanel, settings: settingsPanel };
  const kinds = tabs(
    KINDS.map((id) => ({ id, label: LABELS[id] })),
    {
      label: "Rule",
      panel: KINDS.map((id) => panels[id]),
      onSelect(id) {
        kind = id as RuleKind;
        showPanel();
        onChange();
      },
    },
  );

  const limits = [...new Set(Object.values(library.problems).map(({ Ms }) => Ms))].sort((a, b) => a - b);
  const sources = library.families.map((id) => id.split("/", 1)[0]!).filter((source, at, all) => all.indexOf(source) === at && all.lastIndexOf(source) > at);
  const families = [...sources, ...library.families].sort().map((id) => [`${id}/`, sources.includes(id) ? `${id}, all` : id] as const);
  const choices = (list: readonly (readonly [string, string])[]): (readonly [string, string])[] => [["", "all"], ...list];
  const name = keep("name", textField({ label: "Name", placeholder: "optional", pointer: () => "/name" }, errors));
  const structure = keep("structure", choiceField({ label: "Structure", choices: choices(Object.entries(STRUCTURE_WORDS)), pointer: () => "/problems/structure" }, errors));
  const Ms = keep("Ms", choiceField({ label: "Limit on Ms and Mt", choices: choices(limits.map((limit) => [String(limit), String(limit)])), pointer: () => "/problems/Ms" }, errors));
  const family = keep("family", choiceField({ label: "Family", choices: choices(families), pointer: () => "/problems/name" }, errors));
  const element = h(
    "form",
    { class: "card rule-form", "aria-label": "Rule" },
    kinds.element,
    h("fieldset", { class: "rule-problems" }, h("legend", {}, "Problems"), structure, Ms, family),
    h("div", { class: "rule-send" }, name, h("button", { type: "submit", class: "primary" }, "Score")),
  );
  showPanel();

  function showPanel(): void {
    for (const id of KINDS) panels[id].hidden = id !== kind;
  }

  async function readFile(given: File | undefined): Promise<void> {
    if (!given) return;
    settings.input.value = await given.text();
    errors.settle(settings.control);
    onChange();
  }

  function rememberOptions(): void {
    for (const [key, { value }] of inputs) if (key.startsWith(OPTION)) typed[key] = value;
  }

  function showOptions(): void {
    rememberOptions();
    for (const key of [...inputs.keys()]) if (key.startsWith(OPTION)) inputs.delete(key);
    for (const control of optionControls.splice(0)) errors.remove(control);
    const chosen = methods.find(({ id }) => id === method.input.value);
    specs = fieldsOf(chosen?.options).filter(({ path }) => !NOT_ASKED.includes(path[0]!));
    optionBox.hidden = specs.length === 0;
    optionFields.replaceChildren(
      ...specs.map((spec) => {
        const key = OPTION + spec.path.join(".");
        const field = optionField(spec, when("method", `/tune/${spec.path.join("/")}`), errors);
        field.input.value = typed[key] ?? "";
        optionControls.push(field.control);
        return keep(key, field);
      }),
    );
  }

  /** A link may choose what the page does not list. */
  function fill(input: TextInput, text: string): void {
    input.value = text;
    if (input.value === text || !(input instanceof HTMLSelectElement) || input === method.input) return;
    input.append(h("option", { value: text, selected: true }, text));
  }

  return {
    element,
    texts: () => ({ kind, ...Object.fromEntries([...inputs].map(([key, { value }]) => [key, value])) }),
    show(texts) {
      kind = kindOf(texts);
      kinds.select(kind);
      showPanel();
      typed = { ...texts };
      for (const [key, input] of inputs) if (!key.startsWith(OPTION)) fill(input, texts[key] ?? "");
      if (method.input.value === "" && methods[0]) method.input.value = methods[0].id;
      showOptions();
      optionBox.open = specs.some(({ path }) => Boolean(texts[OPTION + path.join(".")]));
    },
    setMethods(next) {
      const chosen = typed["method"] || method.input.value;
      methods = next;
      method.input.replaceChildren(...next.map(({ id, title }) => h("option", { value: id, selected: id === chosen }, `${title} (${id})`)));
      showOptions();
    },
    options: () => specs,
  };
}
