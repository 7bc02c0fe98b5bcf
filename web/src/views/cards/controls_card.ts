// What can be turned on Design: the method's options, the settings by hand, and the way back and forth.
import { effect } from "@preact/signals-core";
import type { Entry, Method } from "../../api/types.ts";
import { h, passFocus, uniqueId } from "../../dom.ts";
import { FormErrors } from "../../form/errors.ts";
import { slider } from "../../form/slider.ts";
import type { Slider } from "../../form/slider.ts";
import { HAND, handKnobs, handValue, optionKnobs, withHand, withOption, wrongValue } from "../../live/knobs.ts";
import type { HandName, Knob } from "../../live/knobs.ts";
import type { Live } from "../../live/live.ts";
import { tiedAt } from "../../live/point.ts";
import type { Point } from "../../live/point.ts";
import { missesOvershoot } from "../../words/figures.ts";
import { formatNumber } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";

export interface ControlsCard {
  element: HTMLElement;
  /** Sliders for an entry of a job, at its own values; answers them. */
  show(point: Point, entry: Entry, method: Method | undefined, units: UnitNames): Knob[];
  /** No limit on Ms below this is met. */
  setLowest(Ms: number | null): void;
  /** Moves the limit on Ms, as its slider would. */
  turnMs(Ms: number, released: boolean): void;
  /** What the newest answer came to: sliders of settings that were not moved by hand follow it. */
  follow(entry: Entry): void;
  dispose(): void;
}

const RELATIVE_STEP = 0.01;

/** Positions to both sides that are worth knowing before a slider moves. */
const AT_TOUCH = 12;

type Turn = (knob: Knob, value: number) => Point;

interface Turned {
  knob: Knob;
  slider: Slider;
}

