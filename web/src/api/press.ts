// Keeps a pressed button under the pointer. Leaving a field for it checks the text and calls the service; a change
// above the button would move it, and the press would end next to it and do nothing.

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
  // The click follows in the same task.
  for (const name of ["pointerup", "pointercancel"]) page.addEventListener(name, () => setTimeout(release), true);
  page.defaultView?.addEventListener("blur", release);
}

/** Calls `go` now, or if a button is pressed, after its release. */
export function whenReleased(go: () => void): void {
  if (pressed) waiting.push(go);
  else go();
}

export const untilReleased = (): Promise<void> => new Promise(whenReleased);
