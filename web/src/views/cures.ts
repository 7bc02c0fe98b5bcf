// Buttons that apply the cure of a refusal.
import type { Job, TuningRequest } from "../api/types.ts";
import { h } from "../dom.ts";
import { withOptions } from "../form/tuning_request.ts";

interface Cured {
  text: string;
  request: TuningRequest;
}

/** The cures of the whole job, and of each method without a controller; every text once. */
function curesOf(job: Job): Cured[] {
  const request = job.request;
  if (!request) return [];
  const refusals = [
    { error: job.error, method: null },
    ...(job.result?.controllers ?? []).map((entry) => ({ error: entry.error, method: entry.method })),
  ];
  const cures = refusals.flatMap(({ error, method }) =>
    error?.cure ? [{ text: error.cure.text, request: withOptions(request, method, error.cure.options) }] : [],
  );
  return cures.filter((cure, index) => cures.findIndex((other) => other.text === cure.text) === index);
}

export interface CureButtons {
  element: HTMLElement;
  show(job: Job | null): void;
}

/** `run` tunes the changed request; its caller shows its exceptions. */
export function cureButtons(run: (request: TuningRequest) => Promise<void>): CureButtons {
  const element = h("p", { class: "actions", hidden: true });
  let shown: Job | null = null;
  return {
    element,
    show(job) {
      if (job === shown) return;
      shown = job;
      const cures = job ? curesOf(job) : [];
      element.hidden = cures.length === 0;
      element.replaceChildren(
        ...cures.map(({ text, request }) =>
          h("button", { type: "button", class: "primary", onclick: () => void run(request) }, text),
        ),
      );
    },
  };
}
