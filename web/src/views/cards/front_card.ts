// The frontier below the sliders: the design is a point on it that can be dragged.
import { referenceOf, frontOf } from "../../api/live.ts";
import type { FrontTerms } from "../../api/live.ts";
import type { Entry, Frontier, Plant } from "../../api/types.ts";
import { frontFrame } from "../../charts/front.ts";
import { h } from "../../dom.ts";
import { createPlot } from "../../plot/plot.ts";
import type { Plot } from "../../plot/plot.ts";
import type { UnitNames } from "../../words/numbers.ts";

/** The data on which the curves depend; a change makes new ones. */
export interface FrontSubject {
  plant: Plant;
  /** The kind of the design, whose frontier is known to exist; null if it is not a robust optimum, or one under
      other limits. */
  kind: "PI" | "PID" | null;
  terms: Omit<FrontTerms, "controller">;
  load: number;
  units: UnitNames;
  /** Entries of the job, if there are several; otherwise every rule is computed. */
  entries: Entry[];
}

export interface FrontCard {
  element: HTMLElement;
  show(subject: FrontSubject): void;
  /** The place of the design; `at`: the limit on Ms for which it was made. */
  place(entry: Entry, at: number | null, today: Entry | null): void;
  hold(held: boolean): void;
  /** The lowest Ms that the plant allows, if it is known. */
  lowest(): number | null;
  dispose(): void;
}

/** From this number of entries on, a job's own rules are used for the comparison. */
const ENOUGH_ENTRIES = 6;

export function frontCard(
  announce: (sentence: string) => void,
  onDrag: (Ms: number, released: boolean) => void,
  onKnown: () => void,
): FrontCard {
  // Every rule is a search or a formula: together about as much work as the rest of this screen.
  const rulesButton = h("button", { type: "button", class: "quiet", onclick: () => void askRules() }, "Rules for comparison");
  const element = h("div", { class: "front" });
  let plot: Plot | null = null;
  let subject: FrontSubject | null = null;
  let key = "";
  let ruled = "";
  let fronts: { PID: Frontier | null; PI: Frontier | null } = { PID: null, PI: null };
  let rules: Entry[] = [];
  let here: { entry: Entry; at: number | null; today: Entry | null } | null = null;
  let calls = new AbortController();

  function draw(): void {
    if (!subject || !here) return;
    const { entry, at, today } = here;
    const drawn = frontFrame({ ...fronts, here: { entry, at }, today, rules, load: subject.load }, subject.units);
    const frame = { ...drawn, drag: ({ x }: { x: number }, released: boolean): void => onDrag(x, released) };
    if (plot) return plot.update(frame);
    plot = createPlot(frame, announce);
    element.append(plot.element);
    plot.element.append(rulesButton);
  }

  /** Curves and rules are added after the screen is shown; without them the point stands alone. */
  async function ask(next: FrontSubject, ending: AbortSignal): Promise<void> {
    const take = (controller: "PI" | "PID", front: Frontier | null): void => {
      if (ending.aborted) return;
      fronts = { ...fronts, [controller]: front };
      draw();
      onKnown();
    };
    const { kind, plant, terms } = next;
    if (kind) take(kind, await frontOf(plant, { controller: kind, ...terms }, ending));
    if (ending.aborted) return;
    const others = (["PID", "PI"] as const).filter((controller) => controller !== kind);
    const reference = await referenceOf(
      plant,
      others.map((controller) => ({ controller, ...terms })),
      false,
    );
    others.forEach((controller, index) => take(controller, reference.fronts[index] ?? null));
  }

  async function askRules(): Promise<void> {
    const about = ruled;
    if (!subject) return;
    rulesButton.disabled = true;
    try {
      const reference = await referenceOf(subject.plant, [], true);
      if (about !== ruled) return;
      rules = reference.rules;
      rulesButton.hidden = true;
      draw();
    } finally {
      rulesButton.disabled = false;
    }
  }

  return {
    element,
    show(next) {
      const now = JSON.stringify([next.plant, next.terms, next.kind]);
      const about = JSON.stringify(next.plant);
      subject = next;
      if (now === key) return;
      key = now;
      calls.abort();
      calls = new AbortController();
      const own = next.entries.length >= ENOUGH_ENTRIES;
      if (about !== ruled) {
        fronts = { PID: null, PI: null };
        rules = own ? next.entries : [];
        rulesButton.hidden = own;
      }
      ruled = about;
      // On a failure the point stands alone: the reason for a missing frontier is not important while there is a
      // design.
      ask(next, calls.signal).catch(() => undefined);
    },
    place(entry, at, today) {
      here = { entry, at, today };
      draw();
    },
    hold: (held) => plot?.hold(held),
    lowest: () => (subject?.kind ? (fronts[subject.kind]?.infeasible_below ?? null) : null),
    dispose() {
      calls.abort();
      plot?.dispose();
    },
  };
}
