// The controls on Design: the method's options, the settings by hand, and undo and redo.
import { effect } from "@preact/signals-core";
import type { Entry, Method } from "../../api/types.ts";
import { h, passFocus, say, uniqueId } from "../../dom.ts";
import { FormErrors } from "../../form/errors.ts";
import { slider } from "../../form/slider.ts";
import type { Slider } from "../../form/slider.ts";
import { MANUAL, manualSliders, manualValue, optionSliders, withManual, withOption, wrongValue } from "../../live/sliders.ts";
import type { ManualName, SliderSpec } from "../../live/sliders.ts";
import type { Live } from "../../live/live.ts";
import { tiedAt } from "../../live/point.ts";
import type { Point } from "../../live/point.ts";
import type { MovableSlider } from "../grips.ts";
import { explained } from "../../reach/explanation.ts";
import { explanationOf } from "../../words/explanation_of.ts";
import { missesOvershoot } from "../../words/figures.ts";
import { formatNumber } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";

export interface ControlsCard {
  element: HTMLElement;
  /** Creates sliders for an entry of a job, at its own values; returns them. */
  show(point: Point, entry: Entry, method: Method | undefined, units: UnitNames): SliderSpec[];
  /** No design meets a limit on Ms below this. */
  setLowest(Ms: number | null): void;
  /** The sliders of the method. */
  movable(): MovableSlider[];
  /** Moves the slider of an option of the method; `released`: as one step. */
  turn(id: string, value: number, released: boolean): void;
  /** The result of the newest answer: sliders of settings that were not moved by hand follow it. */
  follow(entry: Entry): void;
  dispose(): void;
}

const RELATIVE_STEP = 0.01;

/** Positions on both sides that are requested before a slider moves. */
const AT_TOUCH = 12;

type Modify = (spec: SliderSpec, value: number) => Point;

interface SliderControl {
  spec: SliderSpec;
  slider: Slider;
}

