// Asks for the service's key, on top of any screen.
import { h } from "../dom.ts";

export function askInDialog(refused: boolean): Promise<string | null> {
  const input = h("input", { id: "key", type: "password", autocomplete: "off", spellcheck: "false", required: true });
  const cancel = h("button", { type: "button" }, "Continue without a key");
  const form = h(
    "form",
    { method: "dialog" },
    h("h2", { id: "key-title" }, "This service asks for a key"),
    h(
      "p",
      { id: "key-help" },
      refused
        ? "That key is not known here. Try another one."
        : "The operator of the service issues keys. Yours stays in this tab until you close it.",
    ),
    h("label", { for: "key" }, "Key"),
    input,
    h("div", { class: "actions" }, h("button", { type: "submit", class: "primary" }, "Use this key"), cancel),
  );
  const dialog = h("dialog", { class: "key", "aria-labelledby": "key-title", "aria-describedby": "key-help" }, form);
  document.body.append(dialog);
  cancel.addEventListener("click", () => {
    dialog.close("");
  });
  return new Promise((resolve) => {
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      dialog.close(input.value.trim());
    });
    dialog.addEventListener("close", () => {
      resolve(dialog.returnValue === "" ? null : dialog.returnValue);
      dialog.remove();
    });
    dialog.showModal();
    input.focus();
  });
}
