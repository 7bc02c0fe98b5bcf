// How much better any other controller could be, as far as it is proved; and the request for a proof.
import { getText, sentenceOf } from "../api/client.ts";
import type { Entry } from "../api/types.ts";
import { h, uniqueId } from "../dom.ts";
import { textField } from "../form/controls.ts";
import { FormErrors } from "../form/errors.ts";
import { parseNumber } from "../form/number.ts";
import { download } from "../plot/export.ts";
import { certificateFacts, provedWords } from "./words.ts";
import { documentAddress } from "../words/documents.ts";
import { figureUnit } from "../words/figure_units.ts";
import { withMinus } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";

/** The place of an entry in a stored job. */
export interface StoredEntry {
  job: string;
  index: number;
}

export interface CertificateCard {
  element: HTMLElement;
  /** Hides itself if the entry is of a method without proofs. `stored`: null for a design that is not that of the job. */
  show(entry: Entry, stored: StoredEntry | null, units: UnitNames): void;
  dispose(): void;
}

/** The method that can be proved. */
const PROVED = "robust";
/** In percent, as in the library of problems. */
const USUAL_GAP = "1";
const NOT_CERTIFIED = "not-certified";

/** `prove`: designs again with a proof to this gap, and shows the answer. */
export function certificateCard(prove: (gap: number) => Promise<void>): CertificateCard {
  const errors = new FormErrors();
  let stored: StoredEntry | null = null;
  const title = h("h2", { id: uniqueId("certificate") }, "How much better could another be?");
  const sentence = h("p", { class: "proved", hidden: true });
  const facts = h("dl", { hidden: true });
  const gap = textField({ label: "Prove it to within", unit: "%", value: USUAL_GAP, pointer: () => "/gap" }, errors);
  const proveButton = h("button", { type: "submit" }, "Prove it");
  const form = h("form", { class: "prove" }, gap.element, proveButton);
  const save = h("button", { type: "button", onclick: () => void saveFile() }, "Certificate file");
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const about = h("p", { class: "hint" }, "A proof searches all controllers of a box by intervals; it may take a minute. ", h("a", { href: documentAddress("proof", "what-is-proved-and-what-is-not"), target: "_blank" }, "What is proved, and what is not"));
  const fold = h("details", {}, h("summary", {}, title), sentence, facts, form, h("div", { class: "actions" }, save), trouble, about);
  const element = h("section", { class: "card certificate", "aria-labelledby": title.id, hidden: true }, fold);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void begin();
  });

  function complain(words: string): void {
    trouble.textContent = words;
    trouble.hidden = words === "";
  }

  async function begin(): Promise<void> {
    const parsed = parseNumber(gap.input.value, "The gap");
    if (!parsed.ok) return errors.refuse(gap.control, parsed.sentence);
    await during(proveButton, () => prove(parsed.value / 100));
  }

  /** The service computes the proof again, with its boxes. */
  async function saveFile(): Promise<void> {
    if (!stored) return;
    const { job, index } = stored;
    await during(save, async () => {
      const { text, name } = await getText(`v1/jobs/${encodeURIComponent(job)}/controllers/${index}/certificate`);
      download(new Blob([text], { type: "application/jsonl" }), name || "certificate.jsonl");
    });
  }

  async function during(button: HTMLButtonElement, work: () => Promise<void>): Promise<void> {
    complain("");
    button.disabled = true;
    element.setAttribute("aria-busy", "true");
    try {
      await work();
    } catch (error) {
      complain(sentenceOf(error));
    } finally {
      button.disabled = false;
      element.removeAttribute("aria-busy");
    }
  }

  return {
    element,
    show(entry, place, units) {
      stored = place;
      const { certificate } = entry;
      const unit = figureUnit("LoadPerformance", "IAE", units);
      element.hidden = !certificate && (entry.method !== PROVED || !entry.controller || !place);
      const refused = entry.warnings?.find(({ code }) => code === NOT_CERTIFIED);
      sentence.textContent = certificate ? provedWords(certificate, unit) : (refused?.detail ?? "");
      sentence.className = certificate ? (certificate.complete ? "proved good" : "proved") : "proved hint";
      sentence.hidden = sentence.textContent === "";
      facts.hidden = !certificate;
      facts.replaceChildren(...(certificate ? certificateFacts(certificate, unit).flatMap(([label, text]) => [h("dt", {}, label), h("dd", {}, withMinus(text))]) : []));
      if (certificate) fold.open = true;
      form.hidden = !place || refused !== undefined || certificate?.complete === true;
      save.hidden = !place || !certificate;
      complain("");
    },
    dispose: () => undefined,
  };
}
