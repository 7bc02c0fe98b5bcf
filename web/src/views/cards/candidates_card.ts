// The models that explain a record: each with its evidence; one is chosen and tuned.
import type { Candidate, Model } from "../../api/types.ts";
import { h, uniqueId } from "../../dom.ts";
import { plantFormula, rounded } from "../../form/formula.ts";
import { serviceChoice } from "../../form/tuning_request.ts";
import { formatNumber, formatParameter, formatUncertain, isUndetermined } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";
import { parameterUnit, structureTitle } from "../../words/plant.ts";

export interface CandidatesCard {
  element: HTMLElement;
  show(model: Model, units: UnitNames): void;
  /** Null if the service lists no candidates. */
  chosen(): Candidate | null;
  /** True if limits must hold for every model consistent with the record. */
  onRegion(): boolean;
  setBusy(busy: boolean): void;
}

/** The reader's choice, to restore it later. */
export interface CandidateChoice {
  /** Title of the candidate's structure; "" for the service's choice. */
  structure: string;
  /** Limits hold for every model consistent with the record. */
  region: boolean;
}

export interface CandidatesEvents {
  onChoose(): void;
  onRemember(choice: CandidateChoice): void;
  /** `all`: by every method. */
  onTune(all: boolean): void;
}

/** `methods`: names of the methods for tuning. `first`: the initial choice. */
export function candidatesCard(methods: string[], first: CandidateChoice, events: CandidatesEvents): CandidatesCard {
  let structure = first.structure;
  let candidates: Candidate[] = [];
  let index = -1;
  const title = h("h2", { id: uniqueId("candidates") }, "Model candidates");
  const list = h("fieldset", { class: "candidates" });
  const reason = h("p", { class: "hint" });
  const tune = h("button", { type: "button", class: "primary", onclick: () => events.onTune(false) }, "Use and tune");
  const all = h("button", { type: "button", onclick: () => events.onTune(true) }, "Compare all methods");
  const whole = h("input", { type: "checkbox", id: uniqueId("region"), checked: first.region });
  const element = h(
    "section",
    { class: "card", "aria-labelledby": title.id },
    title,
    list,
    reason,
    h(
      "div",
      { class: "check" },
      whole,
      h("label", { for: whole.id }, "Always meet the limits for every model consistent with the record"),
    ),
    h("p", { class: "hint" }, "Otherwise only where the design for this model alone breaks them."),
    h("div", { class: "actions" }, tune),
    h("div", { class: "actions" }, all),
    methods.length > 0
      ? h("p", { class: "hint" }, `By ${methods.join(", ")}; `, h("a", { href: "#/" }, "choose methods on Start"), ".")
      : null,
  );

  const remember = (): void => events.onRemember({ structure, region: whole.checked });
  whole.addEventListener("change", remember);

  function item(candidate: Candidate, at: number, preferred: number, units: UnitNames, name: string): HTMLElement {
    const input = h("input", { type: "radio", name, value: at, checked: at === index });
    input.addEventListener("change", () => {
      index = at;
      structure = structureTitle(candidate.plant);
      remember();
      events.onChoose();
    });
    return h(
      "label",
      { class: "candidate" },
      input,
      h(
        "span",
        {},
        h("strong", {}, capital(structureTitle(candidate.plant))),
        h("span", { class: "fit" }, `fit ${formatNumber(candidate.fit_percent)} %`),
        at === preferred ? h("span", { class: "badge" }, "chosen by the service") : null,
        formulaOf(candidate),
        h(
          "span",
          { class: "parameters" },
          parameterTexts(candidate, units).map((text) => h("span", {}, text)),
        ),
      ),
    );
  }

  return {
    element,
    show(model, units) {
      candidates = model.candidates ?? [];
      const preferred = serviceChoice(model);
      // The reader's choice is kept when the same record is identified again.
      const again = candidates.findIndex((candidate) => structureTitle(candidate.plant) === structure);
      index = again >= 0 ? again : Math.max(0, preferred);
      if (candidates.length === 0) index = -1;
      const name = uniqueId("candidate");
      const only: Candidate = { ...model };
      const items = candidates.map((candidate, at) => item(candidate, at, preferred, units, name));
      const isWeak = ({ much_worse, undetermined }: Candidate): boolean => much_worse || (undetermined?.length ?? 0) > 0;
      const folded = items.filter((_, at) => at !== index && at !== preferred && isWeak(candidates[at]!));
      list.replaceChildren(
        h("legend", { class: "visually-hidden" }, "Which model to use"),
        ...(items.length > 0 ? items.filter((row) => !folded.includes(row)) : [item(only, -1, -1, units, name)]),
        ...(folded.length > 0
          ? [
              h(
                "details",
                {},
                h("summary", {}, weakWords(candidates.filter((_, at) => folded.includes(items[at]!)))),
                folded,
              ),
            ]
          : []),
      );
      reason.textContent = model.choice_reason ?? "";
    },
    chosen: () => candidates[index] ?? null,
    onRegion: () => whole.checked,
    setBusy(busy) {
      tune.disabled = busy;
      all.disabled = busy;
    },
  };
}

