// A modified design: the method's options, or settings by hand; its steps for undo and redo, and its form in the
// address.
import type { Controller, Method, TuneEntry, TypedSettings } from "../api/types.ts";
import { MANUAL, manualValue, isTied, withManual, withOption } from "./sliders.ts";
import type { ManualName, SliderSpec } from "./sliders.ts";

export interface Point {
  /** The method with its options; null if there is none, as for today's settings. */
  tune: TuneEntry | null;
  /** Settings that were moved by hand; they deviate from the method's result. */
  manual: Controller | null;
  /** The same as typed into a product; missing if they were not. */
  typed?: TypedSettings | undefined;
}

export const samePoint = (a: Point, b: Point): boolean => JSON.stringify(a) === JSON.stringify(b);

const MAX_STEPS = 100;

export interface Steps {
  past: readonly Point[];
  now: Point;
  future: readonly Point[];
}

export const firstStep = (now: Point): Steps => ({ past: [], now, future: [] });

/** Adds a step; undone steps are removed. */
export function stepTo(steps: Steps, next: Point): Steps {
  if (samePoint(steps.now, next)) return steps;
  return { past: [...steps.past, steps.now].slice(-MAX_STEPS), now: next, future: [] };
}

/** Replaces the last step. */
export const stepInPlace = (steps: Steps, next: Point): Steps => ({ past: steps.past, now: next, future: [] });

export function stepBack(steps: Steps): Steps {
  const before = steps.past.at(-1);
  return before ? { past: steps.past.slice(0, -1), now: before, future: [steps.now, ...steps.future] } : steps;
}

export function stepForward(steps: Steps): Steps {
  const [after, ...rest] = steps.future;
  return after ? { past: [...steps.past, steps.now], now: after, future: rest } : steps;
}

/** Parts that no slider by hand moves, and that may differ from the proposal in a modified design. */
const OTHER_PARTS = ["b", "c", "delta_r", "filter.type", "setpoint_filter.T"];

const at = (whole: TuneEntry | Controller | null | undefined, id: string): unknown =>
  id.split(".").reduce<unknown>((value, part) => (value as Record<string, unknown> | undefined)?.[part], whole ?? {});

/** The options of a method that an address may contain. */
const idsOf = (sliders: readonly SliderSpec[]): string[] => [...new Set(sliders.flatMap(({ id, along = [] }) => [id, ...along]))];

/** The difference of a point from the proposal and its controller, for the address; with all digits. */
export function valuesOf(
  point: Point,
  proposal: Point,
  controller: Controller | undefined,
  sliders: readonly SliderSpec[],
): Record<string, string> {
  const values: Record<string, string> = {};
  for (const id of idsOf(sliders)) {
    const value = at(point.tune, id);
    if (typeof value === "number" && value !== at(proposal.tune, id)) values[id] = String(value);
  }
  if (!point.manual) return values;
  for (const name of MANUAL) {
    const value = manualValue(point.manual, name);
    if (value !== null) values[name] = String(value);
  }
  for (const id of OTHER_PARTS) {
    const value = at(point.manual, id);
    if (value !== at(controller, id)) values[id] = String(value ?? "");
  }
  if (point.typed) values[TYPED] = JSON.stringify(point.typed);
  return values;
}

/** The name of the settings as typed into a product in an address. */
const TYPED = "typed";

/** The settings as typed in an address, which may be cut or changed; undefined if there are none. */
function typedOf(values: Record<string, string>): TypedSettings | undefined {
  try {
    const typed = JSON.parse(values[TYPED] ?? "null") as TypedSettings | null;
    return typeof typed?.product === "string" && typeof typed.settings === "object" && typed.settings !== null ? typed : undefined;
  } catch {
    return undefined;
  }
}

/** The same controller with a part from the address; an empty text removes it. */
function withPart(controller: Controller, id: string, text: string): Controller {
  const [name = id, part] = id.split(".");
  const { [name as keyof Controller]: _before, ...others } = controller;
  const value = part === "type" ? text : Number(text);
  if (text === "" || Number.isNaN(value)) return others as Controller;
  return { ...others, [name]: part ? { [part]: value } : value } as Controller;
}

const numberIn = (values: Record<string, string>, id: string): number | null => {
  const value = Number(values[id] ?? NaN);
  return Number.isFinite(value) ? value : null;
};

/** The settings by hand in an address; null if there are none. */
function manualOf(values: Record<string, string>, controller: Controller): Controller | null {
  const has = (name: ManualName): boolean =>
    manualValue(controller, name) !== null || (name === "Tf" && "filter.type" in values);
  const given = MANUAL.filter((name) => numberIn(values, name) !== null && has(name));
  if (given.length === 0) return null;
  const base = OTHER_PARTS.filter((id) => id in values).reduce((to, id) => withPart(to, id, values[id]!), controller);
  return given.reduce((to, name) => withManual(to, name, numberIn(values, name)!), base);
}

/** The point of an address; parts that are missing are as proposed. */
export function pointOf(
  values: Record<string, string>,
  proposal: Point,
  controller: Controller | undefined,
  sliders: readonly SliderSpec[],
): Point {
  let { tune } = proposal;
  for (const id of idsOf(sliders)) {
    const value = numberIn(values, id);
    if (tune && value !== null) tune = withOption(tune, id, value);
  }
  const manual = controller ? manualOf(values, controller) : null;
  const typed = manual ? typedOf(values) : undefined;
  return { tune, manual: manual ?? proposal.manual, ...(typed ? { typed } : {}) };
}

/** True if options that may move together with another one do so. */
export const tiedAt = (point: Point, method: Method | undefined): boolean => point.tune === null || isTied(point.tune, method);
