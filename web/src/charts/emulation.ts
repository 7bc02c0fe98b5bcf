// The result of the emulation: y and u under the nonlinear controller, the emulating PID and chosen classical settings.
import type { EmulatedScenario, Emulation, Plant } from "../api/types.ts";
import type { Frame, Look, Mark, Trace } from "../plot/frame.ts";
import { scenarioWords } from "../words/emulation.ts";
import { formatNumber, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { inputOf } from "../words/plant.ts";
import { limitsNear } from "./responses.ts";
import { interpolate } from "./rimc.ts";

/** Looks of the classical settings, in the order in which they were chosen. */
export const LEVEL_ONE_LOOKS: Look[] = [4, "data"];

/** A run with the user's own settings: absolute values. */
export interface OwnRun {
  t: number[];
  y: (number | null)[];
  u: (number | null)[];
}

/** `chosen`: indices in level1. Null if there is nothing to draw. */
export function emulationFrame(
  emulation: Emulation,
  scenario: number,
  chosen: { index: number; name: string }[],
  plant: Plant | undefined,
  units: UnitNames,
  own: OwnRun | null = null,
): Frame | null {
  const shown = emulation.scenarios?.[scenario] ?? onlyScenario(emulation);
  if (!shown?.t || shown.t.length < 2) return null;
  const { t, y_nl = [], u_nl = [] } = shown;
  const traces = (signal: "y" | "u"): Trace[] => {
    const followed = shown[signal];
    return [
      ...(followed ? [{ name: "PID", look: 1 as const, x: t, y: followed }] : []),
      { name: "nonlinear controller", look: 3, x: t, y: signal === "y" ? y_nl : u_nl },
      ...(scenario === 0 ? chosen : []).flatMap(({ index, name }, position): Trace[] => {
        const item = emulation.level1?.[index];
        const values = item?.[signal];
        const look = LEVEL_ONE_LOOKS[position] ?? "data";
        return values ? [{ name, look, x: item?.t ?? t, y: values }] : [];
      }),
      ...(own ? [{ name: "by hand", look: 2 as const, x: own.t, y: own[signal] }] : []),
    ];
  };
  const [ys, us] = [traces("y"), traces("u")];
  const input = inputOf(plant);
  const goal = shown.y_rest + shown.setpoint_step;
  const setpoint: Mark[] = Number.isFinite(goal)
    ? [{ kind: "level", value: goal, role: "setpoint", label: "set point" }]
    : [];
  return {
    title: "PID and nonlinear controller",
    description: `${scenarioWords(shown)}. J is ${formatNumber(emulation.J)}.`,
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes: [
      { y: { kind: "linear", label: withUnit("y", units.y) }, traces: ys, marks: setpoint, weight: 1.2 },
      { y: { kind: "linear", label: withUnit("u", units.u) }, traces: us, marks: limitsNear([input?.min, input?.max], us) },
    ],
    ownLegend: true,
    link: "emulation",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: "emulation",
  };
}

/** For an answer that has only the nonlinear controller's run. */
function onlyScenario(emulation: Emulation): EmulatedScenario | null {
  const { t, y_nl, u_nl } = emulation;
  return t && y_nl && u_nl ? { setpoint_step: NaN, y_rest: NaN, u_rest: NaN, limited: false, t, y_nl, u_nl } : null;
}

/** The cost of a run, compared with that of the nonlinear controller in one scenario, by the trapezoidal rule; null
    if samples are missing. */
export function costOf(emulation: Emulation, scenario: EmulatedScenario, run: OwnRun): number | null {
  const { wy = 1, wu = 1 } = emulation.weights ?? {};
  const { t = [], y_nl = [], u_nl = [] } = scenario;
  const squares = t.map((time, index) => {
    const pair = (["y", "u"] as const).map((signal) => {
      const wanted = signal === "y" ? y_nl[index] : u_nl[index];
      const value = interpolate(run.t, run[signal], time);
      return typeof wanted === "number" && value !== null ? (wanted - value) ** 2 : NaN;
    });
    return wy * pair[0]! + wu * pair[1]!;
  });
  const cost = squares.slice(1).reduce((sum, value, at) => {
    return sum + ((value + squares[at]!) / 2) * (t[at + 1]! - t[at]!);
  }, 0);
  return Number.isFinite(cost) ? cost : null;
}
