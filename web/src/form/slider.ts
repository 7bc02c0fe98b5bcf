// A quantity to drag or to type: a slider and a text field under one label. The step applies to dragging, never to
// typing.
import { h } from "../dom.ts";
import { textField } from "./controls.ts";
import type { Field } from "./controls.ts";
import type { FormErrors } from "./errors.ts";
import { parseNumber } from "./number.ts";

export interface SliderOptions {
  label: string;
  unit?: string;
  hint?: string;
  /** As of a field: wraps the text of the label in a button that explains it. */
  explain?(text: HTMLElement): HTMLElement;
  /** Even steps of the logarithm; both ends have the same sign. */
  log?: boolean;
  /** The step of an arrow key, relative to the value if the slider is logarithmic; by default a thousandth of the
      range. */
  step?: number;
  /** The meaning of its ends. */
  ends?: [string, string];
  /** The text in place of an unknown value. */
  unset?: string;
  pointer: () => string | null;
  /** The reason why a typed value is not valid; "" if it is. */
  wrong?(value: number): string;
  /** The spoken text for a value; it must name the quantity. */
  spoken(value: number): string;
  /** While it is dragged. */
  onMove(value: number): void;
  /** The pointer or the focus approaches it. */
  onTouch?(): void;
  /** Released, or typed and left. `byKey`: by a key of the slider, which may follow others of one gesture. */
  onRelease(value: number, byKey: boolean): void;
  /** Double click and Delete: returns to the initial value. */
  onHome?(): void;
}

export interface Slider {
  element: HTMLElement;
  field: Field<HTMLInputElement>;
  value(): number;
  /** Moves it without reporting. A value outside extends the limits. Null: an unknown value is shown in the middle. */
  set(value: number | null): void;
  setLimits(lo: number, hi: number): void;
  /** The values it may take next: this number of positions on both sides, the nearest first, those ahead before
      those behind. */
  near(most?: number): Iterable<number>;
  /** Updates the spoken text: it depends on more than the value. */
  speak(): void;
  /** The value reached, under its field; "" if it is the requested one. `missed`: a limit that does not hold. */
  setReached(text: string, missed: boolean): void;
}

const STEPS = 1000;
/** Factor for keys with larger steps: Shift with an arrow, Page up and down. */
const MANY = 10;

export function slider(options: SliderOptions, errors: FormErrors): Slider {
  let [lo, hi] = options.log ? [0.1, 10] : [0, 1];
  let value = lo;
  let reported = NaN;
  let heading = 1;
  let byKey = false;
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
  // A long unit is cut in a narrow card.
  if (options.unit) field.element.title = `${options.label} (${options.unit})`;

  const share = (at: number): number =>
    options.log ? Math.log(at / lo) / Math.log(hi / lo) : (at - lo) / (hi - lo || 1);
  const valueAt = (part: number): number => (options.log ? lo * (hi / lo) ** part : lo + part * (hi - lo));
  const steps = (): number => {
    if (!options.step) return STEPS;
    const count = options.log ? Math.log(hi / lo) / Math.log1p(options.step) : (hi - lo) / options.step;
    return Math.max(1, Math.round(Math.abs(count)));
  };

  /** Rounding must not exceed a limit: beyond one a method may have no answer. */
  const within = (rounded: number): number => Math.min(Math.max(lo, hi), Math.max(Math.min(lo, hi), rounded));

  const fourDigits = (exact: number): number => Number(exact.toPrecision(4));

  /** Only the digits of the slider's step; at its ends the ends themselves. */
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
    // A computed limit has all its digits; they are not shown for typing.
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
    options.onRelease(value, byKey);
  }

  /** After a key or a typed text, which move and release the slider at once. An unchanged value is not reported: no
      release would follow it. */
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
  // A drag that ends where it began also ends the hold.
  range.addEventListener("change", release);
  range.addEventListener("pointerdown", () => (byKey = false));
  range.addEventListener("keydown", (event) => {
    byKey = true;
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
    byKey = false;
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
        field.input.placeholder = options.unset ?? "own";
        return;
      }
      stretch(next);
      reported = next;
      take(next);
    },
    setLimits(from, to) {
      if (!(options.log ? from / to > 0 && from !== to : to > from)) return;
      // Nothing was set yet: it is at its minimum.
      if (Number.isNaN(reported)) value = from;
      [lo, hi] = [from, to];
      stretch(value);
      write(false);
    },
  };
}
