// Set-point and load responses: y over u on one time axis.
import type { TuningRequest } from "../api/types.ts";
import type { Frame, Mark, Trace } from "../plot/frame.ts";
import { formatNumber, unitNames, withUnit } from "../words/numbers.ts";
import type { Drawn } from "./drawn.ts";

export function responseFrame(kind: "setpoint" | "load", drawn: Drawn[], request: TuningRequest | undefined): Frame {
  const units = unitNames(request?.units);
  const traces = (signal: "y" | "u"): Trace[] =>
    drawn.flatMap((item): Trace[] => {
      const response = item.entry.responses?.[kind];
      return response ? [{ name: item.name, look: item.look, x: response.t, y: response[signal] }] : [];
    });
  const step = request?.evaluate?.setpoint_step ?? 1;
  const setpoint: Mark[] =
    kind === "setpoint" ? [{ kind: "level", value: step, role: "setpoint", label: "set point" }] : [];
  return {
    title: kind === "setpoint" ? "Set-point step" : "Load step at the plant input",
    description: describe(kind, drawn, units.time, units.y),
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes: [
      { y: { kind: "linear", label: withUnit("y", units.y) }, traces: traces("y"), marks: setpoint, weight: 1.5 },
      { y: { kind: "linear", label: withUnit("u", units.u) }, traces: traces("u"), marks: actuatorMarks(request) },
    ],
    link: "time",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: kind === "setpoint" ? "set-point-step" : "load-step",
  };
}

function actuatorMarks(request: TuningRequest | undefined): Mark[] {
  const actuator = request?.evaluate?.actuator;
  return [actuator?.min, actuator?.max].flatMap((value): Mark[] =>
    typeof value === "number" ? [{ kind: "level", value, role: "limit" }] : [],
  );
}

function describe(kind: "setpoint" | "load", drawn: Drawn[], time: string, y: string): string {
  const sentences = drawn.map((item) => {
    const figures = item.entry.performance?.[kind];
    const number = (name: string): string => {
      const value = figures?.[name];
      return formatNumber(typeof value === "number" ? value : null);
    };
    return kind === "setpoint"
      ? `${item.name}: overshoot ${number("overshoot_percent")} %, settles after ${number("settling_time")} ${time}.`
      : `${item.name}: peak ${number("peak")} ${y}, integrated absolute error ${number("IAE")}.`;
  });
  return sentences.join(" ") || "No response to draw.";
}
