// The controller as a program: Structured Text, C, Python or a sketch, to read, copy and save.
import { getCode } from "../api/products.ts";
import type { CodeQuestion } from "../api/products.ts";
import type { FieldError } from "../api/types.ts";
import { h, uniqueId } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import type { MyController } from "../my_controller.ts";
import type { UnitNames } from "../words/numbers.ts";
import { optionalNumber, sourceText } from "./source_text.ts";

export interface CodeSubject {
  job: string;
  index: CodeQuestion["index"];
  name: string;
  units: UnitNames;
}

export interface CodeCard {
  element: HTMLElement;
  /** null: there is no controller for a program. */
  show(subject: CodeSubject | null): void;
  /** Shows the text at once. */
  open(): void;
  /** Proposes the sample time and limits of the user's own controller. */
  propose(mine: MyController | null): void;
  dispose(): void;
}

export function codeCard(announce: (sentence: string) => void): CodeCard {
  let subject: CodeSubject | null = null;
  const errors = new FormErrors();
  const period = optionalNumber("Sample time", "sample_time", "Empty: one that suits the controller is proposed.", errors, ask);
  const low = optionalNumber("Least u", "u_min", "Empty: no limit.", errors, ask);
  const high = optionalNumber("Largest u", "u_max", "Empty: no limit.", errors, ask);
  const source = sourceText<CodeQuestion>(getCode, errors, ask, announce);
  const whose = h("p", { class: "hint" });
  const summary = h("summary", { id: uniqueId("code") }, "Controller as code: Structured Text, C, Python, Arduino");
  const details = h("details", {}, summary, whose, h("div", { class: "fields" }, period.element, low.element, high.element), ...source.elements);
  const element = h("section", { class: "card code-card", "aria-labelledby": summary.id, hidden: true }, details);
  details.addEventListener("toggle", ask);

  /** Only while the card is open: otherwise nobody reads the text. */
  function ask(): void {
    if (!subject || !details.open) return;
    const faults: FieldError[] = [];
    source.ask(
      {
        job: subject.job,
        index: subject.index,
        language: source.language(),
        sample_time: period.read(faults),
        u_min: low.read(faults),
        u_max: high.read(faults),
      },
      faults,
    );
  }

  return {
    element,
    show(next) {
      subject = next;
      element.hidden = !next;
      if (!next) return;
      const what = next.index === "schedule" ? `The schedule over ${next.name}` : next.index === "all" ? next.name : `The controller of ${next.name}`;
      whose.textContent = `${what} as a separate program, for a controller without a PID block or for a simulation. All times in it are in seconds.`;
      period.setUnit(next.units.time);
      low.setUnit(next.units.u);
      high.setUnit(next.units.u);
      ask();
    },
    open() {
      details.open = true;
      summary.focus();
    },
    propose(mine) {
      period.write(mine?.sample_time);
      low.write(mine?.u_span?.[0]);
      high.write(mine?.u_span?.[1]);
      ask();
    },
    dispose: source.dispose,
  };
}
