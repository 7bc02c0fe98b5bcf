// A check while it runs: how many loops are done, and a button to stop it.
import { h } from "../dom.ts";
import type { CheckState } from "./source.ts";

export interface CheckProgress {
  element: HTMLElement;
  show(state: Pick<CheckState, "waits" | "fraction" | "message">): void;
}

/** Time between two spoken updates. */
const SPEAK_EVERY_MS = 5000;

export function checkProgress(announce: (sentence: string) => void, onCancel: () => Promise<void>): CheckProgress {
  let spoken = 0;
  const title = h("h2", { id: "check-progress" }, "Waiting for its turn");
  const bar = h("progress", { max: 1, value: 0, "aria-labelledby": "check-progress" });
  const message = h("p", {});
  const cancel = h("button", { type: "button", onclick: () => void stop() }, "Cancel");

  async function stop(): Promise<void> {
    cancel.textContent = "Stopping...";
    await onCancel();
    cancel.textContent = "Cancel";
  }

  return {
    element: h("section", { class: "card progress", "aria-labelledby": "check-progress" }, title, bar, message, h("div", { class: "actions" }, cancel)),
    show({ waits, fraction, message: words }) {
      bar.value = Math.min(1, Math.max(0, fraction));
      title.textContent = waits ? "Waiting for its turn" : `Checking: ${Math.round(100 * bar.value)} %`;
      message.textContent = waits ? "" : words;
      if (waits || Date.now() - spoken < SPEAK_EVERY_MS) return;
      spoken = Date.now();
      announce(title.textContent);
    },
  };
}
