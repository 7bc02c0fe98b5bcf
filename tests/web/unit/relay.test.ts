import assert from "node:assert/strict";
import test from "node:test";
import type { RelayAnswer } from "../../../web/src/api/types.ts";
import { relayFrame } from "../../../web/src/charts/relay.ts";
import { formatRoute, parseRoute } from "../../../web/src/routes.ts";
import { unitNames } from "../../../web/src/words/numbers.ts";
import { planSentences } from "../../../web/src/words/relay_plan.ts";

const units = unitNames({ time: "s", u: "%", y: "degC" });
const answer: RelayAnswer = {
  record: { kind: "relay", t: [0, 1, 2], u: [1, -1, -1], y: [0, 0.3, 0.1] },
  limit_cycle: { Pu: 14.391, Au: 0.22, phi_u: -2.2, periods: 5 },
};

test("the record is drawn with the relay's thresholds, and without any where it has no hysteresis", () => {
  const frame = relayFrame(answer, 0.2, units);
  assert.deepEqual(
    frame.panes[0]!.marks!.map((mark) => mark.kind === "level" && mark.value),
    [0.2, -0.2],
  );
  assert.deepEqual(frame.panes[1]!.traces[0]!.y, [1, 1, -1, -1]);
  assert.match(frame.description, /14\.39 s/);
  assert.deepEqual(relayFrame(answer, 0, units).panes[0]!.marks, []);
});

test("a plan is said in sentences with its figures and units", () => {
  const plan = {
    u_plus: 1.3,
    u_minus: -0.7,
    hysteresis: 0.2,
    amplitude: 0.31,
    expected_period: 14.391,
    cycles: 8,
    duration: 115.1,
    record_interval: 0.0719,
  };
  assert.deepEqual(planSentences(plan, units), [
    "Let the relay move u between +1.3 and −0.7 % around its operating point, switching when y leaves ±0.200 °C.",
    "Expect y to swing by ±0.310 °C with a period of 14.4 s.",
    "8 cycles take about 115 s.",
    "Record a sample every 0.0719 s or more often.",
  ]);
  assert.deepEqual(planSentences({}, units), []);
  assert.match(planSentences({ ...plan, hysteresis: 0 }, units)[0]!, /without hysteresis\.$/);
});

test("addresses of the new screens lead back to themselves", () => {
  for (const hash of ["#/identify", "#/relay", "#/relay/fopdt?K=1.25&T=40&L=8", "#/jobs/abc/identify"])
    assert.equal(formatRoute(parseRoute(hash)), hash);
});
