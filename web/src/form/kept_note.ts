// The members of a loaded request that no field shows: they are sent unchanged, listed here, and can be removed.
import { h } from "../dom.ts";

export interface KeptNote {
  element: HTMLElement;
  /** Hides itself if there are none. */
  show(parts: Record<string, unknown>): void;
}

const LONGEST_VALUE = 40;

/** "evaluate.horizon 77" for each value, by its place in the request. */
export function keptWords(parts: Record<string, unknown>): string[] {
  return Object.entries(parts).flatMap(([name, value]) => {
    if (value === undefined) return [];
    if (typeof value === "object" && value !== null && !Array.isArray(value))
      return keptWords(value as Record<string, unknown>).map((words) => `${name}.${words}`);
    const text = JSON.stringify(value);
    return [`${name} ${text.length > LONGEST_VALUE ? `${text.slice(0, LONGEST_VALUE)}…` : text}`];
  });
}

/** `about`: the owner of the members, for screen readers, which may read the button alone. */
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

/** An object that was written as JSON, perhaps by hand; an empty one if it was not. */
export function objectOf(json: string | undefined): Record<string, unknown> {
  try {
    const read: unknown = JSON.parse(json || "{}");
    return typeof read === "object" && read !== null && !Array.isArray(read) ? (read as Record<string, unknown>) : {};
  } catch {
    return {};
  }
}
