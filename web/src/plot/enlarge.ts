// A plot over the whole window, and back: its element moves, so that cursor, zoom and everything else stay.
import { h, openDialog } from "../dom.ts";

export interface Enlarging {
  /** Enlarges it, or goes back. */
  toggle(): void;
  isLarge(): boolean;
  /** Goes back if it is large. */
  close(): void;
}

/** `onBack`: it is in its own place again. */
export function enlarging(element: HTMLElement, title: () => string, onChange: (large: boolean) => void): Enlarging {
  let dialog: HTMLDialogElement | null = null;

  function open(): void {
    // Keeps the place: nothing below it moves.
    const place = h("div", { class: element.className });
    place.style.height = `${element.getBoundingClientRect().height}px`;
    element.replaceWith(place);
    dialog = openDialog(title(), "enlarged", element);
    dialog.addEventListener("close", () => {
      dialog = null;
      place.replaceWith(element);
      onChange(false);
    });
    onChange(true);
  }

  return {
    toggle() {
      if (dialog) dialog.close();
      else open();
    },
    isLarge: () => dialog !== null,
    close: () => dialog?.close(),
  };
}
