import assert from "node:assert/strict";
import test from "node:test";
import type { Entry, Method, Result, Rimc, TuningRequest } from "../../../../web/src/api/types.ts";
import { fullControllerFrame, interpolate, rimcFrame, rimcRows } from "../../../../web/src/charts/rimc.ts";
import { withLambda } from "../../../../web/src/form/tuning_request.ts";
import { unitNames } from "../../../../web/src/words/numbers.ts";

const units = unitNames({ time: "min", u: "%", y: "degC" });
const rimc: Rimc = {
  lambda: 8,
  Ms: 1.6,
  disturbance_peak: 0.5,
  dead_time_error: null,
  stability_limit: 1,
  disturbance_peak_curve: {
    lambda_over_tau: [0.2, 0.4, 0.8, 1.6],
    DP_over_kp: [0.2, 0.25, 0.5, 0.7],
    Ms: [null, 2.4, 1.6, 1.3],
  },
  why_null: { dead_time_error: "Eq. 29 does not hold for any error." },
};

test("the chart marks the design at lambda over tau in both panes, with what it costs there", () => {
  const frame = rimcFrame(rimc, 10, 8, units)!;
  assert.deepEqual(
    frame.panes.map((pane) => pane.y.label),
    ["DP/k_p", "Ms"],
  );
  const points = frame.panes.map((pane) => pane.marks!.find((mark) => mark.kind === "point")!);
  assert.deepEqual(points, [
    { kind: "point", x: 0.8, y: 0.5, label: "DP/k_p 0.500" },
    { kind: "point", x: 0.8, y: 1.6, label: "Ms 1.60" },
  ]);
  assert.deepEqual(
    frame.panes[0]!.marks!.filter((mark) => mark.kind === "upright").map(
      (mark) => mark.kind === "upright" && mark.value,
    ),
    [0.1, 0.8],
  );
});

test("beyond the curve nothing is invented: no point, and no chart without a time constant", () => {
  const beyond = rimcFrame(rimc, 10, 20, units)!;
  assert.ok(beyond.panes.every((pane) => pane.marks!.every((mark) => mark.kind !== "point")));
  assert.equal(rimcFrame(rimc, NaN, 8, units), null);
  assert.equal(rimcFrame({ lambda: 8 }, 10, 8, units), null);
  assert.equal(interpolate([0.2, 0.4], [null, 2.4], 0.3), null);
  assert.ok(Math.abs(interpolate([0.4, 0.8], [2.4, 1.6], 0.5)! - 2.2) < 1e-12);
});

test("figures of the PID stand next to the full controller's, and what has none says why", () => {
  const full = { robustness: { Ms: 1.5 }, load: { peak: 0.48, IAE: 11.5 } };
  const entry: Entry = {
    method: "rimc",
    rimc: { ...rimc, full_controller: full },
    performance: { load: { IAE: 12 } },
  };
  const rows = rimcRows(entry, units);
  assert.deepEqual(rimcRows({ method: "robust" }, units), []);
  assert.deepEqual(
    rows.map((row) => [row.label, row.pid, row.full]),
    [
      ["λ (min)", 8, 8],
      ["Ms", 1.6, 1.5],
      ["Load peak (°C/%)", 0.5, 0.48],
      ["Dead time error (min)", null, null],
      ["Unstable below λ (min)", 1, null],
      ["Load IAE (°C min)", 12, 11.5],
    ],
  );
  assert.equal(rows[3]!.why, "Eq. 29 does not hold for any error.");
});

test("the load responses are drawn together where both are there", () => {
  const response = { t: [0, 1], y: [0, 1], u: [0, -1] };
  const both = fullControllerFrame({ ...rimc, full_controller: { responses: { load: response } } }, response, units)!;
  assert.deepEqual(
    both.panes[1]!.traces.map((trace) => trace.name),
    ["PID", "full controller"],
  );
  assert.equal(fullControllerFrame(rimc, response, units), null);
});

test("another lambda replaces what stood for it, in its own entry only, and asks for the chart", () => {
  const request: TuningRequest = {
    plant: { type: "fopdt", K: 1, T: 10, L: 2 },
    tune: [
      { method: "robust", Ms: 1.4 },
      { method: "rimc", Ms: 1.6, Tf_over_Td: 0.1 },
    ],
  };
  const result: Result = { controllers: [{ method: "robust" }, { method: "rimc" }, { method: "baseline" }] };
  const instead = { "x-in-place-of": "lambda" };
  const properties = { lambda: {}, Ms: instead, disturbance_peak: instead, Tf_over_Td: {} };
  const methods = [{ id: "rimc", options: { properties } }] as unknown as Method[];
  assert.deepEqual(withLambda(request, result, 1, 7, methods).tune, [
    { method: "robust", Ms: 1.4 },
    { Tf_over_Td: 0.1, method: "rimc", lambda: 7, curve: true },
  ]);
  assert.deepEqual(withLambda({ ...request, tune: "all" }, result, 1, 7, methods).tune, [
    { method: "rimc", lambda: 7, curve: true },
  ]);
  assert.equal((request.tune as { lambda?: number }[])[1]!.lambda, undefined);
});
