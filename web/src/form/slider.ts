// A quantity to drag or to type: a slider and a text field under one label. The step limits dragging, never typing.
import { h } from "../dom.ts";
import { textField } from "./controls.ts";
import type { Field } from "./controls.ts";
import type { FormErrors } from "./errors.ts";
import { parseNumber } from "./number.ts";

export interface SliderOptions {
  label: string;
  unit?: string;
  hint?: string;
  /** Even steps of the logarithm; both ends have one sign. */
  log?: boolean;
  /** What an arrow key is worth, as a share of the value where the slider is logarithmic; without it a thousandth of the range. */
  step?: number;
  /** What its ends mean. */
  ends?: [string, string];
  pointer: () => string | null;
  /** Why a typed value is none; "" where it is one. */
  wrong?(value: number): string;
  /** What is spoken for a value; it must name the quantity. */
  spoken(value: number): string;
  /** While it is dragged. */
  onMove(value: number): void;
  /** A hand comes near it. */
  onTouch?(): void;
  /** Released, or typed and left. */
  onRelease(value: number): void;
  /** Double click and Delete: back to where it came from. */
  onHome?(): void;
}

export interface Slider {
  element: HTMLElement;
  field: Field<HTMLInputElement>;
  value(): number;
  /** Moves it without reporting. A value outside stretches the limits. Null: a choice that is not told stands in the middle. */
  set(value: number | null): void;
  setLimits(lo: number, hi: number): void;
  /** Where it may go next: so many positions to both sides, the nearest first, those ahead before those behind. */
  near(most?: number): Iterable<number>;
  /** Writes again what is spoken: it depends on more than the value. */
  speak(): void;
  /** The value reached, under its field; "" for as much as is asked. `missed`: a limit that does not hold. */
  setReached(text: string, missed: boolean): void;
}

const STEPS = 1000;
/** Of keys that go further: Shift with an arrow, Page up and down. */
const MANY = 10;

