// Buttons that copy a text to the clipboard and confirm it.
import type { AsEntered } from "../api/types.ts";
import { h } from "../dom.ts";

export interface CopyOptions {
  /** The text of the button. */
  label: string;
  /** The text for a screen reader if the label alone is not sufficient. */
  spoken?: string;
  look?: string;
  /** Null: there is nothing to copy now. */
  text(): string | null;
}

const SHOWN_MS = 2000;

export function copyButton(options: CopyOptions, announce: (sentence: string) => void): HTMLButtonElement {
  const button = h(
    "button",
    { type: "button", class: options.look, "aria-label": options.spoken, onclick: () => void copy() },
    options.label,
  );
  let timer: ReturnType<typeof setTimeout> | undefined;

  async function copy(): Promise<void> {
    const text = options.text();
    if (text === null) return;
    const done = await toClipboard(text);
    button.textContent = done ? "Copied" : "Not copied: select it by hand";
    button.removeAttribute("aria-label");
    announce(`${button.textContent}.`);
    clearTimeout(timer);
    timer = setTimeout(() => {
      button.textContent = options.label;
      if (options.spoken) button.setAttribute("aria-label", options.spoken);
    }, SHOWN_MS);
  }

  return button;
}

async function toClipboard(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copyBySelection(text);
  }
}

/** The old method: pages without TLS from another machine have no clipboard object. */
function copyBySelection(text: string): boolean {
  const area = h("textarea", { class: "visually-hidden", "aria-hidden": "true", tabindex: -1 });
  area.value = text;
  document.body.append(area);
  const before = document.activeElement;
  area.select();
  const done = document.execCommand("copy");
  area.remove();
  if (before instanceof HTMLElement) before.focus();
  return done;
}

/** Text to paste into the user's program or file, with the settings in it; each with its own copy button. Empty for a
    product that is not set by text. */
export function snippetBlocks({ snippets = [] }: AsEntered, announce: (sentence: string) => void): HTMLElement[] {
  return snippets.map(({ name, text }) =>
    h(
      "figure",
      { class: "snippet" },
      h("figcaption", {}, h("span", {}, name), copyButton({ label: "Copy text", spoken: `Copy text: ${name}`, text: () => text }, announce)),
      h("pre", { class: "code", tabindex: 0, role: "region", "aria-label": name }, text),
    ),
  );
}
