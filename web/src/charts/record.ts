// The recorded test against the model identified from it.
import type { Model, TuningRequest } from "../api/types.ts";
import type { Frame, Pane } from "../plot/frame.ts";
import { formatNumber, unitNames, withUnit } from "../words/numbers.ts";

export function recordFrame(model: Model, request: TuningRequest | undefined): Frame | null {
  const fit = model.fit;
  if (!fit || fit.t.length === 0) return null;
  const units = unitNames(request?.units);
  const u = inputOf(model, request);
  const panes: Pane[] = [
    {
      y: { kind: "linear", label: withUnit("y", units.y) },
      traces: [
        { name: "record", look: "data", x: fit.t, y: fit.y },
        { name: "model", look: 1, x: fit.t, y: fit.y_model },
      ],
      weight: 2,
    },
  ];
  if (u)
    panes.push({
      y: { kind: "linear", label: withUnit("u", units.u) },
      traces: [{ name: "input", look: "data", x: u.t, y: u.u }],
    });
  return {
    title: "Recorded test and model",
    description: `The model reproduces ${formatNumber(model.fit_percent)} % of the record's movement.`,
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes,
    ownLegend: true,
    link: "record",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: "record-and-model",
  };
}

/** The input: from the fit, or from a record that was given as numbers. */
function inputOf(model: Model, request: TuningRequest | undefined): { t: number[]; u: (number | null)[] } | null {
  const fit = model.fit!;
  if (fit.u && fit.u.length === fit.t.length) return { t: fit.t, u: fit.u };
  const u = request?.record?.u;
  if (Array.isArray(u) && u.length === fit.t.length) return { t: fit.t, u };
  return null;
}