export function slider(options: SliderOptions, errors: FormErrors): Slider {
  let [lo, hi] = options.log ? [0.1, 10] : [0, 1];
  let value = lo;
  let reported = NaN;
  let heading = 1;
  const field = textField({ ...options, value: "" }, errors);
  const range = h("input", { type: "range", min: 0, max: STEPS, step: 1, "aria-label": `${options.label}, slider` });
  field.input.after(range);
  if (options.ends) {
    const [low, high] = options.ends;
    range.after(h("span", { class: "ends", "aria-hidden": "true" }, h("span", {}, low), h("span", {}, high)));
  }
  const reached = h("span", { class: "reached", id: `${field.input.id}-reached`, hidden: true });
  field.input.setAttribute("aria-describedby", `${field.input.getAttribute("aria-describedby")} ${reached.id}`);
  field.element.append(reached);
  field.element.classList.add("slider");

  const share = (at: number): number =>
    options.log ? Math.log(at / lo) / Math.log(hi / lo) : (at - lo) / (hi - lo || 1);
  const valueAt = (part: number): number => (options.log ? lo * (hi / lo) ** part : lo + part * (hi - lo));
  const steps = (): number => {
    if (!options.step) return STEPS;
    const count = options.log ? Math.log(hi / lo) / Math.log1p(options.step) : (hi - lo) / options.step;
    return Math.max(1, Math.round(Math.abs(count)));
  };

  /** Rounding leaves no limit behind: beyond one a method may have no answer. */
  const within = (rounded: number): number => Math.min(Math.max(lo, hi), Math.max(Math.min(lo, hi), rounded));

  const fourDigits = (exact: number): number => Number(exact.toPrecision(4));

  /** No more digits than a hand can set: those of the slider's step, at its ends the ends themselves. */
  function reachable(wanted: number): number {
    if (options.log) return within(fourDigits(wanted));
    const near = (end: number): boolean => Math.abs(wanted - end) < (hi - lo) / (2 * steps());
    if (near(lo)) return lo;
    if (near(hi)) return hi;
    const decimals = Math.max(0, Math.min(12, -Math.floor(Math.log10((hi - lo) / steps()) + 1e-9)));
    return Number(wanted.toFixed(decimals));
  }

  function write(texts: boolean): void {
    range.max = String(steps());
    range.value = String(Math.round(steps() * share(value)));
    speak();
    // A limit that was computed has all its digits; nobody types them.
    if (texts) field.input.value = String(options.log ? fourDigits(value) : reachable(value));
  }

  const speak = (): void => range.setAttribute("aria-valuetext", options.spoken(value));

  function take(next: number): void {
    errors.settle(field.control);
    value = next;
    write(true);
  }

  function release(): void {
    reported = value;
    options.onRelease(value);
  }

  /** By a key or a text: moved and let go in one. What stands there already is no move: nothing would let it go. */
  function report(): void {
    if (value === reported) return;
    options.onMove(value);
    release();
  }

  function* near(most = Infinity): Generator<number> {
    const count = steps();
    const at = Number(range.value);
    for (let far = 1; far <= Math.min(count, most); far += 1)
      for (const to of [at + heading * far, at - heading * far])
        if (to >= 0 && to <= count) yield reachable(valueAt(to / count));
  }

  range.addEventListener("input", () => {
    const before = share(value);
    take(reachable(valueAt(Number(range.value) / steps())));
    heading = share(value) < before ? -1 : 1;
    options.onMove(value);
  });
  if (options.onTouch) for (const event of ["pointerenter", "focus"]) range.addEventListener(event, () => options.onTouch!());
  // A drag that ends where it began is over too.
  range.addEventListener("change", release);
  range.addEventListener("keydown", (event) => {
    if (event.key === "Delete" && options.onHome) {
      event.preventDefault();
      return options.onHome();
    }
    const arrow = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    const page = { PageUp: 1, PageDown: -1 }[event.key];
    const direction = page ?? (event.shiftKey ? arrow : undefined);
    if (!direction) return;
    event.preventDefault();
    const far = options.step ? MANY / steps() : 0.1;
    take(reachable(valueAt(Math.min(1, Math.max(0, share(value) + direction * far)))));
    report();
  });
  if (options.onHome) range.addEventListener("dblclick", () => options.onHome!());
  field.input.addEventListener("change", () => {
    const parsed = parseNumber(field.input.value, options.label);
    const bad = !parsed.ok ? parsed.sentence : wrongSign(parsed.value) || (options.wrong?.(parsed.value) ?? "");
    if (bad || !parsed.ok) return errors.refuse(field.control, bad);
    stretch(parsed.value);
    value = parsed.value;
    write(false);
    report();
  });
  write(false);

  function wrongSign(typed: number): string {
    if (!options.log || typed / lo > 0) return "";
    return `${options.label} is ${field.input.value}; it must be ${lo > 0 ? "above" : "below"} 0.`;
  }

  function stretch(to: number): void {
    if (share(to) < 0) lo = to;
    if (share(to) > 1) hi = to;
  }

  return {
    element: field.element,
    field,
    value: () => value,
    near,
    speak,
    setReached(text, missed) {
      reached.textContent = text;
      reached.className = missed ? "reached missed" : "reached";
      reached.hidden = text === "";
    },
    set(next) {
      if (next === null) {
        take(valueAt(0.5));
        reported = NaN;
        field.input.value = "";
        field.input.placeholder = "own";
        return;
      }
      stretch(next);
      reported = next;
      take(next);
    },
    setLimits(from, to) {
      if (!(options.log ? from / to > 0 && from !== to : to > from)) return;
      // Nothing was set yet: it stands at its least.
      if (Number.isNaN(reported)) value = from;
      [lo, hi] = [from, to];
      stretch(value);
      write(false);
    },
  };
}
