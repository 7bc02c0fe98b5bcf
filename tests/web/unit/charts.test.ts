import assert from "node:assert/strict";
import test from "node:test";
import type { Entry, Result } from "../../../web/src/api/types.ts";
import { defaultDrawn, drawnEntries, entryNames } from "../../../web/src/charts/drawn.ts";
import { bodeFrame } from "../../../web/src/charts/bode.ts";
import { nyquistFrame, windingOf } from "../../../web/src/charts/nyquist.ts";
import { recordFrame } from "../../../web/src/charts/record.ts";
import { responseFrame } from "../../../web/src/charts/responses.ts";
import { sensitivityFrame } from "../../../web/src/charts/sensitivities.ts";

const traces = { setpoint: { t: [0, 1], y: [0, 1], u: [2, 1] }, load: { t: [0, 1], y: [0, 0.2], u: [0, -1] } };
const frequency = {
  omega: [0.1, 1],
  L: { re: [0, -0.5], im: [-5, -0.5] },
  S_abs: [0.1, 1.4],
  T_abs: [1, 0.5],
  CS_abs: [1, 3],
};
const make = (method: string, extra: Partial<Entry> = {}): Entry => ({
  method,
  options: {},
  responses: traces,
  frequency,
  ...extra,
});

test("the best of the ranking and today's settings are drawn, four at most, today always as series 2", () => {
  const result: Result = {
    controllers: [
      make("robust"),
      make("simc"),
      make("lambda", { error: { detail: "no" } }),
      make("amigo"),
      make("imc"),
      make("baseline"),
    ],
    ranking: [4, 1, 0, 3, 5],
  };
  assert.deepEqual(defaultDrawn(result), [0, 1, 4, 5]);
  assert.deepEqual(
    drawnEntries(result, [0, 1, 4, 5]).map((item) => item.look),
    [1, 3, 4, 2],
  );
  assert.deepEqual(
    drawnEntries(result, [0, 2, 9]).map((item) => item.index),
    [0],
  );
  assert.deepEqual(
    drawnEntries({ controllers: [make("a"), make("b"), make("c"), make("d")] }, [0, 1, 2, 3]).map((item) => item.look),
    [1, 2, 3, 4],
  );
});

test("entries of one method are distinguished by the option that differs", () => {
  assert.deepEqual(
    entryNames([make("robust", { options: { Ms: 1.4 } }), make("robust", { options: { Ms: 1.6 } }), make("baseline")]),
    ["robust Ms 1.4", "robust Ms 1.6", "today"],
  );
  assert.deepEqual(entryNames([make("simc"), make("simc")]), ["simc", "simc #2"]);
});

test("the circles are where |S| = Ms and |T| = Mt", () => {
  const [Ms, Mt] = [1.4, 1.6];
  const frame = nyquistFrame(drawnEntries({ controllers: [make("robust")] }, [0]), { Ms, Mt, Mks: null }, {});
  const circles = (frame.panes[0]!.marks ?? []).flatMap((mark) => (mark.kind === "circle" ? [mark] : []));
  assert.equal(circles.length, 2);
  for (const circle of circles) {
    for (const angle of [0, 1, 2.5]) {
      const [re, im] = [circle.x + circle.radius * Math.cos(angle), circle.y + circle.radius * Math.sin(angle)];
      const S = 1 / Math.hypot(1 + re, im);
      const expected = circle.label.startsWith("Ms") ? S / Ms : (S * Math.hypot(re, im)) / Mt;
      assert.ok(Math.abs(expected - 1) < 1e-12, circle.label);
    }
  }
  assert.equal(frame.equal, true);
});

test("a result without traces gives frames without lines, not a failure", () => {
  const drawn = drawnEntries({ controllers: [make("robust", { responses: undefined })] }, [0]);
  assert.equal(responseFrame("load", drawn, {}).panes[0]!.traces.length, 0);
  assert.equal(sensitivityFrame([], { Ms: null, Mt: null, Mks: null }, undefined).panes.length, 3);
});

test("the record is drawn with its model, and with its input where that is known", () => {
  const model = { plant: { type: "fopdt" }, fit_percent: 97, fit: { t: [0, 1], y: [0, 1], y_model: [0, 0.9] } };
  assert.equal(recordFrame(model, { record: { csv: "" } })!.panes.length, 1);
  assert.equal(recordFrame(model, { record: { u: [0, 1], y: [0, 1] } })!.panes.length, 2);
  assert.equal(recordFrame({ plant: { type: "fopdt" }, fit_percent: 97 }, {}), null);
});

test("the Bode plot shows two decades to both sides of the crossover and the margins where they are read", () => {
  const omega = Array.from({ length: 121 }, (_, i) => 1e-4 * 10 ** (i / 15));
  const loop = {
    omega,
    L: { re: omega.map(() => 0), im: omega.map((w) => -1 / w), phase_deg: omega.map((w) => -90 - 10 * w) },
    S_abs: omega,
    T_abs: omega,
    CS_abs: omega,
  };
  const robustness = { stable: true, gain_crossover: 1, phase_crossover: 9, phase_margin_deg: 80, gain_margin: 9 };
  const drawn = drawnEntries({ controllers: [make("robust", { frequency: loop, robustness } as Partial<Entry>)] }, [0]);
  const frame = bodeFrame(drawn, undefined);
  assert.deepEqual(frame.x.range, [0.01, 100]);
  const points = frame.panes.map((pane) => pane.marks!.find((mark) => mark.kind === "point"));
  assert.deepEqual(points.map((mark) => mark && "x" in mark && [mark.x, mark.y]), [[9, 1 / 9], [1, -100]]);
  const [lo, hi] = frame.panes[1]!.y.range!;
  assert.ok(lo >= -550 && hi <= -79);
});

test("a dead time's turns begin one turn after the gain crossover, where they stay small", () => {
  const omega = [...Array(300).keys()].map((k) => 0.1 * 1.03 ** k);
  const loop = (gain: (w: number) => number, L: number) => {
    const phase = omega.map((w) => -90 - (w * L * 180) / Math.PI);
    const at = (part: (radians: number) => number) => omega.map((w, k) => gain(w) * part((phase[k]! * Math.PI) / 180));
    return { ...frequency, omega, L: { re: at(Math.cos), im: at(Math.sin), phase_deg: phase } };
  };
  const dead = windingOf(loop((w) => 0.3 / w, 3))!;
  assert.ok(omega[dead.from]! > 2 && omega[dead.from]! < 3 && dead.radius < 0.15 && dead.radius > 0.1);
  assert.equal(windingOf(loop((w) => 0.3 / w, 0.01)), null);
  assert.equal(windingOf(loop((w) => Math.max(0.8, 0.3 / w), 3)), null);
  assert.equal(windingOf({ ...frequency, L: { re: [0], im: [1] } }), null);
});
