// The keys and the buttons of the head that open help and search. Their dialogs are loaded when they are first used.
import { h } from "../dom.ts";
import type { Store } from "../store.ts";

/** A press of a letter belongs to the field or the dialog that has the focus. */
function typesText(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  const field = target instanceof HTMLInputElement && !["checkbox", "radio", "range", "button"].includes(target.type);
  return field || target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement || target.isContentEditable;
}

const dialogIsOpen = (): boolean => document.querySelector("dialog[open]") !== null;

/** Watches the keys, and returns the buttons. `announce`: tells readers who do not see the page what an action did, or
    why a dialog could not be loaded. */
export function shortcuts(store: Store, announce: (sentence: string) => void): HTMLElement[] {
  const away = (): void => announce("The service could not be reached; help and search are not loaded yet.");
  const help = (): void => void import("./help.ts").then(({ openHelp }) => openHelp(), away);
  const find = (): void => void import("./palette.ts").then(({ openPalette }) => openPalette(store, announce), away);

  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.altKey || dialogIsOpen()) return;
    const command = event.ctrlKey || event.metaKey;
    const finds = command && !event.shiftKey && event.key.toLowerCase() === "k";
    if (!finds && (command || event.key !== "?" || typesText(event.target))) return;
    event.preventDefault();
    if (finds) find();
    else help();
  });

  const button = (text: string, title: string, keys: string, onclick: () => void): HTMLElement =>
    h("button", { type: "button", title, "aria-keyshortcuts": keys, onclick }, text);
  return [
    button("Find", "Find a screen, method, controller, job or action (Ctrl+K)", "Control+K Meta+K", find),
    button("Help", "Keys and documents (?)", "?", help),
  ];
}
