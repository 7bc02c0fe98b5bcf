// Jobs in lists: short plants, ages, orders.
import assert from "node:assert/strict";
import test from "node:test";
import type { ListedJob } from "../../../web/src/api/job_lists.ts";
import { curlOf } from "../../../web/src/views/request_menu.ts";
import { age, BATCH_COLUMNS, gain, risk, shortPlant, sorted } from "../../../web/src/words/job_list.ts";

const job = (id: string, outline: ListedJob["outline"]): ListedJob => ({
  id,
  name: id,
  status: "succeeded",
  created_at: "2026-01-01T00:00:00Z",
  ...(outline ? { outline } : {}),
});

test("plants of few parameters are a formula, others their kind", () => {
  const short = (plant: { type: string } & Record<string, unknown>): string => shortPlant({ plant });
  assert.equal(short({ type: "fopdt", K: 2, T: 10, L: 3 }), "2 e^(−3s)/(10s + 1)");
  assert.equal(short({ type: "fopdt", K: -2, T: 1, L: 0 }), "−2/(s + 1)");
  assert.equal(short({ type: "fopdt", K: 2, T: 0, L: 1 }), "2 e^(−s)");
  assert.equal(short({ type: "sopdt", K: 1, T1: 3, T2: 2, L: 1 }), "1 e^(−s)/((3s + 1)(2s + 1))");
  assert.equal(short({ type: "ipdt", K: 0.1, L: 2 }), "0.1 e^(−2s)/s");
  assert.equal(short({ type: "ipdt", K: 0.1, L: 2, T: 4 }), "0.1 e^(−2s)/(s(4s + 1))");
  assert.equal(short({ type: "state_space" }), "state space");
  // A list says of equations that they are some; how many states is not known from it.
  assert.equal(short({ type: "nonlinear" }), "nonlinear plant");
  assert.equal(short({ type: "nonlinear", states: { h: "u - h" }, L: 2 }), "1 state, from u to y, L 2 s");
});

test("ages in one unit", () => {
  const now = Date.parse("2026-01-03T00:00:00Z");
  assert.equal(age("2026-01-02T23:59:30Z", now), "now");
  assert.equal(age("2026-01-02T23:55:00Z", now), "5 min");
  assert.equal(age("2026-01-02T21:00:00Z", now), "3 h");
  assert.equal(age("2026-01-01T00:00:00Z", now), "2 d");
});

test("gain is what falls of today's load IAE; risk is the worst Ms, none of it the greatest", () => {
  const better = job("better", { method: "simc", load_IAE: 5, Ms: 1.5, today: { load_IAE: 20 } });
  const worst = job("worst", { method: "simc", load_IAE: 8, Ms: 1.4, worst_Ms: 8 });
  const lost = job("lost", { method: "simc", load_IAE: 1, Ms: 1.2, worst_Ms: null });
  const failed: ListedJob = { ...job("failed", { error: "No." }), status: "failed" };
  assert.equal(gain(better), 75);
  assert.equal(gain(worst), null);
  const column = BATCH_COLUMNS.find(({ id }) => id === "risk")!;
  assert.equal(risk(failed), null);
  assert.equal(column.text(lost), "no margin");
  const order = sorted([better, failed, worst, lost], column, true).map(({ id }) => id);
  assert.deepEqual(order, ["lost", "worst", "better", "failed"]);
  assert.deepEqual(
    sorted([failed, better], column, false).map(({ id }) => id),
    ["better", "failed"],
  );
});

test("a call that a shell takes apart as it was put together", () => {
  assert.equal(
    curlOf("http://h/v1/jobs", { name: "Jim's" }),
    `curl -s -H 'Content-Type: application/json' -H 'Prefer: wait=20' 'http://h/v1/jobs' -d '{"name":"Jim'\\''s"}'`,
  );
});
