// Set-point and load responses: y over u on one time axis.
import type { Figures, TuningRequest } from "../api/types.ts";
import { extent } from "../plot/axis.ts";
import type { Frame, Look, Mark, OnDrag, Trace } from "../plot/frame.ts";
import { formatNumber, unitNames, withUnit } from "../words/numbers.ts";
import { inputOf } from "../words/plant.ts";
import type { Drawn } from "./drawn.ts";

/** With more entries the linear counterparts of all would be too many curves. */
const MAX_WITH_LINEAR = 2;

/** True if the responses are those of a nonlinear plant, drawn with the linearised loop's. */
export const hasLinear = (drawn: Drawn[]): boolean => drawn.some((item) => item.entry.linear?.responses);

/** The sentence above such plots. */
export const LINEAR_NOTE =
  "Responses are those of the equations; thin and dotted: the same controller on their linear model.";

/** The peak that can be dragged, and the slider that follows. */
export interface PeakGrip {
  at: { t: number; y: number } | null;
  look: Look;
  label: string;
  drag: OnDrag;
}

/** `selected`: the entry whose linear counterpart is drawn if there are many. */
export function responseFrame(
  kind: "setpoint" | "load",
  drawn: Drawn[],
  request: TuningRequest | undefined,
  selected?: number,
  grip?: PeakGrip | null,
): Frame {
  const units = unitNames(request?.units);
  const traces = (signal: "y" | "u"): Trace[] =>
    drawn.flatMap((item): Trace[] => {
      const response = item.entry.responses?.[kind];
      const withLinear = drawn.length <= MAX_WITH_LINEAR || item.index === selected;
      const linear = withLinear ? item.entry.linear?.responses?.[kind] : undefined;
      return [
        ...(response ? [{ name: item.name, look: item.look, x: response.t, y: response[signal] }] : []),
        ...(linear
          ? [{ name: `${item.name}, linear model`, look: item.look, thin: true, x: linear.t, y: linear[signal] }]
          : []),
      ];
    });
  const step = request?.evaluate?.setpoint_step ?? 1;
  const setpoint: Mark[] =
    kind === "setpoint" ? [{ kind: "level", value: step, role: "setpoint", label: "set point" }] : [];
  const handle: Mark[] = grip?.at
    ? [{ kind: "point", x: grip.at.t, y: grip.at.y, label: `drag: ${grip.label}`, look: grip.look, quiet: true, handle: true }]
    : [];
  return {
    ...(grip?.at ? { drag: grip.drag } : {}),
    title: kind === "setpoint" ? "Set-point step" : "Load step at the plant input",
    description: `${describe(kind, drawn, units.time, units.y)}${grip?.at ? ` The peak can be dragged, which moves ${grip.label}.` : ""}`,
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes: [
      { y: { kind: "linear", label: withUnit("y", units.y) }, traces: traces("y"), marks: [...setpoint, ...handle], weight: 1.5 },
      {
        y: { kind: "linear", label: withUnit("u", units.u) },
        traces: traces("u"),
        marks: limitMarks(request, traces("u")),
      },
    ],
    link: "time",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: kind === "setpoint" ? "set-point-step" : "load-step",
  };
}

/** Limits of u as deviations: those of the request, and for a nonlinear plant its own if u approaches them. */
function limitMarks(request: TuningRequest | undefined, traces: Trace[]): Mark[] {
  const actuator = request?.evaluate?.actuator;
  const input = inputOf(request?.plant);
  const [lo, hi] = extent(
    traces.map((trace) => trace.y),
    "linear",
  );
  const near = (value: number): boolean => value > lo - (hi - lo) / 2 && value < hi + (hi - lo) / 2;
  const own = [input?.min, input?.max].flatMap((value) => (typeof value === "number" ? [value - input!.nominal] : []));
  const values = [actuator?.min, actuator?.max, ...own.filter(near)].filter((value) => typeof value === "number");
  return values.map((value): Mark => ({ kind: "level", value, role: "limit" }));
}

function describe(kind: "setpoint" | "load", drawn: Drawn[], time: string, y: string): string {
  const sentences = drawn.map((item) => {
    const figures = item.entry.performance?.[kind];
    const number = (name: string): string => {
      const value = (figures as Figures | undefined)?.[name];
      return formatNumber(typeof value === "number" ? value : null);
    };
    return kind === "setpoint"
      ? `${item.name}: overshoot ${number("overshoot_percent")} %, settles after ${number("settling_time")} ${time}.`
      : `${item.name}: peak ${number("peak")}${y && ` ${y}`}, integrated absolute error ${number("IAE")}.`;
  });
  return sentences.join(" ") || "No response to draw.";
}
