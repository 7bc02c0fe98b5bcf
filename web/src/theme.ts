// Light or dark: the system's setting, unless the reader chose. Loading it applies the choice: the served documents have
// no other script.
import { h } from "./dom.ts";

type Theme = "system" | "light" | "dark";
const KEY = "tunewright-theme";
const ORDER: Theme[] = ["system", "light", "dark"];
const TEXT: Record<Theme, string> = { system: "Theme: system", light: "Theme: light", dark: "Theme: dark" };

function stored(): Theme {
  try {
    const value = localStorage.getItem(KEY);
    return value === "light" || value === "dark" ? value : "system";
  } catch {
    return "system";
  }
}

let current: Theme = stored();

function applyTheme(): void {
  if (current === "system") delete document.documentElement.dataset["theme"];
  else document.documentElement.dataset["theme"] = current;
}

applyTheme();

/** A button that cycles through system, light and dark. */
export function themeButton(): HTMLButtonElement {
  const button = h("button", { type: "button" }, TEXT[current]);
  button.addEventListener("click", () => {
    current = ORDER[(ORDER.indexOf(current) + 1) % ORDER.length]!;
    try {
      localStorage.setItem(KEY, current);
    } catch {
      // Without storage the browser forgets the choice; nothing else depends on it.
    }
    button.textContent = TEXT[current];
    applyTheme();
  });
  return button;
}
