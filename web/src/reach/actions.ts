// The actions of the present screen, read from its buttons, links and folded parts: a new one is found without a line
// here.

export interface ScreenAction {
  /** What its button says. */
  text: string;
  /** The card that has it. */
  place: string;
  run(): void;
}

/** Parts whose controls make no sense by their name alone. */
const NOT_IN = "table, [role=listbox], [role=tablist], .combobox, dialog";

const wordsOf = (element: Element | null | undefined): string => (element?.textContent ?? "").replaceAll(/\s+/g, " ").trim();

const nameOf = (element: Element): string => element.getAttribute("aria-label") ?? wordsOf(element);

/** The heading of the card around it. */
function placeOf(element: Element): string {
  const card = element.closest("section, fieldset, main");
  const label = card?.getAttribute("aria-labelledby");
  const named = label ? document.getElementById(label) : null;
  return card?.getAttribute("aria-label") ?? wordsOf(named ?? card?.querySelector("h1, h2, h3, legend"));
}

/** Folded parts around an element, the outermost first. */
function foldsAround(element: Element): HTMLDetailsElement[] {
  const folds: HTMLDetailsElement[] = [];
  for (let at = element.parentElement?.closest("details"); at; at = at.parentElement?.closest("details")) folds.unshift(at);
  return folds;
}

/** Hidden by more than a closed fold. */
function isAbsent(element: HTMLElement): boolean {
  for (let at: HTMLElement | null = element; at; at = at.parentElement) if (at.hidden || at.classList.contains("absent")) return true;
  return false;
}

function run(element: HTMLElement): void {
  for (const fold of foldsAround(element)) if (!fold.classList.contains("menu")) fold.open = true;
  if (!element.closest(".menu-items")) {
    element.scrollIntoView({ block: "nearest" });
    element.focus();
  }
  element.click();
}

export function actionsOf(main: Element | null): ScreenAction[] {
  const found = new Map<string, ScreenAction>();
  for (const element of main?.querySelectorAll<HTMLElement>("button, summary, a[href]") ?? []) {
    if (element.closest(NOT_IN) || element.matches(":disabled") || isAbsent(element)) continue;
    if (element.matches("a") && element.closest("p:not(.actions), li, td, dd")) continue;
    const menu = element.matches("summary") ? null : element.closest("details.menu");
    const name = menu ? `${wordsOf(menu.querySelector("summary"))}: ${nameOf(element)}` : nameOf(element);
    const place = placeOf(element);
    const key = `${name}\n${place}`;
    if (name !== "" && !found.has(key)) found.set(key, { text: name, place, run: () => run(element) });
  }
  return [...found.values()];
}
