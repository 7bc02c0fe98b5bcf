// The user's own step: as texts by the names of its fields, from a request and back, and the step that a result without
// one proposes.
import type { FieldError, Model, OwnStep, Result, Span, TuningRequest } from "../api/types.ts";
import { exactText } from "../words/numbers.ts";
import { usualSpan } from "../words/record_names.ts";
import { parseNumber } from "./number.ts";
import { defined } from "./tuning_request.ts";

const NUMBERS = ["y", "u", "target", "ramp_rate", "u_min", "u_max", "hold", "load.size", "load.duration", "length"] as const;
const WORDS = ["load.at", "load.shape"] as const;

export type StepNumber = (typeof NUMBERS)[number];
export type StepWord = (typeof WORDS)[number];
/** Texts by the names of the members; one that is missing or empty is left out of the request. */
export type StepTexts = Record<string, string>;

export const STEP_POINTER = "/evaluate/own_step";

export const pointerOf = (name: StepNumber | StepWord): string => `${STEP_POINTER}/${name.replace(".", "/")}`;

/** What the page calls them, without units. */
export const STEP_LABELS: Record<StepNumber, string> = {
  y: "y at rest",
  u: "u at rest",
  target: "New set point",
  ramp_rate: "Ramp",
  u_min: "Lowest u",
  u_max: "Highest u",
  hold: "Time until the load",
  "load.size": "Size of the load",
  "load.duration": "Duration of the load",
  length: "Simulated time",
};

const member = (step: object, name: string): unknown =>
  name.split(".").reduce<unknown>((at, part) => (at as Record<string, unknown> | undefined)?.[part], step);

/** With the members that the step leaves to their defaults, without a duration that its load does not have. */
export function textsOf({ load, ...own }: OwnStep): StepTexts {
  const { duration, ...ofLoad } = { at: "input", shape: "step", ...load };
  const whole = {
    y: 0,
    u: 0,
    ...own,
    ...(load ? { load: { ...ofLoad, ...(ofLoad.shape === "step" || duration === undefined ? {} : { duration }) } } : {}),
  };
  const written = (value: unknown): string => (typeof value === "number" ? exactText(value) : String(value));
  return Object.fromEntries(
    [...NUMBERS, ...WORDS].flatMap((name) => {
      const value = member(whole, name);
      return value === undefined ? [] : [[name, written(value)]];
    }),
  );
}

export const sameStep = (a: OwnStep | undefined, b: OwnStep | undefined): boolean =>
  JSON.stringify(a ? textsOf(a) : null) === JSON.stringify(b ? textsOf(b) : null);

export interface StepReading {
  /** Null: a text is not a number, or one that is needed is empty. */
  step: OwnStep | null;
  errors: FieldError[];
}

/** A load without a size is none; only a pulse and a ramp have a duration. */
export function readStep(texts: StepTexts): StepReading {
  const errors: FieldError[] = [];
  const text = (name: StepNumber | StepWord): string => texts[name]?.trim() ?? "";
  const number = (name: StepNumber, needed = false): number | undefined => {
    if (text(name) === "" && !needed) return undefined;
    const parsed = parseNumber(text(name), STEP_LABELS[name]);
    if (parsed.ok) return parsed.value;
    errors.push({ pointer: pointerOf(name), detail: parsed.sentence });
    return undefined;
  };
  const shape = (text("load.shape") || "step") as "step" | "pulse" | "ramp";
  const size = number("load.size");
  const load =
    size === undefined
      ? undefined
      : defined({ size, at: text("load.at") || undefined, shape, duration: shape === "step" ? undefined : number("load.duration", true) });
  const own = ["y", "u", "target", "ramp_rate", "u_min", "u_max", "hold", "length"] as const;
  const step = { ...defined(Object.fromEntries(own.map((name) => [name, number(name, name === "target")]))), ...(load ? { load } : {}) };
  return { step: errors.length > 0 ? null : (step as unknown as OwnStep), errors };
}

/** Digits of a level that a record shows. */
const LEVEL_DIGITS = 4;
/** Digits of the change to the target. */
const CHANGE_DIGITS = 2;

const rounded = (value: number, digits: number): number => Number(value.toPrecision(digits));

/** The change of y for half of the way of u to its farther limit; 0 if that is not known. */
function halfWay({ plant }: Model, u: number, limits: Span | undefined): number {
  const K = plant.type === "ipdt" ? undefined : plant["K"];
  if (!limits || typeof K !== "number") return 0;
  const [down, up] = [limits[0] - u, limits[1] - u];
  return (K * (up > -down ? up : down)) / 2;
}

/** The rest and the change that a record shows: its own set points, else the farthest that y came from its rest, as the
 * model has it; for a record without traces a change that the limits of u allow. */
function levelsOf(request: TuningRequest, { model, replay }: Result, quality: Model["data_quality"], limits: Span | undefined): { y: number; change: number } {
  const numbers = (values: readonly (number | null)[] | undefined): number[] => (values ?? []).filter((value): value is number => value !== null);
  const setPoints = numbers(replay?.r ?? request.record?.r);
  const own = setPoints.some((value) => value !== setPoints[0]);
  const from = own ? setPoints[0]! : quality.y0;
  const levels = own ? setPoints : numbers(model?.fit?.y_model);
  const farthest = levels.reduce((best, value) => (Math.abs(value - from) > Math.abs(best - from) ? value : best), from);
  const change = farthest - from || halfWay(model!, quality.u0, limits);
  return { y: rounded(from, LEVEL_DIGITS), change: rounded(change, CHANGE_DIGITS) || 1 };
}

/** Noise may take u at rest so far beyond a limit at which it is, as a share of the range. */
const BEYOND = 0.01;

/** Limits that have u at rest between them; others belong to something else. */
const limitsAround = (u: number, spans: readonly (Span | undefined)[]): Span | undefined =>
  spans.find((span) => {
    if (!span) return false;
    const beyond = BEYOND * (span[1] - span[0]);
    return span[0] - beyond <= u && u <= span[1] + beyond;
  });

/** The step from the rest of the record to its set point or to the y that it reached; for a model from 0, or from the
 * middle of the controller's ranges. The limits of u are those of the record, of the actuator, of the controller, or
 * the usual ones of u's unit. */
export function proposedStep(request: TuningRequest, result: Result): OwnStep {
  const { y_span, u_span } = request.implement ?? {};
  const { actuator, setpoint_step = 1 } = request.evaluate ?? {};
  const quality = result.model?.data_quality;
  const middle = (span: Span | undefined): number => (span ? (span[0] + span[1]) / 2 : 0);
  const u = quality ? rounded(quality.u0, LEVEL_DIGITS) : middle(u_span);
  const around: Span | undefined = actuator && [u + actuator.min, u + actuator.max];
  const usual = quality && usualSpan(request.units?.u ?? "", result.model?.fit?.u ?? []);
  const limits = limitsAround(u, [quality?.u_limits, around, u_span, usual]);
  const { y, change } = quality
    ? levelsOf(request, result, quality, limits)
    : { y: middle(y_span), change: y_span ? rounded((y_span[1] - y_span[0]) / 10, CHANGE_DIGITS) : setpoint_step };
  return {
    y,
    u: limits ? Math.min(limits[1], Math.max(limits[0], u)) : u,
    target: rounded(y + change, LEVEL_DIGITS + CHANGE_DIGITS),
    ...(limits ? { u_min: limits[0], u_max: limits[1] } : {}),
  };
}
