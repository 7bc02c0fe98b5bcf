// Text to paste into the user's program or file, with the settings in it; each with its own copy button.
import type { AsEntered } from "../../api/types.ts";
import { h } from "../../dom.ts";
import { copyButton } from "../copy.ts";

/** Empty for a product that is not set by text. */
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
