// The form of a check and its request.
import assert from "node:assert/strict";
import test from "node:test";
import { isCheckRequest } from "../../../../web/src/api/check.ts";
import { examplePlant } from "../../../../web/src/check/example.ts";
import { kindOfTag, linesOf, loopOfFile, NO_LOOPS, readCheck, readFile, recordOf, textsOf } from "../../../../web/src/check/request.ts";
import { formatRoute, parseRoute, WHOLE_LIST } from "../../../../web/src/routes.ts";

const EMPTY = { name: "", cluster: true, reading: { columns: {}, timeUnit: "" }, loops: [], base: {} };
const CSV = "t,pv,op\n0,1,2\n";

test("the kind of a loop is read from its tag where that follows the standard", () => {
  const kinds = {
    "FIC-101": "flow", FC7: "flow", FFIC12: "flow", "2111FIC41004_1108": "flow", "U7.PIC3.PIDA": "pressure", PDIC4: "pressure",
    "LIC 30501": "level", lica12: "level", "TIC-101": "temperature", TRC9: "temperature", AIC90201: "composition",
    isdb_CHEM1: "unknown", "loop 3": "unknown", FI101: "unknown", CLIC4: "unknown", PAP2: "unknown", "": "unknown",
  };
  for (const [tag, kind] of Object.entries(kinds)) assert.equal(kindOfTag(tag), kind, tag);
});

test("a file becomes a loop with the name of the file as tag", () => {
  const loop = loopOfFile("FIC-101.day 3.csv", CSV);
  assert.equal(loop.tag, "FIC-101.day 3");
  assert.equal(loop.kind, "flow");
  const { request, errors } = readCheck({ ...EMPTY, loops: [loop] });
  assert.deepEqual(errors, []);
  assert.deepEqual(request.loops, [{ tag: "FIC-101.day 3", kind: "flow", csv: CSV }]);
  assert.ok(isCheckRequest(request));
});

test("only what was given is sent", () => {
  const loop = { ...loopOfFile("x.csv", CSV), low: "4", high: "20", weight: "1,5", averaging: true };
  const level = { ...loop, kind: "level" as const, tag: " LIC1 " };
  const reading = { columns: { y: "PV", u: "", t: "3" }, timeUnit: "min" };
  const { request } = readCheck({ ...EMPTY, name: " Unit 21 ", cluster: false, reading, loops: [loop, level] });
  const read = { csv: CSV, columns: { y: "PV", t: "3" }, time_unit: "min", range: { op: [4, 20] }, weight: 1.5 };
  assert.deepEqual(request.loops, [
    { tag: "x", ...read },
    { tag: "LIC1", kind: "level", averaging: true, ...read },
  ]);
  assert.equal(request.name, "Unit 21");
  assert.equal(request.cluster, false);
  assert.ok(!("cluster" in readCheck({ ...EMPTY, loops: [loop] }).request), "the service's default is not repeated");
});

test("units that all files name alike are the units of the check", () => {
  const unitsOf = (...given: (object | undefined)[]) =>
    readCheck({ ...EMPTY, loops: given.map((units, index) => ({ ...loopOfFile(`${index}.csv`, CSV), units: units as never })) }).request.units;
  assert.deepEqual(unitsOf({ y: "degC", u: "%" }), { y: "degC", u: "%" });
  assert.deepEqual(unitsOf({ y: "degC", u: "%" }, { y: "bar", u: "%" }), { u: "%" });
  assert.equal(unitsOf({ y: "degC", u: "" }, undefined), undefined);
  assert.equal(unitsOf({ y: "", u: "" }), undefined);
});

test("a request comes back from the form as it was, with members that no field shows", () => {
  const given = {
    name: "Unit 21",
    units: { time: "min" },
    timeout_s: 900,
    cluster: false,
    loops: [
      { tag: "A", kind: "level" as const, averaging: true, record: { t: [0, 1], y: [1, 2], u: [3, 4] }, start: "2026-05-04T06:00:00Z", range: { pv: [0, 9] as [number, number], op: [0, 50] as [number, number] }, weight: 2 },
      { tag: "B", csv: CSV, columns: { y: 2 }, time_unit: "h", controller: { form: "ideal", Kp: 1 } },
    ],
  };
  assert.deepEqual(readCheck(textsOf(given as never)), { request: given, errors: [] });
});

