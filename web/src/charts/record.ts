// A recorded test as panes of y and u, with the output of the model identified from it.
import type { Model, TuningRequest } from "../api/types.ts";
import type { Frame, Mark, Pane } from "../plot/frame.ts";
import { formatNumber, unitNames, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";

export type Column = (number | null)[];

export interface Samples {
  t: number[];
  y: Column;
  u?: Column;
}

/** The plot of a job's record and model; null without a record. */
export function recordFrame(model: Model, request: TuningRequest | undefined): Frame | null {
  const fit = model.fit;
  if (!fit || fit.t.length === 0) return null;
  const units = unitNames(request?.units);
  const u = fit.u ?? request?.record?.u;
  const panes = recordPanes({ t: fit.t, y: fit.y, ...(u ? { u } : {}) }, units, []);
  panes[0]!.traces.push({ name: "model", look: 1, x: fit.t, y: fit.y_model });
  const percent = formatNumber(model.fit_percent);
  const description = `The model reproduces ${percent} % of the record's movement.`;
  return recordFramed(panes, "Recorded test and model", description, units);
}

/** y over u on one time axis. */
export function recordPanes(record: Samples, units: UnitNames, marks: Mark[]): Pane[] {
  const panes: Pane[] = [
    {
      y: { kind: "linear", label: withUnit("y", units.y) },
      traces: [{ name: "record", look: "data", x: record.t, y: record.y }],
      marks,
      weight: 2.4,
    },
  ];
  if (record.u && record.u.length === record.t.length)
    panes.push({
      y: { kind: "linear", label: withUnit("u", units.u) },
      traces: [{ name: "u", look: "data", ...held(record.t, record.u) }],
      marks: unnamed(marks),
    });
  return panes;
}

export function recordFramed(panes: Pane[], title: string, description: string, units: UnitNames): Frame {
  return {
    title,
    description,
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes,
    ownLegend: true,
    link: "record",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: "record-and-model",
  };
}

/** The parts of a record in which exactly one of the moves of u at these times is seen: from the middle of the rest
    before it to the next move. */
export function stepParts(t: readonly number[], moves: readonly number[]): { at: number; from: number; to: number }[] {
  return moves.map((at, count) => {
    const previous = count > 0 ? moves[count - 1]! : t[0]!;
    const next = moves[count + 1] ?? Infinity;
    return { at, from: (previous + at) / 2, to: Math.max(at, ...t.filter((time) => time < next).slice(-1)) };
  });
}

/** Bands without their names, which are shown in the first pane. */
export const unnamed = (marks: Mark[]): Mark[] =>
  marks.map((mark) => (mark.kind === "band" ? { kind: "band", from: mark.from, to: mark.to } : mark));

/** u holds from one sample to the next: corners instead of slopes. */
export function held(t: readonly number[], u: readonly (number | null)[]): { x: number[]; y: Column } {
  const x: number[] = [];
  const y: Column = [];
  for (let index = 0; index < t.length; index += 1) {
    const value = u[index] ?? null;
    if (index > 0 && value !== u[index - 1]) {
      x.push(t[index]!);
      y.push(u[index - 1] ?? null);
    }
    x.push(t[index]!);
    y.push(value);
  }
  return { x, y };
}
