// The keys of the page, by the part of a screen that has them.
import { PLOT_KEYS } from "../plot/keys.ts";
import type { KeyMeaning } from "../plot/keys.ts";

export interface KeyGroup {
  title: string;
  /** A part of the page that has these keys, as a selector; "": every screen. */
  on: string;
  keys: readonly KeyMeaning[];
}

export const KEY_GROUPS: readonly KeyGroup[] = [
  {
    title: "Everywhere",
    on: "",
    keys: [
      { keys: "?", meaning: "this list (outside text fields)" },
      { keys: "Ctrl+K or ⌘K", meaning: "finds a screen, method, controller, job, document or action" },
      { keys: "Escape", meaning: "closes a dialog or a menu" },
      { keys: "Tab, Shift+Tab", meaning: "next and previous control" },
    ],
  },
  {
    title: "Design",
    on: "#main .controls .steps",
    keys: [
      { keys: "Ctrl+Z or ⌘Z", meaning: "undoes the last change of a slider (outside text fields)" },
      { keys: "Shift+Ctrl+Z or ⇧⌘Z", meaning: "redoes it" },
    ],
  },
  {
    title: "Sliders",
    on: "#main input[type=range]",
    keys: [
      { keys: "Arrow keys", meaning: "one step; several steps within a second are one undo step" },
      { keys: "Shift+Arrow, Page Up, Page Down", meaning: "ten steps" },
      { keys: "Home, End", meaning: "the ends" },
      { keys: "Delete", meaning: "back to the proposed value" },
      { keys: "Enter", meaning: "takes the number typed in the field beside the slider" },
    ],
  },
  { title: "Plots", on: "#main .plot .canvas", keys: PLOT_KEYS },
  {
    title: "Rows of a schedule, over the plot",
    on: "#main [role=slider]",
    keys: [
      { keys: "Arrow keys", meaning: "move the row, with Shift in bigger steps" },
      { keys: "Page Up, Page Down", meaning: "bigger steps" },
      { keys: "Home, End", meaning: "as far as its neighbours allow" },
    ],
  },
  {
    title: "Lists that are searched",
    on: "#main [role=combobox]",
    keys: [
      { keys: "Arrow keys", meaning: "open the list and move in it" },
      { keys: "Enter", meaning: "takes the marked entry" },
      { keys: "Escape", meaning: "closes the list" },
    ],
  },
  {
    title: "Tabs",
    on: "#main [role=tablist]",
    keys: [
      { keys: "Arrow keys", meaning: "next and previous tab" },
      { keys: "Home, End", meaning: "first and last tab" },
    ],
  },
  {
    title: "Tables",
    on: "#main .comparison-scroll, #main .scroll, #main .data-table",
    keys: [
      { keys: "Arrow keys", meaning: "scroll, while the table has the focus" },
      { keys: "Enter on a heading", meaning: "sorts by it; again: the other way (Compare, Jobs)" },
    ],
  },
];
