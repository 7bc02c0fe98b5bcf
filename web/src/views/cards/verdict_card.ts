// The verdict on the chosen controller, or the reason why a job has none.
import type { Finding, Job, Result } from "../../api/types.ts";
import { h } from "../../dom.ts";
import { reasonOf } from "../../words/comparison.ts";
import { factsOf } from "../../words/facts.ts";
import type { Fact } from "../../words/facts.ts";
import { withMinus } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";
import { CHANGED } from "./replay_card.ts";
import { explained } from "../../reach/explanation.ts";
import { timeUnitDoubt } from "../../words/quality.ts";

/** The classes of the levels; a note looks like ordinary text. */
export const LEVEL_CLASS: Record<Finding["level"], string> = { good: "good", note: "", warning: "warn", bad: "bad" };

/** For results that were stored before the service had verdicts. */
const NO_VERDICT: Finding = { code: "none", level: "note", text: "Tuned by an older version: tune again for a verdict.", figures: {} };

const said = (finding: Finding): HTMLElement =>
  h("span", { class: LEVEL_CLASS[finding.level], "data-code": finding.code }, `${withMinus(finding.text)} `);

/** `listed`: the entries whose failures get a line here. `recordAddress`: where to change the options for reading
    the record. */
export function showVerdict(
  card: HTMLElement,
  result: Result,
  names: string[],
  selected: number,
  listed: number[],
  recordAddress: string,
  units: UnitNames,
): void {
  const entries = result.controllers;
  const [head = NO_VERDICT, ...others] = entries[selected]!.verdict ?? [];
  const stopped = result.verdict?.filter((finding) => finding.code === "stopped-early") ?? [];
  const who = entries.length > 1 ? h("span", { class: "who" }, `${names[selected]}: `) : null;
  const failures = entries.flatMap((entry, index) =>
    entry.error && index !== selected && listed.includes(index)
      ? [h("li", {}, h("strong", {}, `${names[index]}: `), reasonOf(entry))]
      : [],
  );
  // The replay of the design from which a slider moved away would be that of another loop.
  const selectedEntry = entries[selected]!;
  const notReplayed = Boolean(result.replay && !result.replay.refused && selectedEntry.controller && !selectedEntry.replay);
  card.className = `verdict ${LEVEL_CLASS[head.level]}`;
  const today = entries.find((entry) => entry.method === "baseline");
  const facts = factsOf(entries[selected]!, today, units).map(factElement);
  card.replaceChildren(
    h("h2", {}, who, withMinus(head.text)),
    facts.length > 0 ? h("dl", { class: "facts" }, facts) : "",
    h("p", {}, [...stopped, ...others].map(said), notReplayed ? CHANGED : ""),
  );
  if (failures.length > 0) card.append(h("ul", {}, failures));
  const doubt = result.model ? timeUnitDoubt(result.model) : "";
  if (doubt) card.append(h("p", { class: "trouble" }, `${doubt} `, h("a", { href: recordAddress }, "Choose the unit")));
}

const factElement = ({ label, about, value, reference }: Fact): HTMLElement =>
  h("div", {}, h("dt", {}, explained(about, label)), h("dd", {}, value, reference ? h("small", {}, ` ${reference}`) : ""));

/** The headings for kinds of failures. */
function failedHead(job: Job): string {
  const kind = job.error?.type ?? "";
  if (kind.endsWith("no-feasible-controller")) return "No controller meets these limits.";
  if (kind.endsWith("unstable-plant")) return "No controller of this kind stabilises the plant.";
  if (kind.endsWith("not-identifiable")) return "The record determines no model.";
  if (kind.endsWith("timeout")) return "The time limit was reached.";
  return "No controller was found.";
}

/** For a job that ended without any controller. */
export function showFailure(card: HTMLElement, job: Job): void {
  const cancelled = job.status === "cancelled";
  const silent = cancelled ? "No result is kept, but the request is." : "The service gave no reason.";
  const faults = (job.error?.errors ?? []).filter((fault) => fault.detail !== job.error?.detail);
  card.className = "verdict bad";
  card.replaceChildren(
    h("h2", {}, cancelled ? "Stopped before a controller was found." : failedHead(job)),
    h("p", {}, job.error?.detail ?? job.error?.title ?? silent),
  );
  if (faults.length > 0) {
    card.append(
      h(
        "ul",
        {},
        faults.map((fault) => h("li", {}, fault.detail, h("code", {}, ` ${fault.pointer}`))),
      ),
    );
  }
}
