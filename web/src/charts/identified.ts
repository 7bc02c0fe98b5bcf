// A recorded test with a candidate's model: y, u and the residual on one time axis, with the used part marked.
import type { Candidate, Model } from "../api/types.ts";
import { extent } from "../plot/axis.ts";
import type { Range } from "../plot/axis.ts";
import type { Frame, Mark } from "../plot/frame.ts";
import { formatNumber, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { recordFramed, recordPanes, unnamed } from "./record.ts";
import type { Column, Samples } from "./record.ts";

/** `whole`: the record beyond the used part, if it is known; `part`: the used part as it is being chosen. */
export function identifiedFrame(
  model: Model,
  candidate: Candidate | null,
  units: UnitNames,
  whole: Samples | null,
  part: { from: number; to: number } | null,
): Frame | null {
  const fit = model.fit;
  if (!fit || fit.t.length === 0) return null;
  const y_model = candidate?.y_model?.length === fit.t.length ? candidate.y_model : fit.y_model;
  const record: Samples = whole ?? fit;
  const marks: Mark[] = part ? [{ kind: "band", ...part, label: "used" }] : [];
  const panes = recordPanes(record, units, marks);
  panes[0]!.traces.push({ name: "model", look: 1, x: fit.t, y: y_model });
  const residual = difference(fit.y, y_model);
  const range = wideRange(residual, fit.y);
  panes.push({
    y: { kind: "linear", label: withUnit("y − model", units.y), ...(range ? { range } : {}) },
    traces: [{ name: "residual", look: "data", x: fit.t, y: residual }],
    marks: unnamed(marks),
  });
  const percent = formatNumber(candidate?.fit_percent ?? model.fit_percent);
  return recordFramed(panes, "Record and model", `The model reproduces ${percent} % of the record's movement.`, units);
}

/** A record without a model. */
export function bareRecordFrame(record: Samples, units: UnitNames, part: { from: number; to: number } | null): Frame {
  const marks: Mark[] = part ? [{ kind: "band", ...part, label: "used" }] : [];
  return recordFramed(recordPanes(record, units, marks), "Record", "There is no model of it.", units);
}

/** A residual below a thousandth of y's movement is not enlarged to the height of its pane: rounding would look like
    a signal. */
function wideRange(residual: Column, y: Column): Range | null {
  const [lo, hi] = extent([residual], "linear");
  const [min, max] = extent([y], "linear");
  const floor = 1e-3 * (max - min);
  return Math.max(-lo, hi) < floor ? [-floor, floor] : null;
}

function difference(a: Column, b: Column): Column {
  return a.map((value, index) => {
    const other = b[index];
    return typeof value === "number" && typeof other === "number" ? value - other : null;
  });
}
