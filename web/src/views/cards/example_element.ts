// An example on Start: tuned unchanged, or shown in the form.
import type { Example } from "../../api/types.ts";
import { h } from "../../dom.ts";
import { formatRoute } from "../../routes.ts";

/** `tune`: by its own methods, or by all. */
export function exampleElement(example: Example, tune: (all: boolean) => void): HTMLElement {
  return h(
    "div",
    { class: "example" },
    h("h3", {}, example.title),
    h("p", { class: "hint" }, example.description),
    h(
      "p",
      { class: "actions" },
      h("button", { type: "button", onclick: () => tune(false), "aria-label": `Tune: ${example.title}` }, "Tune"),
      h(
        "button",
        {
          type: "button",
          class: "quiet",
          onclick: () => tune(true),
          "aria-label": `Compare all methods: ${example.title}`,
        },
        "Compare all",
      ),
      h(
        "a",
        { href: formatRoute({ screen: "example", id: example.id }), "aria-label": `See in the form: ${example.title}` },
        "See in the form",
      ),
    ),
  );
}
