// A button that is pressed stays under the pointer. Leaving a field for it asks the service anew; what the answer changes
// above it would move it, and the press that began on it would end beside it and do nothing.

let pressed = false;
let waiting: (() => void)[] = [];

function release(): void {
  pressed = false;
  const [...due] = waiting;
  waiting = [];
  for (const go of due) go();
}

/** Watches buttons and links from now on. */
export function watchPresses(page: Document): void {
  page.addEventListener(
    "pointerdown",
    (event) => {
      pressed = event.button === 0 && event.target instanceof Element && event.target.closest("button, a, summary") !== null;
    },
    true,
  );
  // The click follows in the same turn.
  for (const name of ["pointerup", "pointercancel"]) page.addEventListener(name, () => setTimeout(release), true);
  page.defaultView?.addEventListener("blur", release);
}

/** At once, unless a button is pressed: then when it has been let go. */
export const untilReleased = (): Promise<void> => (pressed ? new Promise((go) => waiting.push(go)) : Promise.resolve());
