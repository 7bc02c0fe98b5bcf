// What a loaded request has and no field shows: it is sent as it came, so it is said, and can be left out.
import { h } from "../dom.ts";

export interface KeptNote {
  element: HTMLElement;
  /** Hides itself where there is nothing. */
  show(parts: Record<string, unknown>): void;
}

const LONGEST_VALUE = 40;

/** "evaluate.horizon 77" of each value, by its place in the request. */
export function keptWords(parts: Record<string, unknown>): string[] {
  return Object.entries(parts).flatMap(([name, value]) => {
    if (value === undefined) return [];
    if (typeof value === "object" && value !== null && !Array.isArray(value))
      return keptWords(value as Record<string, unknown>).map((words) => `${name}.${words}`);
    const text = JSON.stringify(value);
    return [`${name} ${text.length > LONGEST_VALUE ? `${text.slice(0, LONGEST_VALUE)}…` : text}`];
  });
}

/** `about`: what the parts belong to, for those who hear the button alone. */
export function keptNote(about: string, onForget: () => void): KeptNote {
  const words = h("span", {});
  const forget = h(
    "button",
    { type: "button", class: "quiet", onclick: onForget },
    "Leave it out",
    h("span", { class: "visually-hidden" }, ` of ${about}`),
  );
  const element = h("p", { class: "hint", role: "status", hidden: true }, words, " ", forget);
  return {
    element,
    show(parts) {
      const list = keptWords(parts);
      element.hidden = list.length === 0;
      words.textContent = `Also sent as loaded, without a field here: ${list.join(", ")}.`;
    },
  };
}