export function controlsCard(live: Live): ControlsCard {
  const errors = new FormErrors();
  let options: Turned[] = [];
  let hands: Turned[] = [];
  let shown: { point: Point; entry: Entry; method: Method | undefined; units: UnitNames } | null = null;
  let tied = true;
  let lowest: number | null = null;
  let followed: Entry | null = null;
  const title = h("h2", { id: uniqueId("controls"), class: "visually-hidden" }, "Sliders");
  const undo = h("button", { type: "button", class: "quiet", title: "Undo (Ctrl+Z)", onclick: () => live.undo() }, "Undo");
  const redo = h("button", { type: "button", class: "quiet", title: "Redo (Shift+Ctrl+Z)", onclick: () => live.redo() }, "Redo");
  const back = h(
    "button",
    { type: "button", class: "quiet", onclick: () => live.reset() },
    "Back to the proposal",
  );
  const tie = h("input", { type: "checkbox", checked: true });
  const tieText = h("span", {});
  const tieLabel = h("label", { class: "tie" }, tie, tieText);
  const optionRows = h("div", { class: "knobs" });
  const handTitle = h("h3", {}, "By hand");
  const handRows = h("div", { class: "knobs tight" });
  const element = h(
    "section",
    { class: "card controls", "aria-labelledby": title.id },
    title,
    h("div", { class: "steps" }, undo, redo, back),
    optionRows,
    handTitle,
    handRows,
  );

  const now = (): Point => live.point.peek() ?? shown!.point;
  const controllerNow = () => followed?.controller ?? shown!.entry.controller!;

  function turnOption(knob: Knob, value: number): Point {
    const point = now();
    return { tune: withOption(point.tune!, knob.id, value, tied ? knob.along : []), hand: null };
  }

  function turnHand(knob: Knob, value: number): Point {
    const point = now();
    return { tune: point.tune, hand: withHand(point.hand ?? controllerNow(), knob.id as HandName, value) };
  }

  function* points(values: Iterable<number>, knob: Knob, turn: Turn): Generator<Point> {
    for (const value of values) yield turn(knob, value);
  }

  function move(made: Slider, knob: Knob, value: number, turn: Turn): void {
    live.move(turn(knob, value));
    live.expect(points(made.near(), knob, turn));
  }

  function make(knob: Knob, turn: Turn, home: (knob: Knob) => void): Turned {
    const made = slider(
      {
        label: knob.label,
        unit: knob.unit,
        log: knob.log,
        ...(knob.step || knob.log ? { step: knob.step ?? RELATIVE_STEP } : {}),
        ...(knob.ends ? { ends: knob.ends } : {}),
        pointer: () => null,
        wrong: (value) => wrongValue(knob, value),
        spoken: (value) => spoken(knob, value),
        onMove: (value) => move(made, knob, value, turn),
        onTouch: () => live.held.peek() || live.expect(points(made.near(AT_TOUCH), knob, turn)),
        onRelease: (value) => live.settle(turn(knob, value)),
        onHome: () => home(knob),
      },
      errors,
    );
    made.setLimits(knob.lo, knob.hi);
    made.set(knob.value);
    return { knob, slider: made };
  }

  /** "Ms 1.60, load IAE 8.4". */
  function spoken(knob: Knob, value: number): string {
    const IAE = (followed ?? shown?.entry)?.performance?.load?.["IAE"];
    const name = knob.label.replace(/^(Robustness|Noise filter|Noise limit|Set-point) /, "");
    const unit = knob.unit ? ` ${knob.unit}` : "";
    const load = typeof IAE === "number" ? `, load IAE ${formatNumber(IAE)}` : "";
    const reached = reachedText(knob, value);
    return `${name} ${formatNumber(value)}${unit}${reached ? `, ${reached}` : ""}${load}`;
  }

  /** "reached 12.5 %" where the design on the screen has another value than is asked for; else "". */
  function reachedText({ reached, unit }: Knob, asked: number | null): string {
    const entry = followed ?? shown?.entry;
    if (!reached || !entry) return "";
    const text = formatNumber(reached(entry));
    return asked !== null && text === formatNumber(asked) ? "" : `reached ${text}${unit ? ` ${unit}` : ""}`;
  }

  /** The value asked of every option, and beside it that of the design on the screen. */
  function sayReached(): void {
    const entry = followed ?? shown?.entry;
    for (const { knob, slider: made } of options) {
      const missed = knob.figure === "overshoot_percent" && entry !== undefined && missesOvershoot(entry);
      made.setReached(reachedText(knob, askedOf(knob, now())), missed);
      made.speak();
    }
  }

  /** Null: nobody asked, and the method does not tell its choice. */
  function askedOf(knob: Knob, { tune }: Point): number | null {
    const value = knob.id.split(".").reduce<unknown>((at, part) => (at as Record<string, unknown> | undefined)?.[part], tune ?? {});
    return typeof value === "number" ? value : knob.value;
  }

  function homeOption(knob: Knob): void {
    if (knob.value !== null) live.settle(turnOption(knob, knob.value));
  }

  function homeHand(knob: Knob): void {
    if (knob.value !== null) live.settle(turnHand(knob, knob.value));
  }

  function makeOptions(): void {
    if (!shown) return;
    const { entry, method, units } = shown;
    const tune = now().tune;
    options = tune ? optionKnobs(tune, entry, method, units, tied).map((knob) => make(knob, turnOption, homeOption)) : [];
    optionRows.replaceChildren(...options.map((item) => item.slider.element));
    const leader = leading();
    if (leader) tieText.textContent = `${leader.knob.along!.join(", ")} = ${leader.knob.id}`;
    leader?.slider.element.append(tieLabel);
    limitMs();
    sayReached();
  }

  function limitMs(): void {
    for (const { knob, slider: made } of options) {
      if (knob.id !== "Ms") continue;
      made.setLimits(Math.max(knob.lo, lowest === null ? 0 : Math.ceil(lowest * 100) / 100), knob.hi);
    }
  }

  /** The slider with which others move. */
  const leading = (): Turned | undefined => options.find(({ knob }) => knob.along?.length);

  tie.addEventListener("change", () => {
    tied = tie.checked;
    const point = now();
    const leader = leading();
    const value = leader && askedOf(leader.knob, point);
    if (tied && leader && point.tune && typeof value === "number") live.settle({ tune: turnOption(leader.knob, value).tune, hand: null });
    makeOptions();
    place(now());
  });

  /** Sliders where the point is; the one that is being moved stands there already. */
  function place(point: Point): void {
    for (const { knob, slider: made } of options) {
      const at = askedOf(knob, point);
      if (at !== made.value()) made.set(at);
    }
    sayReached();
  }

  const firstSlider = (): HTMLElement | null => element.querySelector<HTMLElement>("input[type=range]");

  /** A step that leads nowhere any more hands its focus to one that does. */
  function allow(steps: [HTMLButtonElement, boolean][]): void {
    for (const [button, useful] of steps) if (useful) button.disabled = false;
    const others = steps.flatMap(([button, useful]) => (useful ? [button] : []));
    for (const [button, useful] of steps) {
      if (!useful) passFocus(button, ...others, firstSlider());
      button.disabled = !useful;
    }
  }

  const leave = effect(() => {
    const point = live.point.value;
    const moved = point !== null && shown !== null && JSON.stringify(point) !== JSON.stringify(shown.point);
    allow([
      [undo, live.canUndo.value],
      [redo, live.canRedo.value],
      [back, moved],
    ]);
    if (!point || !shown) return;
    if (tied && !live.held.value && !tiedAt(point, shown.method)) {
      tied = tie.checked = false;
      makeOptions();
    }
    place(point);
  });

  return {
    element,
    show(point, entry, method, units) {
      shown = { point, entry, method, units };
      followed = null;
      const focused = element.contains(document.activeElement);
      tied = tie.checked = tiedAt(point, method);
      makeOptions();
      const hand = entry.controller && entry.method !== "emulation" ? handKnobs(entry.controller, units) : [];
      hands = hand.map((knob) => make(knob, turnHand, homeHand));
      handRows.replaceChildren(...hands.map((item) => item.slider.element));
      handTitle.hidden = hands.length === 0;
      element.hidden = options.length === 0 && hands.length === 0;
      if (focused && !element.contains(document.activeElement)) firstSlider()?.focus();
      return [...options.map((item) => item.knob)];
    },
    setLowest(Ms) {
      lowest = Ms;
      limitMs();
    },
    turnMs(Ms, released) {
      const item = options.find(({ knob }) => knob.id === "Ms");
      if (!item) return;
      const value = Math.round(100 * Math.min(item.knob.hi, Math.max(item.knob.lo, lowest ?? 0, Ms))) / 100;
      if (released) return live.settle(turnOption(item.knob, value));
      item.slider.set(value);
      move(item.slider, item.knob, value, turnOption);
    },
    follow(entry) {
      followed = entry;
      const moved = document.activeElement;
      for (const { knob, slider: made } of hands) {
        if (made.element.contains(moved) && live.held.peek()) continue;
        const value = entry.controller ? handValue(entry.controller, knob.id as HandName) : null;
        if (value !== null && HAND.includes(knob.id as HandName)) made.set(value);
      }
      sayReached();
    },
    dispose: leave,
  };
}
