// A design as it was turned: the method's options, or settings by hand; its steps back and forth, and its place in the address.
import type { Controller, TuneEntry } from "../api/types.ts";
import { HAND, handValue, isTied, withHand, withOption } from "./knobs.ts";
import type { Knob } from "./knobs.ts";

export interface Point {
  /** The method with its options; null where there is none, as for today's settings. */
  tune: TuneEntry | null;
  /** Settings that were moved by hand; they leave what the method says. */
  hand: Controller | null;
}

export const samePoint = (a: Point, b: Point): boolean => JSON.stringify(a) === JSON.stringify(b);

const MOST_STEPS = 100;

export interface Steps {
  past: readonly Point[];
  now: Point;
  future: readonly Point[];
}

export const firstStep = (now: Point): Steps => ({ past: [], now, future: [] });

/** A step on; what was undone before is gone. */
export function stepTo(steps: Steps, next: Point): Steps {
  if (samePoint(steps.now, next)) return steps;
  return { past: [...steps.past, steps.now].slice(-MOST_STEPS), now: next, future: [] };
}

export function stepBack(steps: Steps): Steps {
  const before = steps.past.at(-1);
  return before ? { past: steps.past.slice(0, -1), now: before, future: [steps.now, ...steps.future] } : steps;
}

export function stepForward(steps: Steps): Steps {
  const [after, ...rest] = steps.future;
  return after ? { past: [...steps.past, steps.now], now: after, future: rest } : steps;
}

const written = (value: number): string => String(Number(value.toPrecision(6)));

/** What of a point differs from the proposal, for the address. */
export function valuesOf(point: Point, proposal: Point, knobs: readonly Knob[]): Record<string, string> {
  const values: Record<string, string> = {};
  const at = (tune: TuneEntry | null, id: string): unknown =>
    id.split(".").reduce<unknown>((value, part) => (value as Record<string, unknown> | undefined)?.[part], tune ?? {});
  for (const id of [...knobs.map((knob) => knob.id), ...(knobs.some((knob) => knob.id === "Ms") ? ["Mt"] : [])]) {
    const value = at(point.tune, id);
    if (typeof value === "number" && value !== at(proposal.tune, id)) values[id] = written(value);
  }
  for (const name of point.hand ? HAND : []) {
    const value = handValue(point.hand!, name);
    if (value !== null) values[name] = written(value);
  }
  return values;
}

/** The point that an address means; what it does not name is as proposed. */
export function pointOf(
  values: Record<string, string>,
  proposal: Point,
  controller: Controller | undefined,
  knobs: readonly Knob[],
): Point {
  const number = (id: string): number | null => {
    const value = Number(values[id] ?? NaN);
    return Number.isFinite(value) ? value : null;
  };
  let { tune, hand } = proposal;
  const ids = [...new Set([...knobs.map((knob) => knob.id), ...(knobs.some((knob) => knob.id === "Ms") ? ["Mt"] : [])])];
  for (const id of ids) {
    const value = number(id);
    if (tune && value !== null) tune = withOption(tune, id, value, false);
  }
  for (const name of HAND) {
    const value = number(name);
    if (value === null || !controller) continue;
    if (handValue(controller, name) !== null) hand = withHand(hand ?? controller, name, value);
  }
  return { tune, hand };
}

/** Whether Mt goes along when Ms is turned. */
export const tiedAt = (point: Point): boolean => point.tune === null || isTied(point.tune);
