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
  /** Even steps of the logarithm. */
  log?: boolean;
  pointer: () => string | null;
  /** What is spoken for a value; it must name the quantity. */
  spoken(value: number): string;
  /** While it is dragged. */
  onMove(value: number): void;
  /** Released, or typed and left. */
  onRelease(value: number): void;
}

export interface Slider {
  element: HTMLElement;
  field: Field<HTMLInputElement>;
  value(): number;
  /** Moves it without reporting. A value outside stretches the limits. */
  set(value: number): void;
  setLimits(lo: number, hi: number): void;
}

const STEPS = 1000;

export function slider(options: SliderOptions, errors: FormErrors): Slider {
  let [lo, hi] = options.log ? [0.1, 10] : [0, 1];
  let value = lo;
  let reported = NaN;
  const field = textField({ ...options, value: "" }, errors);
  const range = h("input", { type: "range", min: 0, max: STEPS, step: 1, "aria-label": `${options.label}, slider` });
  field.input.after(range);
  field.element.classList.add("slider");

  const share = (at: number): number =>
    options.log ? Math.log(at / lo) / Math.log(hi / lo) : (at - lo) / (hi - lo || 1);
  const valueAt = (part: number): number => (options.log ? lo * (hi / lo) ** part : lo + part * (hi - lo));

  /** No more digits than a hand can set: those of the slider's step, at its ends the ends themselves. */
  function reachable(wanted: number): number {
    if (options.log) return Number(wanted.toPrecision(4));
    const near = (end: number): boolean => Math.abs(wanted - end) < (hi - lo) / (2 * STEPS);
    if (near(lo)) return lo;
    if (near(hi)) return hi;
    const decimals = Math.max(0, Math.min(12, -Math.floor(Math.log10((hi - lo) / STEPS))));
    return Number(wanted.toFixed(decimals));
  }

  function write(texts: boolean): void {
    range.value = String(Math.round(STEPS * share(value)));
    range.setAttribute("aria-valuetext", options.spoken(value));
    if (texts) field.input.value = String(reachable(value));
  }

  function take(next: number): void {
    value = next;
    write(true);
  }

  function release(): void {
    if (value === reported) return;
    reported = value;
    options.onRelease(value);
  }

  range.addEventListener("input", () => {
    take(reachable(valueAt(Number(range.value) / STEPS)));
    options.onMove(value);
  });
  range.addEventListener("change", release);
  range.addEventListener("keydown", (event) => {
    const direction = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (!direction || !event.shiftKey) return;
    event.preventDefault();
    take(reachable(valueAt(Math.min(1, Math.max(0, share(value) + direction * 0.1)))));
    options.onMove(value);
    release();
  });
  field.input.addEventListener("change", () => {
    const parsed = parseNumber(field.input.value, options.label);
    const bad = !parsed.ok
      ? parsed.sentence
      : options.log && parsed.value <= 0
        ? `${options.label} is ${field.input.value}; it must be above 0.`
        : "";
    if (bad || !parsed.ok) {
      field.control.error.textContent = bad;
      field.control.error.hidden = false;
      field.input.setAttribute("aria-invalid", "true");
      return;
    }
    lo = Math.min(lo, parsed.value);
    hi = Math.max(hi, parsed.value);
    value = parsed.value;
    write(false);
    options.onMove(value);
    release();
  });
  write(false);

  return {
    element: field.element,
    field,
    value: () => value,
    set(next) {
      lo = Math.min(lo, next);
      hi = Math.max(hi, next);
      reported = next;
      take(next);
    },
    setLimits(from, to) {
      if (!(to > from) || (options.log && from <= 0)) return;
      // Nothing was set yet: it stands at its least.
      if (Number.isNaN(reported)) value = from;
      [lo, hi] = [Math.min(from, value), Math.max(to, value)];
      write(false);
    },
  };
}