/** "3 that fit worse, or that the record does not determine". */
function weakWords(folded: Candidate[]): string {
  const [worse, open] = [folded.some(({ much_worse }) => much_worse), folded.some(({ undetermined }) => undetermined?.length)];
  const one = folded.length === 1;
  const reasons = [worse ? `${one ? "fits" : "fit"} worse` : "", open ? `the record does not determine` : ""].filter(Boolean);
  return `${folded.length} that ${reasons.join(", or that ")}`;
}

const capital = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

/** For structures that their parameters alone do not describe. In a narrow card it scrolls, also with the keyboard. */
function formulaOf(candidate: Candidate): HTMLElement | null {
  if (candidate.plant.type !== "transfer_function") return null;
  const formula = plantFormula(rounded(candidate.plant), "span", true);
  for (const [name, value] of [["tabindex", "0"], ["role", "group"], ["aria-label", "Formula"]] as const)
    formula.setAttribute(name, value);
  return formula;
}

/** "K 1.25 ± 0.01 °C/%" for each parameter; for a transfer function the errors of its coefficients, whose values are in
    the formula. A parameter that the record does not determine says so in place of its error. */
export function parameterTexts(candidate: Candidate, units: UnitNames): string[] {
  const errors = candidate.standard_errors ?? {};
  const open = (name: string, value: number | undefined): boolean =>
    (candidate.undetermined?.includes(name) ?? false) || (value !== undefined && isUndetermined(errors[name], value));
  const texts = Object.entries(candidate.plant).flatMap(([name, value]) => {
    if (typeof value !== "number" || (candidate.plant.type === "ipdt" && name === "T" && value === 0)) return [];
    const unit = parameterUnit(candidate.plant, name, units);
    const text = open(name, value) ? formatParameter(value) : formatUncertain(value, errors[name]);
    return [`${name} ${text}${unit ? ` ${unit}` : ""}${open(name, value) ? UNDETERMINED : ""}`];
  });
  const coefficients = coefficientsOf(candidate.plant);
  const unnamed = Object.keys(errors).filter((name) => typeof candidate.plant[name] !== "number");
  return [
    ...texts,
    ...unnamed.map((name) => (open(name, coefficients[name]) ? `${name}${UNDETERMINED}` : `${name} ± ${formatNumber(errors[name], 2)}`)),
  ];
}

const UNDETERMINED = ", not determined by the record";

/** The coefficients of (b s + K)/(a2 s^2 + a1 s + 1) by their names. */
function coefficientsOf({ num, den }: Candidate["plant"]): Partial<Record<string, number>> {
  if (!Array.isArray(num) || !Array.isArray(den)) return {};
  const [K, b] = [...num].reverse() as number[];
  const [, a1, a2] = [...den].reverse() as number[];
  return { K, b, a1, a2 };
}
