// Plots that can be dragged: the Nyquist curve to or from −1, the peak of a response up or down. A drag moves a slider
// of the method, so that undo, address and keyboard are those of the slider.
import type { Entry, TuneEntry } from "../api/types.ts";
import { pursue } from "../live/pursuit.ts";
import type { KnownFigure } from "../live/pursuit.ts";
import type { OnDrag } from "../plot/frame.ts";
import { running } from "../words/running.ts";

/** A slider that a drag can move. */
export interface MovableSlider {
  id: string;
  label: string;
  value: number;
  lo: number;
  hi: number;
}

export interface GripSliders {
  /** The method's sliders, at their present values; empty: the design cannot follow. */
  movable(): MovableSlider[];
  /** Moves one of them; `released`: as one step. */
  turn(id: string, value: number, released: boolean): void;
}

/** How one plot is dragged. */
export interface Grip {
  /** The slider that follows, as on the page. */
  label: string;
  drag: OnDrag;
}

export interface Grips {
  nyquist(): Grip | null;
  /** `step`: of the set point, in units of y. */
  peak(kind: "setpoint" | "load", step: number): Grip | null;
  /** A newer design is shown: a drag that has not reached its pointer goes on. */
  answered(): void;
}

export const peakOf = (entry: Entry, kind: "setpoint" | "load"): { t: number; y: number } | null => {
  const { t = [], y = [] } = running(entry).responses?.[kind] ?? {};
  const size = (value: number | null): number => (kind === "load" ? Math.abs(value ?? 0) : (value ?? -Infinity));
  // A set-point step down has its peak at the bottom.
  const down = kind === "setpoint" && (y.at(-1) ?? 0) < 0;
  const at = y.reduce<number>((best, value, index) => ((down ? -(value ?? Infinity) : size(value)) > (down ? -(y[best] ?? Infinity) : size(y[best] ?? null)) ? index : best), 0);
  const [time, height] = [t[at], y[at]];
  return typeof time === "number" && typeof height === "number" ? { t: time, y: height } : null;
};

const distance = ({ x, y }: { x: number; y: number }): number => Math.hypot(x + 1, y);

/** The newest answer, and the method's options for which it was made; null: those with which the sliders began. */
export interface ShownDesign {
  entry: Entry | undefined;
  tune: TuneEntry | null;
}

export function plotGrips(sliders: GripSliders, shown: () => ShownDesign): Grips {
  /** The drag that is going on. */
  let pursuit: {
    slider: MovableSlider;
    target: number;
    known: KnownFigure[];
    figure: (entry: Entry) => number | null;
    rises: boolean;
    /** The value that was requested last. */
    asked?: number;
  } | null = null;
  let began: number | null = null;

  const find = (id: string): MovableSlider | undefined => sliders.movable().find((slider) => slider.id === id);
  const leading = (): MovableSlider | undefined => find("Ms") ?? sliders.movable()[0];

  /** A slider whose value is the dragged figure itself. */
  function turnTo(slider: MovableSlider, value: number, released: boolean): void {
    sliders.turn(slider.id, Math.min(slider.hi, Math.max(slider.lo, value)), released);
  }

  /** The next value of the slider; the same one is not requested again, also where the slider has rounded it. */
  function step(released: boolean): void {
    if (!pursuit) return;
    const { slider, target, known, rises } = pursuit;
    const now = find(slider.id)?.value ?? slider.value;
    const next = known.length === 0 ? now : pursue(known, target, slider.lo, slider.hi, rises);
    if (!released && (pursuit.asked === next || Math.abs(next - now) <= 1e-9 * Math.abs(now))) return;
    pursuit.asked = next;
    sliders.turn(slider.id, next, released);
  }

  function learn(): void {
    const { entry, tune } = shown();
    const value = pursuit && (tune ? tune[pursuit.slider.id] : pursuit.slider.value);
    const figure = entry && pursuit?.figure(entry);
    if (!pursuit || typeof value !== "number" || typeof figure !== "number" || !Number.isFinite(figure)) return;
    pursuit.known = [...pursuit.known.filter((other) => other.value !== value), { value, figure }];
  }

  function follow(slider: MovableSlider, figure: (entry: Entry) => number | null, rises: boolean, target: number, released: boolean): void {
    pursuit = { ...(pursuit ?? { known: [] }), slider, figure, rises, target };
    if (pursuit.known.length === 0) learn();
    step(released);
    if (released) pursuit = null;
  }

  return {
    nyquist() {
      const slider = leading();
      if (!slider) return null;
      const drag: OnDrag = (to, released, from) => {
        began ??= slider.id === "Ms" ? slider.value : (shown().entry?.robustness?.Ms ?? slider.value);
        const Ms = (began * distance(from)) / Math.max(1e-6, distance(to));
        if (released) began = null;
        if (slider.id === "Ms") turnTo(slider, Ms, released);
        else follow(slider, (entry) => entry.robustness?.Ms ?? null, false, Ms, released);
      };
      return { label: slider.label, drag };
    },
    peak(kind, setpoint) {
      const overshoot = kind === "setpoint" ? find("setpoint.overshoot") : undefined;
      const slider = overshoot ?? leading();
      if (!slider) return null;
      const drag: OnDrag = (to, released) => {
        if (overshoot) return turnTo(slider, 100 * (to.y / setpoint - 1), released);
        const figure = (entry: Entry): number | null => {
          const peak = peakOf(entry, kind);
          return peak && Math.abs(peak.y);
        };
        follow(slider, figure, (kind === "setpoint") === (slider.id === "Ms"), Math.abs(to.y), released);
      };
      return { label: slider.label, drag };
    },
    answered() {
      if (!pursuit) return;
      learn();
      step(false);
    },
  };
}
