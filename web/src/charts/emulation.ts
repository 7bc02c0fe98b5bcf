// What the PID follows and how: y and u under the nonlinear controller, the emulating PID and chosen classical settings.
import type { Emulation, EmulationScenario, Plant } from "../api/types.ts";
import { extent } from "../plot/axis.ts";
import type { Frame, Look, Mark, Trace } from "../plot/frame.ts";
import { scenarioWords } from "../words/emulation.ts";
import { formatNumber, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { inputOf } from "../words/plant.ts";

/** Looks of the classical settings, in the order in which they were chosen. */
export const LEVEL_ONE_LOOKS: Look[] = [4, 2];

/** `chosen`: indices in level1. Null where there is nothing to draw. */
export function emulationFrame(
  emulation: Emulation,
  scenario: number,
  chosen: { index: number; name: string }[],
  plant: Plant | undefined,
  units: UnitNames,
): Frame | null {
  const shown = emulation.scenarios?.[scenario] ?? onlyScenario(emulation);
  if (!shown || shown.t.length < 2) return null;
  const traces = (signal: "y" | "u"): Trace[] => {
    const followed = shown[signal];
    return [
      ...(followed ? [{ name: "PID", look: 1 as const, x: shown.t, y: followed }] : []),
      { name: "nonlinear controller", look: 3, x: shown.t, y: signal === "y" ? shown.y_nl : shown.u_nl },
      ...(scenario === 0 ? chosen : []).flatMap(({ index, name }, position): Trace[] => {
        const item = emulation.level1?.[index];
        const values = item?.[signal];
        return values ? [{ name, look: LEVEL_ONE_LOOKS[position] ?? 2, x: item?.t ?? shown.t, y: values }] : [];
      }),
    ];
  };
  const [ys, us] = [traces("y"), traces("u")];
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
      { y: { kind: "linear", label: withUnit("u", units.u) }, traces: us, marks: limitsNear(plant, us) },
    ],
    ownLegend: true,
    link: "emulation",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: "emulation",
  };
}

/** Of an answer that gives the nonlinear controller's run alone. */
function onlyScenario(emulation: Emulation): EmulationScenario | null {
  const { t, y_nl, u_nl } = emulation;
  return t && y_nl && u_nl ? { setpoint_step: NaN, y_rest: NaN, u_rest: NaN, t, y_nl, u_nl } : null;
}

/** Limits of the input that u comes near; others would squeeze its movement. */
function limitsNear(plant: Plant | undefined, traces: Trace[]): Mark[] {
  const input = inputOf(plant);
  const [lo, hi] = extent(
    traces.map((trace) => trace.y),
    "linear",
  );
  return [input?.min, input?.max].flatMap((value): Mark[] =>
    typeof value === "number" && value > lo - (hi - lo) / 2 && value < hi + (hi - lo) / 2
      ? [{ kind: "level", value, role: "limit" }]
      : [],
  );
}
