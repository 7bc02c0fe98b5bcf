// A job in progress: fraction, stage, message, the best so far, and a button to stop it.
import type { Job } from "../../api/types.ts";
import { h } from "../../dom.ts";
import { formatNumber } from "../../words/numbers.ts";

export interface ProgressCard {
  element: HTMLElement;
  /** `what`: the reason for it, if the search is not what the user waits for. */
  show(job: Job, what?: string): void;
}

const STAGES: Record<string, string> = {
  identify: "Finding a model",
  tune: "Searching for the best controller",
  schedule: "Searching for the schedule",
  evaluate: "Computing the figures",
};

const KEPT = "The settings stay as they are. The designs beside them are computed again for the report and the change sheet.";

/** Time between two spoken updates. */
const SPEAK_EVERY_MS = 5000;

export function progressCard(announce: (sentence: string) => void, onCancel: () => void): ProgressCard {
  let spoken = 0;
  const stage = h("h2", { id: "progress-title" }, "Waiting");
  const bar = h("progress", { max: 1, value: 0, "aria-labelledby": "progress-title" });
  const message = h("p", {});
  const best = h("p", { class: "hint" });
  const cancel = h("button", { type: "button", onclick: onCancel }, "Cancel");
  const element = h(
    "section",
    { class: "card progress", "aria-labelledby": "progress-title" },
    stage,
    bar,
    message,
    best,
    h("div", { class: "actions" }, cancel),
  );
  return {
    element,
    show(job, what = "") {
      const progress = job.progress;
      const fraction = typeof progress?.fraction === "number" ? Math.min(1, Math.max(0, progress.fraction)) : 0;
      bar.value = fraction;
      const words = STAGES[progress?.stage ?? ""] ?? (progress?.stage || "Working");
      stage.textContent =
        job.status === "queued" ? "Waiting for its turn" : `${what || words}: ${Math.round(100 * fraction)} %`;
      message.textContent = what ? KEPT : (progress?.message ?? "");
      best.textContent = what ? "" : bestWords(progress?.best);
      if (Date.now() - spoken > SPEAK_EVERY_MS) {
        spoken = Date.now();
        announce(stage.textContent);
      }
    },
  };
}

/** "Best so far: Kp 2.58, Ti 16.1, ...", with the figures that are present. */
export function bestWords(best: Record<string, unknown> | null | undefined): string {
  const parts: string[] = [];
  const collect = (value: unknown, name: string): void => {
    if (typeof value === "number" && name !== "b" && name !== "c")
      parts.push(`${name.replaceAll("_", " ")} ${formatNumber(value)}`);
    else if (typeof value === "object" && value !== null && !Array.isArray(value))
      for (const [key, inner] of Object.entries(value)) collect(inner, key);
  };
  collect(best, "");
  return parts.length > 0 ? `Best so far: ${parts.slice(0, 8).join(", ")}.` : "";
}
