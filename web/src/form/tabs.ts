// Tabs over one panel: one tab stop, arrows move between the tabs.
import { h, uniqueId } from "../dom.ts";

export interface Tabs {
  element: HTMLElement;
  selected(): string;
  select(id: string): void;
}

export function tabs(
  list: readonly { id: string; label: string }[],
  options: { label: string; panel: HTMLElement[]; onSelect(id: string): void },
): Tabs {
  let selected = list[0]!.id;
  const panel = h("div", { role: "tabpanel", id: uniqueId("panel") }, options.panel);
  const buttons = list.map(({ id, label }) =>
    h(
      "button",
      { type: "button", role: "tab", id: uniqueId("tab"), "aria-controls": panel.id, onclick: () => select(id) },
      label,
    ),
  );
  const bar = h("div", { class: "tabs", role: "tablist", "aria-label": options.label }, buttons);
  bar.addEventListener("keydown", (event) => {
    const at = list.findIndex((item) => item.id === selected);
    const to = {
      ArrowRight: (at + 1) % list.length,
      ArrowLeft: (at + list.length - 1) % list.length,
      Home: 0,
      End: list.length - 1,
    }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    select(list[to]!.id);
    buttons[to]!.focus();
  });

  function mark(): void {
    buttons.forEach((button, index) => {
      const on = list[index]!.id === selected;
      button.setAttribute("aria-selected", String(on));
      button.tabIndex = on ? 0 : -1;
      if (on) panel.setAttribute("aria-labelledby", button.id);
    });
  }

  function select(id: string): void {
    if (id === selected) return;
    selected = id;
    mark();
    options.onSelect(id);
  }

  mark();
  return { element: h("div", { class: "tabbed" }, bar, panel), selected: () => selected, select };
}
