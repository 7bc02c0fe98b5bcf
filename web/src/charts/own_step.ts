// The user's own step with the drawn controllers: y with the set point over u with its limits, values themselves.
import type { OwnStep } from "../api/types.ts";
import type { Frame, Mark, Trace } from "../plot/frame.ts";
import { figureUnit } from "../words/figure_units.ts";
import { formatNumber, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import type { Drawn } from "./drawn.ts";
import { limitsNear } from "./responses.ts";

/** Null if no entry has a trace. */
export function ownStepFrame(drawn: readonly Drawn[], step: OwnStep, units: UnitNames): Frame | null {
  const simulated = drawn.filter(({ entry }) => entry.own_step?.trace);
  if (simulated.length === 0) return null;
  const lines = (signal: "y" | "u"): Trace[] =>
    simulated.map(({ name, look, entry }) => ({ name, look, x: entry.own_step!.trace!.t, y: entry.own_step!.trace![signal] }));
  const longest = simulated.map(({ entry }) => entry.own_step!.trace!).reduce((a, b) => (b.t.at(-1)! > a.t.at(-1)! ? b : a));
  const setPoint: Trace = { name: "set point", look: "data", thin: true, x: [0, ...longest.t], y: [step.y ?? 0, ...longest.r] };
  const us = lines("u");
  const load = simulated.find(({ entry }) => entry.own_step!.load)?.entry.own_step!.load!.start;
  const marks: Mark[] = load === undefined ? [] : [{ kind: "upright", value: load, role: "zero", label: "load" }];
  return {
    title: "Own step: r, y and u",
    description: simulated.map((item) => describe(item, units)).join(" "),
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes: [
      { y: { kind: "linear", label: withUnit("y", units.y) }, traces: [...lines("y"), setPoint], marks, weight: 1.5 },
      { y: { kind: "linear", label: withUnit("u", units.u) }, traces: us, marks: limitsNear([step.u_min, step.u_max], us) },
    ],
    ownLegend: true,
    link: "own-step",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: "own-step",
  };
}

function describe({ name, entry }: Drawn, units: UnitNames): string {
  const { setpoint, load } = entry.own_step!;
  const y = figureUnit("OwnLoadFigures", "peak", units);
  const said = [
    ...(setpoint ? [`overshoot ${formatNumber(setpoint.overshoot_percent)} %, settles after ${formatNumber(setpoint.settling_time)} ${units.time}`] : []),
    ...(load ? [`the load moves y by ${formatNumber(load.peak)}${y && ` ${y}`}`] : []),
  ];
  return `${name}: ${said.join("; ")}.`;
}
