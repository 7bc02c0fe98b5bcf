// A text field that finds one item of a long list: the combobox pattern, which can be used with the keyboard alone.
import { h, uniqueId } from "../dom.ts";
import { textField } from "./controls.ts";
import type { ControlOptions, Field } from "./controls.ts";
import type { FormErrors } from "./errors.ts";

export interface Choice {
  id: string;
  /** The text of the field once the item is chosen. */
  text: string;
  /** Shown next to the text in the list. */
  aside: string;
}

export interface Combobox {
  element: HTMLElement;
  field: Field<HTMLInputElement>;
  /** Shows a choice without reporting it; null empties the field. */
  set(choice: Choice | null): void;
  /** The typed text that is not an item and was left in the field; else "". */
  unmatched(): string;
  /** The list has changed: searched again if it is open. */
  refresh(): void;
}

export interface ComboboxOptions extends ControlOptions {
  /** The items that match the typed text, best first. */
  find(typed: string): Choice[];
  /** null: the field was emptied. */
  onChoose(choice: Choice | null): void;
  /** The field was left empty, or with a text that is not an item: an earlier choice is kept. */
  onLeft?(): void;
}

export function combobox(options: ComboboxOptions, errors: FormErrors): Combobox {
  let chosen: Choice | null = null;
  let found: Choice[] = [];
  /** Index of the option that Enter takes; -1: none. */
  let active = -1;
  const field = textField(options, errors);
  const { input } = field;
  const list = h("ul", { class: "finds", role: "listbox", id: uniqueId("options"), "aria-label": options.label });
  const count = h("p", { class: "visually-hidden", role: "status" });
  const none = h("p", { class: "finds none", hidden: true });
  const element = h("div", { class: "combobox" }, field.element, count);
  list.hidden = true;
  // Keeps the focus in the field: losing it would close the list before the click selects the option.
  list.addEventListener("mousedown", (event) => event.preventDefault());
  // The list hangs below the field, above its hint.
  input.after(h("div", { class: "hanger" }, list, none));
  for (const [name, value] of [
    ["role", "combobox"],
    ["aria-autocomplete", "list"],
    ["aria-expanded", "false"],
    ["aria-controls", list.id],
  ] as const)
    input.setAttribute(name, value);

  /** The text of the field that is not the chosen item's. */
  const stray = (): string => (input.value === chosen?.text ? "" : input.value.trim());
  const isOpen = (): boolean => !list.hidden || !none.hidden;

  function activate(index: number): void {
    active = index;
    const items = [...list.children];
    items.forEach((item, at) => item.setAttribute("aria-selected", String(at === index)));
    const item = items[index];
    if (item) {
      input.setAttribute("aria-activedescendant", item.id);
      item.scrollIntoView({ block: "nearest" });
    } else {
      input.removeAttribute("aria-activedescendant");
    }
  }

  function optionOf(choice: Choice): HTMLElement {
    const item = h(
      "li",
      { role: "option", id: uniqueId("option"), "aria-selected": "false", class: choice.id === chosen?.id ? "chosen" : null },
      h("span", {}, choice.text),
      h("span", { class: "aside" }, choice.aside),
    );
    item.addEventListener("click", () => take(choice));
    return item;
  }

  /** `all`: shows all items whatever is typed, as when the list is opened on a chosen item. */
  function open(all: boolean): void {
    found = options.find(all ? "" : input.value);
    list.replaceChildren(...found.map(optionOf));
    list.hidden = found.length === 0;
    none.hidden = found.length > 0;
    none.textContent = `There is no entry "${input.value.trim()}".`;
    count.textContent = found.length === 0 ? none.textContent : `${found.length} ${found.length === 1 ? "entry" : "entries"}`;
    input.setAttribute("aria-expanded", String(!list.hidden));
    const at = all ? found.findIndex((choice) => choice.id === chosen?.id) : input.value.trim() === "" ? -1 : 0;
    activate(Math.min(at, found.length - 1));
  }

  function close(): void {
    list.hidden = true;
    none.hidden = true;
    count.textContent = "";
    input.setAttribute("aria-expanded", "false");
    activate(-1);
  }

  function take(choice: Choice | null): void {
    const changed = choice?.id !== chosen?.id;
    chosen = choice;
    input.value = choice?.text ?? "";
    close();
    if (changed) options.onChoose(choice);
  }

  input.addEventListener("input", () => open(false));
  // Typing replaces the chosen item.
  input.addEventListener("focus", () => input.select());
  input.addEventListener("click", () => {
    if (isOpen()) return close();
    input.select();
    open(true);
  });
  input.addEventListener("blur", () => {
    close();
    if (input.value.trim() === "") take(null);
    // An incomplete name chooses nothing, and stays: if it were replaced, the earlier choice would look like a new one.
    if (!chosen || stray() !== "") options.onLeft?.();
  });
  input.addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step !== undefined) {
      event.preventDefault();
      if (!isOpen()) open(true);
      if (found.length === 0) return;
      const next = active < 0 && step < 0 ? found.length - 1 : active + step;
      activate((next + found.length) % found.length);
    } else if (event.key === "Enter") {
      if (!isOpen()) return;
      event.preventDefault();
      const choice = found[active];
      if (choice) take(choice);
      else if (input.value.trim() === "") take(null);
    } else if (event.key === "Escape" && (isOpen() || stray() !== "")) {
      event.preventDefault();
      input.value = chosen?.text ?? "";
      errors.settle(field.control);
      input.select();
      close();
    }
  });

  return {
    element,
    field,
    set(choice) {
      chosen = choice;
      if (document.activeElement === input && isOpen()) return;
      input.value = choice?.text ?? "";
      errors.settle(field.control);
    },
    unmatched: () => (isOpen() ? "" : stray()),
    refresh() {
      if (!isOpen()) return;
      const marked = found[active]?.id;
      open(false);
      const at = found.findIndex((choice) => choice.id === marked);
      if (at > 0) activate(at);
    },
  };
}