test("faults stand at their fields", () => {
  const loop = loopOfFile("a.csv", CSV);
  const faultsOf = (change: object) => readCheck({ ...EMPTY, loops: [loop, { ...loop, ...change }] }).errors;
  assert.deepEqual(faultsOf({ low: "0" }).map(({ pointer }) => pointer), ["/loops/1/range/op/high"]);
  assert.deepEqual(faultsOf({ low: "100", high: "0" }).map(({ pointer }) => pointer), ["/loops/1/range/op/high"]);
  assert.deepEqual(faultsOf({ low: "x", high: "1" }).map(({ pointer }) => pointer), ["/loops/1/range/op/low"]);
  assert.deepEqual(faultsOf({ weight: "-1" }).map(({ pointer }) => pointer), ["/loops/1/weight"]);
  assert.deepEqual(readCheck(EMPTY).errors, [{ pointer: "/loops", detail: NO_LOOPS }]);
});

test("loops that are too long for one request are lines of a batch, each with the terms of all", () => {
  const request = { name: "Unit 21", units: { time: "min" }, timeout_s: 900, loops: [{ tag: "A", csv: CSV }, { csv: CSV }] };
  const lines = linesOf(request);
  assert.ok(lines.every((line) => line.endsWith("\n") && line.indexOf("\n") === line.length - 1));
  assert.deepEqual(lines.map((line) => JSON.parse(line)), [
    { name: "A", units: { time: "min" }, timeout_s: 900, loops: [{ tag: "A", csv: CSV }] },
    { units: { time: "min" }, timeout_s: 900, loops: [{ csv: CSV }] },
  ]);
});

test("a file of several loops is sent as it is, and alone", () => {
  const plant = loopOfFile("plant.csv", CSV);
  assert.deepEqual(readFile({ ...EMPTY, reading: { columns: {}, timeUnit: "min" }, loops: [plant] }), {
    order: { kind: "file", csv: CSV, options: { name: "plant", "units.time": "min" } },
    errors: [],
  });
  assert.deepEqual(readFile({ ...EMPTY, name: "Unit 21", loops: [plant, plant] }).errors.map(({ pointer }) => pointer), ["/loops/0/tag"]);
});

test("a loop's record goes on to Identify as it was read", () => {
  assert.deepEqual(recordOf({ tag: "A", csv: CSV, columns: { y: 2 }, time_unit: "min", weight: 3 }), { csv: CSV, columns: { y: 2 }, time_unit: "min" });
  const record = { t: [0], y: [1], u: [2] };
  assert.equal(recordOf({ record }), record);
});

test("the address of a check holds the loop, the order and what is shown", () => {
  const of = { kind: "job" as const, id: "j1" };
  const whole = { screen: "check" as const, of: null, from: null, before: null, loop: null, other: null, list: WHOLE_LIST };
  for (const route of [
    whole,
    { ...whole, from: "j1" },
    { ...whole, of },
    { ...whole, of, loop: 12 },
    { ...whole, of, loop: 12, other: 0 },
    { ...whole, of: { kind: "batch" as const, id: "b1" }, loop: 3 },
    { ...whole, of: { kind: "batch" as const, id: "b2" }, before: "b1", list: { ...WHOLE_LIST, sort: "-error" } },
    { ...whole, of, loop: 0, list: { sort: "-gain", cause: "insufficient-data", owner: "control", text: "FIC 1" } },
  ])
    assert.deepEqual(parseRoute(formatRoute(route)), route);
  assert.equal(formatRoute({ ...whole, of, list: { ...WHOLE_LIST, sort: "-gain" } }), "#/jobs/j1/check?sort=-gain");
  assert.deepEqual(parseRoute("#/jobs/j1/check?loop=x"), { ...whole, of });
});

test("the example plant is the same every time: six loops with a common clock", () => {
  const plant = examplePlant();
  assert.deepEqual(plant, examplePlant());
  assert.equal(plant.loops.length, 6);
  for (const { tag, kind, csv, start } of plant.loops) {
    assert.equal(kind, kindOfTag(tag!));
    const lines = csv!.trim().split("\n");
    assert.equal(lines[0], "time [s],SP,PV,OP,MODE");
    assert.ok(lines.length > 1000);
    assert.ok(lines.slice(1).every((line) => /^\d+(,-?[\d.]+){3},AUTO$/.test(line)), tag);
    assert.equal(start, plant.loops[0]!.start);
  }
});
