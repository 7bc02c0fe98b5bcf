// Jobs in lists: short plants, ages, orders.
import assert from "node:assert/strict";
import test from "node:test";
import type { ListedJob } from "../../../web/src/api/types.ts";
import { curlOf } from "../../../web/src/views/request_menu.ts";
import { age, batchColumns, gain, risk, shortPlant, sorted } from "../../../web/src/words/job_list.ts";

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
  // For equations a list contains only their kind; the number of states is not known from it.
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
  const column = batchColumns([better, lost]).find(({ id }) => id === "risk")!;
  assert.equal(risk(failed), null);
  assert.equal(column.text(lost), "no margin");
  const order = sorted([better, failed, worst, lost], column, true).map(({ id }) => id);
  assert.deepEqual(order, ["lost", "worst", "better", "failed"]);
  assert.deepEqual(
    sorted([failed, better], column, false).map(({ id }) => id),
    ["better", "failed"],
  );
});

const pid = (Kp: number, Ti: number) => ({ form: "ideal", Kp, Ti, Td: 0, b: 0.5 });

test("a batch's columns are the settings with their units, and none of dashes alone", () => {
  const units = { time: "min", u: "%", y: "degC" };
  const loops = [
    job("a", { method: "simc", controller: pid(2, 10), units, load_IAE: 5, Ms: 1.5 }),
    job("b", { method: "simc", controller: pid(0.123456, 20), units, load_IAE: 8, Ms: 1.6 }),
  ];
  const columns = batchColumns(loops);
  const labels = columns.map(({ label }) => label);
  for (const label of ["Kp (%/°C)", "Ti (min)", "b", "Load IAE (°C min)"]) assert.ok(labels.includes(label), label);
  // No derivative, no filter, no today's settings, no optimum: no columns for them.
  for (const label of ["Td (min)", "Tf (min)", "Gain over today", "Above optimum", "Set-point filter (min)"])
    assert.ok(!labels.includes(label), label);
  const Kp = columns.find(({ id }) => id === "Kp")!;
  assert.deepEqual(loops.map(Kp.text), ["2", "0.12346"]);
  for (const column of columns) assert.ok(loops.some((loop) => column.text(loop) !== "–"), column.label);
});

test("units that differ from loop to loop stand in the cells", () => {
  const loops = ["s", "min"].map((time) => job(time, { method: "simc", controller: pid(1, 10), units: { time } }));
  const Ti = batchColumns(loops).find(({ id }) => id === "Ti")!;
  assert.equal(Ti.label, "Ti");
  assert.deepEqual(loops.map(Ti.text), ["10 s", "10 min"]);
  const tuned = loops.map((loop) => ({ ...loop, outline: { ...loop.outline, load_IAE: 5 } }) as ListedJob);
  const IAE = batchColumns(tuned).find(({ id }) => id === "iae")!;
  assert.deepEqual([IAE.label, ...tuned.map(IAE.text)], ["Load IAE", "5.00 s", "5.00 min"]);
});

test("for a product the columns are what is to be typed into it", () => {
  const to_type = { GAIN: "2.328 %/%", RESET: "93.12 s", STRUCTURE: "PID action on error" };
  const loops = [job("a", { method: "robust", controller: pid(2, 10), to_type }), job("failed", { error: "No." })];
  const columns = batchColumns(loops);
  const labels = columns.map(({ label }) => label);
  assert.deepEqual(labels.slice(labels.indexOf("GAIN"), labels.indexOf("GAIN") + 3), ["GAIN", "RESET", "STRUCTURE"]);
  assert.ok(!labels.includes("Kp"));
  const gainColumn = columns.find(({ label }) => label === "GAIN")!;
  assert.deepEqual([gainColumn.text(loops[0]!), gainColumn.value(loops[0]!)], ["2.328 %/%", 2.328]);
  assert.equal(gainColumn.text(loops[1]!), "–");
});

test("today's settings stand before the new ones, each with its unit; loops with and without a product share the table", () => {
  const units = { time: "min", u: "%", y: "degC" };
  const typed = (GAIN: string) => ({ GAIN: `${GAIN} %/%` });
  const loops = [
    job("a", { method: "simc", controller: pid(2, 10), units, today: { controller: pid(1, 12), Ms: 1.2, load_IAE: 9 } }),
    job("b", { method: "simc", controller: pid(3, 11), units, to_type: typed("4"), today: { controller: pid(1, 12), to_type: typed("2") } }),
  ];
  const columns = batchColumns(loops);
  const labels = columns.map(({ label }) => label);
  for (const pair of [["GAIN today", "GAIN"], ["Kp today (%/°C)", "Kp (%/°C)"], ["Ti today (min)", "Ti (min)"]])
    assert.deepEqual(labels.slice(labels.indexOf(pair[0]!), labels.indexOf(pair[0]!) + 2), pair);
  const cells = (label: string): string[] => loops.map(columns.find((column) => column.label === label)!.text);
  assert.deepEqual(cells("GAIN today"), ["–", "2 %/%"]);
  assert.deepEqual(cells("Kp today (%/°C)"), ["1", "–"]);
  for (const column of columns) assert.ok(loops.some((loop) => column.text(loop) !== "–"), column.label);
});

test("loops of several products have their settings as one text each", () => {
  const settings = (prefix: string) => Object.fromEntries([...Array(6).keys()].map((at) => [`${prefix}${at}`, String(at)]));
  const loops = ["A", "B"].map((name) => job(name, { method: "simc", controller: pid(2, 10), to_type: settings(name) }));
  const columns = batchColumns(loops);
  assert.deepEqual(columns.map(({ label }) => label).filter((label) => label.startsWith("Settings")), ["Settings"]);
  assert.equal(columns.find(({ label }) => label === "Settings")!.text(loops[1]!), "B0 0; B1 1; B2 2; B3 3; B4 4; B5 5");
});

test("a call that a shell takes apart as it was put together", () => {
  assert.equal(
    curlOf("http://h/v1/jobs", { name: "Jim's" }),
    `curl -s -H 'Content-Type: application/json' -H 'Prefer: wait=20' 'http://h/v1/jobs' -d '{"name":"Jim'\\''s"}'`,
  );
});