export function controlsCard(live: Live): ControlsCard {
  const errors = new FormErrors();
  let options: SliderControl[] = [];
  let manuals: SliderControl[] = [];
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
  const computing = h("span", { class: "computing", role: "status" });
  const tie = h("input", { type: "checkbox", checked: true });
  const tieText = h("span", {});
  const tieLabel = h("label", { class: "tie" }, tie, tieText);
  const optionRows = h("div", { class: "sliders" });
  const manualTitle = h("h3", {}, "By hand");
  const manualRows = h("div", { class: "sliders tight" });
  const element = h(
    "section",
    { class: "card controls", "aria-labelledby": title.id },
    title,
    h("div", { class: "steps" }, undo, redo, back, computing),
    optionRows,
    manualTitle,
    manualRows,
  );

  const now = (): Point => live.point.peek() ?? shown!.point;
  const controllerNow = () => followed?.controller ?? shown!.entry.controller!;

  function modifyOption(spec: SliderSpec, value: number): Point {
    const point = now();
    return { tune: withOption(point.tune!, spec.id, value, tied ? spec.along : []), manual: null };
  }

  function modifyManual(spec: SliderSpec, value: number): Point {
    const point = now();
    return { tune: point.tune, manual: withManual(point.manual ?? controllerNow(), spec.id as ManualName, value) };
  }

  function* points(values: Iterable<number>, spec: SliderSpec, modify: Modify): Generator<Point> {
    for (const value of values) yield modify(spec, value);
  }

  function move(made: Slider, spec: SliderSpec, value: number, modify: Modify): void {
    live.move(modify(spec, value));
    live.expect(points(made.near(), spec, modify));
  }

  function make(spec: SliderSpec, modify: Modify, home: (spec: SliderSpec) => void): SliderControl {
    const about = explanationOf(spec.id);
    const made = slider(
      {
        label: spec.label,
        ...(about ? { explain: (text: HTMLElement) => explained(about, text) } : {}),
        unit: spec.unit,
        log: spec.log,
        ...(spec.step || spec.log ? { step: spec.step ?? RELATIVE_STEP } : {}),
        ...(spec.ends ? { ends: spec.ends } : {}),
        ...(spec.limit ? { unset: "none" } : {}),
        pointer: () => null,
        wrong: (value) => wrongValue(spec, value),
        spoken: (value) => spoken(spec, value),
        onMove: (value) => move(made, spec, value, modify),
        onTouch: () => live.held.peek() || live.expect(points(made.near(AT_TOUCH), spec, modify)),
        onRelease: (value, byKey) => live.settle(modify(spec, value), byKey ? spec.id : ""),
        onHome: () => home(spec),
      },
      errors,
    );
    made.setLimits(spec.lo, spec.hi);
    made.set(spec.value);
    return { spec, slider: made };
  }

  /** The spoken text, "Ms 1.60, load IAE 8.4". */
  function spoken(spec: SliderSpec, value: number): string {
    const IAE = (followed ?? shown?.entry)?.performance?.load?.["IAE"];
    const name = spec.label.replace(/^(Robustness|Noise filter|Noise limit|Set-point) /, "");
    const unit = spec.unit ? ` ${spec.unit}` : "";
    const load = typeof IAE === "number" ? `, load IAE ${formatNumber(IAE)}` : "";
    const reached = reachedText(spec, value);
    return `${name} ${formatNumber(value)}${unit}${reached ? `, ${reached}` : ""}${load}`;
  }

  /** "reached 12.5 %" if the displayed design has another value than requested; else "". */
  function reachedText({ reached, unit }: SliderSpec, asked: number | null): string {
    const entry = followed ?? shown?.entry;
    if (!reached || !entry) return "";
    const text = formatNumber(reached(entry));
    return asked !== null && text === formatNumber(asked) ? "" : `reached ${text}${unit ? ` ${unit}` : ""}`;
  }

  /** Shows the requested value of every option, with that of the displayed design. */
  function sayReached(): void {
    const entry = followed ?? shown?.entry;
    for (const { spec, slider: made } of options) {
      const missed = spec.figure === "overshoot_percent" && entry !== undefined && missesOvershoot(entry);
      made.setReached(reachedText(spec, askedOf(spec, now())), missed);
      made.speak();
    }
  }

  /** Null: none was requested, and the method does not state its choice. */
  function askedOf(spec: SliderSpec, { tune }: Point): number | null {
    const value = spec.id.split(".").reduce<unknown>((at, part) => (at as Record<string, unknown> | undefined)?.[part], tune ?? {});
    return typeof value === "number" ? value : spec.value;
  }

  function homeOption(spec: SliderSpec): void {
    if (spec.value !== null) live.settle(modifyOption(spec, spec.value));
  }

  function homeManual(spec: SliderSpec): void {
    if (spec.value !== null) live.settle(modifyManual(spec, spec.value));
  }

  function makeOptions(): void {
    if (!shown) return;
    const { entry, method, units } = shown;
    const tune = now().tune;
    options = tune ? optionSliders(tune, entry, method, units, tied).map((spec) => make(spec, modifyOption, homeOption)) : [];
    optionRows.replaceChildren(...options.map((item) => item.slider.element));
    const leader = leading();
    if (leader) tieText.textContent = `${leader.spec.along!.join(", ")} = ${leader.spec.id}`;
    leader?.slider.element.append(tieLabel);
    limitMs();
    sayReached();
  }

  function limitMs(): void {
    for (const { spec, slider: made } of options) {
      if (spec.id !== "Ms") continue;
      made.setLimits(Math.max(spec.lo, lowest === null ? 0 : Math.ceil(lowest * 100) / 100), spec.hi);
    }
  }

  /** The slider with which other sliders move. */
  const leading = (): SliderControl | undefined => options.find(({ spec }) => spec.along?.length);

  tie.addEventListener("change", () => {
    tied = tie.checked;
    const point = now();
    const leader = leading();
    const value = leader && askedOf(leader.spec, point);
    if (tied && leader && point.tune && typeof value === "number") live.settle({ tune: modifyOption(leader.spec, value).tune, manual: null });
    makeOptions();
    place(now());
  });

  /** Sets the sliders to the point; the one that is being moved is there already. */
  function place(point: Point): void {
    for (const { spec, slider: made } of options) {
      const at = askedOf(spec, point);
      if (at !== made.value()) made.set(at);
    }
    sayReached();
  }

  const firstSlider = (): HTMLElement | null => element.querySelector<HTMLElement>("input[type=range]");

  /** A button that becomes disabled passes its focus to one that is enabled. */
  function allow(steps: [HTMLButtonElement, boolean][]): void {
    for (const [button, useful] of steps) if (useful) button.disabled = false;
    const others = steps.flatMap(([button, useful]) => (useful ? [button] : []));
    for (const [button, useful] of steps) {
      if (!useful) passFocus(button, ...others, firstSlider());
      button.disabled = !useful;
    }
  }

  const leaveLate = effect(() => say(computing, live.late.value ? "Computing..." : ""));
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
      const manual = entry.controller && entry.method !== "emulation" ? manualSliders(entry.controller, units) : [];
      manuals = manual.map((spec) => make(spec, modifyManual, homeManual));
      manualRows.replaceChildren(...manuals.map((item) => item.slider.element));
      manualTitle.hidden = manuals.length === 0;
      element.hidden = options.length === 0 && manuals.length === 0;
      if (focused && !element.contains(document.activeElement)) firstSlider()?.focus();
      return [...options.map((item) => item.spec)];
    },
    setLowest(Ms) {
      lowest = Ms;
      limitMs();
    },
    movable: () =>
      options.map(({ spec: { id, label, lo, hi }, slider: made }) => ({
        id,
        label,
        lo: id === "Ms" ? Math.max(lo, lowest ?? lo) : lo,
        hi,
        value: made.value(),
      })),
    turn(id, to, released) {
      const item = options.find(({ spec }) => spec.id === id);
      if (!item) return;
      const { lo, hi, step, log } = item.spec;
      const inside = Math.min(hi, Math.max(lo, id === "Ms" ? (lowest ?? lo) : lo, to));
      const value = step && !log ? Number((Math.round(inside / step) * step).toFixed(6)) : Number(inside.toPrecision(4));
      if (released) return live.settle(modifyOption(item.spec, value));
      item.slider.set(value);
      move(item.slider, item.spec, value, modifyOption);
    },
    follow(entry) {
      followed = entry;
      const moved = document.activeElement;
      for (const { spec, slider: made } of manuals) {
        if (made.element.contains(moved) && live.held.peek()) continue;
        const value = entry.controller ? manualValue(entry.controller, spec.id as ManualName) : null;
        if (value !== null && MANUAL.includes(spec.id as ManualName)) made.set(value);
      }
      sayReached();
    },
    dispose() {
      leave();
      leaveLate();
    },
  };
}
