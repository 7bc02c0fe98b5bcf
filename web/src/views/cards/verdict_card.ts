// The verdict of the chosen controller, or why a job has none.
import type { Job, Result } from "../../api/types.ts";
import { h } from "../../dom.ts";
import { reasonOf } from "../../words/league.ts";
import { verdictOf } from "../../words/verdict.ts";

/** `listed`: the entries whose failures are worth a line here. */
export function showVerdict(
  card: HTMLElement,
  job: Job,
  result: Result,
  names: string[],
  selected: number,
  listed: number[],
): void {
  const entries = result.controllers;
  const today = entries.find((candidate) => candidate.method === "baseline");
  const words = verdictOf(entries[selected]!, today, job.request);
  const sentences = [...words.sentences];
  if (job.status === "cancelled" || result.partial)
    sentences.unshift("Stopped early: this is the best found until then.");
  const who = entries.length > 1 ? h("span", { class: "who" }, `${names[selected]}: `) : null;
  const failures = entries.flatMap((entry, index) =>
    entry.error && index !== selected && listed.includes(index)
      ? [h("li", {}, h("strong", {}, `${names[index]}: `), reasonOf(entry))]
      : [],
  );
  card.className = `verdict ${words.level}`;
  card.replaceChildren(h("h2", {}, who, words.head), h("p", {}, sentences.join(" ")));
  if (failures.length > 0) card.append(h("ul", {}, failures));
}

/** For a job that ended without any controller. */
export function showFailure(card: HTMLElement, job: Job): void {
  const cancelled = job.status === "cancelled";
  const silent = cancelled ? "Nothing is kept of it; the request is." : "The service gave no reason.";
  const faults = (job.error?.errors ?? []).filter((fault) => fault.detail !== job.error?.detail);
  card.className = "verdict bad";
  card.replaceChildren(
    h("h2", {}, cancelled ? "Stopped before a controller was found." : "This could not be done."),
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
