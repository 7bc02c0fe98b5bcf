// A check while it runs: how many loops are done, and a button to stop it.
import type { CheckJob, Progress } from "../api/types.ts";
import { h } from "../dom.ts";

export interface CheckProgress {
  element: HTMLElement;
  show(job: CheckJob): void;
  follow(progress: Progress | null): void;
}

/** Time between two spoken updates. */
const SPEAK_EVERY_MS = 5000;

export function checkProgress(announce: (sentence: string) => void, onCancel: () => void): CheckProgress {
  let spoken = 0;
  const title = h("h2", { id: "check-progress" }, "Waiting for its turn");
  const bar = h("progress", { max: 1, value: 0, "aria-labelledby": "check-progress" });
  const message = h("p", {});
  const cancel = h("button", { type: "button", onclick: onCancel }, "Cancel");

  function follow(progress: Progress | null): void {
    const fraction = Math.min(1, Math.max(0, progress?.fraction ?? 0));
    bar.value = fraction;
    title.textContent = `Checking: ${Math.round(100 * fraction)} %`;
    message.textContent = progress?.message ?? "";
    if (Date.now() - spoken < SPEAK_EVERY_MS) return;
    spoken = Date.now();
    announce(title.textContent);
  }

  return {
    element: h("section", { class: "card progress", "aria-labelledby": "check-progress" }, title, bar, message, h("div", { class: "actions" }, cancel)),
    show({ status, progress }) {
      if (status !== "queued") return follow(progress ?? null);
      title.textContent = "Waiting for its turn";
      bar.value = 0;
      message.textContent = "";
    },
    follow,
  };
}
