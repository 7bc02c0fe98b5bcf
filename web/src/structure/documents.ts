// The report and the code of a structure: both are those of a job, which is posted when one of them is wanted.
import { ApiError, sentenceOf } from "../api/client.ts";
import { endedStructure, postStructure } from "../api/structure.ts";
import type { StructureQuestion } from "../api/structure.ts";
import { h } from "../dom.ts";
import { codeCard } from "../program/code_card.ts";
import { reportLink } from "../views/report_link.ts";
import type { UnitNames } from "../words/numbers.ts";

export interface StructureDocuments {
  /** The buttons. */
  actions: HTMLElement[];
  code: HTMLElement;
  trouble: HTMLElement;
  /** The question of the answer on the screen; `job`: it has one already. */
  about(question: StructureQuestion, units: UnitNames, job?: string | null): void;
  dispose(): void;
}

export function structureDocuments(announce: (sentence: string) => void): StructureDocuments {
  let shown: { question: StructureQuestion; units: UnitNames } | null = null;
  let job: Promise<string> | null = null;
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const link = reportLink("Open the report");
  const code = codeCard(announce);
  const report = h("button", { type: "button", onclick: () => void withJob((id) => openReport(id)) }, "Report");
  const program = h("button", { type: "button", onclick: () => void withJob((id) => openCode(id)) }, "Code");

  async function withJob(use: (id: string) => void): Promise<void> {
    if (!shown) return;
    const asked = (job ??= postStructure(shown.question).then((posted) => endedStructure(posted)).then(({ id }) => id));
    try {
      const id = await asked;
      if (job === asked) use(id);
      trouble.hidden = true;
    } catch (error) {
      job = null;
      const [first] = error instanceof ApiError ? (error.problem.errors ?? []) : [];
      trouble.textContent = first?.detail ?? sentenceOf(error);
      trouble.hidden = false;
    }
  }

  /** A browser that opens no window by itself shows the link. */
  function openReport(id: string): void {
    link.show(id);
    link.element.click();
  }

  function openCode(id: string): void {
    code.show({ job: id, index: "all", name: "The structure", units: shown!.units });
    code.open();
  }

  return {
    actions: [report, program, link.element],
    code: code.element,
    trouble,
    about(question, units, posted = null) {
      shown = { question, units };
      job = posted === null ? null : Promise.resolve(posted);
      link.show(posted);
      code.show(null);
      trouble.hidden = true;
    },
    dispose: code.dispose,
  };
}
