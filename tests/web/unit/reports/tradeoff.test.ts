import assert from "node:assert/strict";
import test from "node:test";
import type { Tradeoff, TradeoffFigures } from "../../../../web/src/api/types.ts";
import { degradationFrame, isKnown, levelsFrame, tradeoffFrame, whyUnknown } from "../../../../web/src/charts/tradeoff.ts";

const figures = (J_r: number, J_d: number, Deg: number, Ms: number): TradeoffFigures => ({
  J_r,
  J_d,
  J_rd: 0.5,
  J_r_opt: 1.05,
  J_d_opt: 0.6,
  I_perf: 1 - Deg,
  Deg,
  Ms,
});
const profile: Tradeoff["profile"] = {
  by_Ms: [2, 1.7, 1.4].map((Ms, at) => ({ ...figures(1.1 + 0.2 * at, 0.8 + 0.3 * at, 0.2 * at, Ms), Ms_design: Ms })),
  by_degradation: [0, 0.25, 0.55].map((level, at) => ({
    ...figures(1.1 + 0.2 * at, 0.8 + 0.3 * at, level, 2.2 - 0.3 * at),
    degradation: level,
  })),
};
const item = { name: "today", tradeoff: { model: figures(1.5, 3, 0.6, 1.3), profile } };

test("the plane shows the rule's curves, the corner and the controller, all in view", () => {
  const frame = tradeoffFrame([item, { name: "other", tradeoff: { plant: figures(4, 0.7, 0.1, 2) } }], "s")!;
  const [pane] = frame.panes;
  assert.deepEqual(
    pane!.traces.map((trace) => [trace.name, trace.x.length, trace.parameter]),
    [
      ["rule over Ms", 3, [2, 1.7, 1.4]],
      ["rule over degradation", 3, [2.2, 1.9000000000000001, 1.6]],
    ],
  );
  const points = pane!.marks!.flatMap((mark) => (mark.kind === "point" ? [[mark.label, mark.x, mark.y]] : []));
  assert.deepEqual(points, [
    ["best of both", 1.05, 0.6],
    ["today", 1.5, 3],
    ["other", 4, 0.7],
  ]);
  const [x, y] = [frame.x.range!, pane!.y.range!];
  assert.ok(x[0] < 1.05 && x[1] > 4 && y[0] < 0.6 && y[1] > 3);
  assert.match(frame.description, /today: J_r 1\.50, J_d 3\.00\./);
});

test("degradation stands over the Ms that is reached, and every allowed level next to its result", () => {
  const frame = degradationFrame([item])!;
  assert.deepEqual(frame.panes[0]!.traces[0]!.x, [2, 1.7, 1.4]);
  assert.deepEqual(frame.panes[0]!.traces[1]!.y, [0, 0.25, 0.55]);
  const levels = levelsFrame([item], "s")!;
  assert.deepEqual(
    levels.panes.map((pane) => pane.y.label),
    ["Deg", "J_rd (s)", "Ms"],
  );
  assert.deepEqual(levels.panes[2]!.traces[0]!.x, [0, 0.25, 0.55]);
});

test("without a profile only the controllers are drawn; without figures nothing is", () => {
  const bare = { name: "a", tradeoff: { model: { ...figures(2, 1, 0.3, 1.5), J_d: null } } };
  assert.equal(degradationFrame([bare]), null);
  assert.equal(levelsFrame([bare], "s"), null);
  const frame = tradeoffFrame([bare], "s")!;
  assert.equal(frame.panes[0]!.traces.length, 0);
  assert.ok(!frame.panes[0]!.marks!.some((mark) => mark.kind === "point" && mark.label === "a"));
  assert.ok(frame.x.range!.every(Number.isFinite));
  assert.equal(tradeoffFrame([{ name: "a", tradeoff: undefined }], "s"), null);
});

test("where the service has no indices, its reason is shown instead of empty charts", () => {
  const none = { ...figures(0, 0, 0, 1.4), J_r: null, J_d: null, why_null: { J_r: "The plant integrates." } };
  const refused = { name: "a", tradeoff: { model: none, plant: none } };
  assert.ok(!isKnown(refused) && isKnown(item));
  assert.equal(whyUnknown(refused), "The plant integrates.");
  assert.equal(whyUnknown(item), "");
  assert.equal(whyUnknown({ name: "b", tradeoff: undefined }), "");
});
