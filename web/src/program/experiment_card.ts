// A test that the user's controller runs by itself, as a program with its levels and limits.
import { getExperiment } from "../api/products.ts";
import type { ExperimentQuestion, FieldError, RelayPlan } from "../api/types.ts";
import { h, uniqueId } from "../dom.ts";
import { choiceField } from "../form/controls.ts";
import { FormErrors } from "../form/errors.ts";
import { documentAddress } from "../words/documents.ts";
import type { UnitNames } from "../words/numbers.ts";
import { optionalNumber, sourceText } from "./source_text.ts";

export interface ExperimentCard {
  element: HTMLElement;
  setUnits(units: UnitNames): void;
  /** Proposes the step and the sample time of a plan, for fields that are empty. */
  propose(plan: RelayPlan | undefined, units: UnitNames): void;
  dispose(): void;
}

const ABOUT =
  "It stands between your controller and the actuator, measures the noise, runs within these limits, gives u back by itself, sets a safe u on any fault, and writes the record that Identify reads. Times are in seconds.";
/** In a period. */
const CALLS = 60;
const MEMBERS = [
  ["sample_time", "Sample time", "from call to call", "s"],
  ["u_step", "Step of u", "to either side; of a bump with its sign", "u"],
  ["u_min", "Least u", "empty: no limit", "u"],
  ["u_max", "Largest u", "empty: no limit", "u"],
  ["y_min", "Least y", "y below it stops the test", "y"],
  ["y_max", "Largest y", "y above it stops the test", "y"],
  ["u_safe", "Safe u", "after a fault; empty: as before the test", "u"],
  ["rate_limit", "Rate of u", "largest, per second; empty: no limit", "u"],
  ["max_time", "Longest test", "empty: 5000 calls", "s"],
  ["y_move", "Bump ends at", "move of y, for a plant that integrates", "y"],
] as const;

export function experimentCard(announce: (sentence: string) => void): ExperimentCard {
  const errors = new FormErrors();
  const kind = choiceField(
    { label: "Test", pointer: () => "/experiment", choices: [["relay", "Relay"], ["bump", "Bump: a step and back"]] },
    errors,
  );
  const action = choiceField(
    {
      label: "Controller acts",
      hint: "needed for a plant that is unstable or first moves the wrong way",
      pointer: () => "/action",
      choices: [["find", "not known: find out"], ["reverse", "reverse: u falls when y rises"], ["direct", "direct: u rises with y"]],
    },
    errors,
  );
  const members = MEMBERS.map(([name, label, hint, unit]) => ({ name, unit, field: optionalNumber(label, name, hint, errors, ask) }));
  for (const choice of [kind, action]) choice.input.addEventListener("change", ask);
  const source = sourceText<Partial<ExperimentQuestion>>(getExperiment, errors, ask, announce);
  const summary = h("summary", { id: uniqueId("experiment") }, "Let your controller run the test: a program");
  const about = h("p", { class: "hint" }, ABOUT, " ", h("a", { href: documentAddress("code", "a-test-that-a-controller-runs-by-itself"), target: "_blank" }, "How it works"));
  const fields = h("div", { class: "fields" }, kind.element, action.element, members.map(({ field }) => field.element));
  const details = h("details", {}, summary, about, fields, ...source.elements);
  const element = h("section", { class: "card code-card", "aria-labelledby": summary.id }, details);
  details.addEventListener("toggle", ask);

  function ask(): void {
    if (!details.open) return;
    const faults: FieldError[] = [];
    const experiment = kind.input.value as ExperimentQuestion["experiment"];
    action.element.hidden = experiment !== "relay";
    for (const { name, field } of members) if (name === "y_move") field.element.hidden = experiment !== "bump";
    const question: Partial<ExperimentQuestion> = { experiment, language: source.language() };
    if (experiment === "relay") question.action = action.input.value as NonNullable<ExperimentQuestion["action"]>;
    for (const { name, field } of members) {
      const value = field.read(faults);
      if (value !== undefined && (name !== "y_move" || experiment === "bump")) question[name] = value;
    }
    source.ask(question, faults);
  }

  return {
    element,
    setUnits(units) {
      for (const { unit, field } of members) field.setUnit(unit === "s" ? "s" : units[unit]);
    },
    propose(plan, units) {
      const write = (name: string, value: number): void => {
        const member = members.find((one) => one.name === name)!;
        if (member.field.read([]) === undefined) member.field.write(Number(value.toPrecision(2)));
      };
      if (plan?.u_plus !== undefined && plan.u_minus !== undefined) write("u_step", (plan.u_plus - plan.u_minus) / 2);
      if (plan?.expected_period !== undefined && units.time === "s") write("sample_time", plan.expected_period / CALLS);
      ask();
    },
    dispose: source.dispose,
  };
}
