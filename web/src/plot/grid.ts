// Several plots side by side, each with a key: created when first shown, updated afterwards.
import { h } from "../dom.ts";
import type { Frame } from "./frame.ts";
import { createPlot } from "./plot.ts";
import type { Announce, Plot } from "./plot.ts";

export interface PlotGrid {
  element: HTMLElement;
  /** Whose plots these are, in exports; "": not known. For the frames that are shown from now on. */
  setSubject(subject: string): void;
  /** Null removes the plot. */
  show(key: string, frame: Frame | null): void;
  /** While a control that changes the frames is held, their axes only grow. */
  hold(held: boolean): void;
  /** The frames are outdated: newer ones are on their way. */
  setBusy(busy: boolean): void;
  dispose(): void;
}

export function plotGrid(announce: Announce): PlotGrid {
  const plots = new Map<string, Plot>();
  let subject = "";
  const element = h("div", { class: "plots" });
  const remove = (key: string): void => {
    const plot = plots.get(key);
    plot?.element.remove();
    plot?.dispose();
    plots.delete(key);
    element.hidden = plots.size === 0;
  };
  return {
    element,
    setSubject(name) {
      subject = name;
    },
    show(key, given) {
      const plot = plots.get(key);
      if (!given) return remove(key);
      const frame = subject ? { ...given, subject } : given;
      if (plot) return plot.update(frame);
      const made = createPlot(frame, announce);
      plots.set(key, made);
      element.append(made.element);
      element.hidden = false;
    },
    hold(held) {
      for (const plot of plots.values()) plot.hold(held);
    },
    setBusy(busy) {
      element.setAttribute("aria-busy", String(busy));
    },
    dispose() {
      for (const key of [...plots.keys()]) remove(key);
    },
  };
}
