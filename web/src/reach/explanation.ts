// A figure that explains itself: its label is a button that opens two sentences, a picture and a link to a document.
import type { Child } from "../dom.ts";
import { h, svgElement, uniqueId } from "../dom.ts";
import type { ExplainedName } from "../words/explained.ts";

const MARGIN_PX = 8;

/** Loads the texts when the first one is asked for. */
async function open(button: HTMLElement, name: ExplainedName): Promise<void> {
  const [{ EXPLANATIONS }, { documentAddress }, { picture }] = await Promise.all([
    import("../words/explained.ts"),
    import("../words/documents.ts"),
    import("../charts/explaining.ts"),
  ]);
  const { title, text, more, ...rest } = EXPLANATIONS[name];
  const heading = h("h3", { id: uniqueId("explanation") }, title);
  const close = h("button", { type: "button", class: "quiet", onclick: () => box.hidePopover() }, "Close");
  const box = h(
    "div",
    { class: "explanation", popover: "auto", role: "dialog", "aria-labelledby": heading.id, tabindex: -1 },
    h("div", { class: "head" }, heading, close),
    "picture" in rest ? svgElement(picture(rest.picture, title)) : "",
    h("p", {}, text),
    h("p", {}, h("a", { href: documentAddress(more[0], more[1]) }, "Read more")),
  );
  box.addEventListener("toggle", (event) => {
    if ((event as ToggleEvent).newState === "closed") box.remove();
  });
  // Next to the button in the document, so that Tab goes on from there; inside a dialog it must be in the dialog.
  (button.closest("dialog") ?? document.body).append(box);
  box.showPopover();
  place(box, button.getBoundingClientRect());
  box.focus();
}

/** Under the pointer the browser shows the text itself. */
async function nameText(button: HTMLElement, name: ExplainedName): Promise<void> {
  const texts = await import("../words/explained.ts").catch(() => null);
  if (texts) button.title = texts.EXPLANATIONS[name].text;
}

/** Below the button, or above it; inside the window. */
function place(box: HTMLElement, button: DOMRect): void {
  const { width, height } = box.getBoundingClientRect();
  const below = button.bottom + MARGIN_PX;
  const fits = below + height <= window.innerHeight - MARGIN_PX;
  const top = fits ? below : Math.max(MARGIN_PX, button.top - height - MARGIN_PX);
  const left = Math.max(MARGIN_PX, Math.min(button.left, window.innerWidth - width - MARGIN_PX));
  box.style.top = `${top}px`;
  box.style.left = `${left}px`;
}

/** `label`: what the button shows; `spoken`: its name if that is not enough. */
export function explained(name: ExplainedName, label: Child, spoken = ""): HTMLButtonElement {
  const button = h("button", { type: "button", class: "explain", "aria-haspopup": "dialog", "aria-label": spoken || null }, label);
  // The texts are loaded with the first hover.
  button.addEventListener("pointerenter", () => void nameText(button, name), { once: true });
  button.addEventListener("click", () => void open(button, name).catch(() => undefined));
  return button;
}
