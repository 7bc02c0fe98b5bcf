// A button that is pressed stays under the pointer. Leaving a field for it judges what stands there and asks the service
// anew; what that changes above the button would move it, and the press that began on it would end beside it and do nothing.

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

/** Goes at once, unless a button is pressed: then when it has been let go. */
export function whenReleased(go: () => void): void {
  if (pressed) waiting.push(go);
  else go();
}

export const untilReleased = (): Promise<void> => new Promise(whenReleased);
