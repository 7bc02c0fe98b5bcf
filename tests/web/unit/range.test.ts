import type { RangeContent, ScheduleRow } from "../../../web/src/api/types.ts";
import assert from "node:assert/strict";
import test from "node:test";
import { isRangeRequest } from "../../../web/src/api/range.ts";
import type { RangeRequest } from "../../../web/src/api/range.ts";
import { passageFrame, plantFrame, robustnessFrame, settingsFrame } from "../../../web/src/charts/range.ts";
import { atSharedFields, plantText, readRange, textsOf } from "../../../web/src/range/request.ts";
import type { RangeTexts } from "../../../web/src/range/request.ts";
import {
  givenRequest,
  handleWords,
  keyedPlace,
  movedRow,
  reachOf,
  sameDesign,
} from "../../../web/src/range/schedule.ts";
import { formatRoute, parseRoute } from "../../../web/src/routes.ts";
import { unitNames } from "../../../web/src/words/numbers.ts";
import {
  placeWords,
  rangeWords,
  runFacts,
  settingWords,
  verdictOf,
  worstWords,
} from "../../../web/src/words/range.ts";

const units = unitNames({ time: "s", u: "%", y: "degC" });
const fopdt = (K: number, T: number, L: number) => ({ type: "fopdt", K, T, L });
const loads: RangeRequest = {
  name: "steam temperature",
  units: { time: "s", u: "%", y: "degC" },
  scheduling: { name: "load", unit: "%" },
  points: [
    { at: 30, plant: fopdt(4, 20, 4) },
    { at: 100, plant: fopdt(1, 8, 2) },
  ],
  schedule: { controller: "PI", interpolation: "linear_in_gains" },
};
const cone: RangeRequest = {
  plant: {
    type: "nonlinear",
    states: { h: 20 },
    equations: { h: "q-h" },
    input: { name: "q", nominal: 20 },
    output: "h",
  },
  range: { along: "parameter", parameter: "c", from: 10, to: 32, hold_output: false },
};
const noParts = {
  equations: { plant: cone.plant!, errors: [] },
  records: { record: {}, identify: { model: "auto" }, errors: [] },
};
const read = (texts: RangeTexts, parts = noParts) => readRange(texts, parts);

test("a request of points comes back from the form as it was; limits that it leaves out are the service's", () => {
  const { request, errors } = read(textsOf(loads));
  assert.deepEqual(errors, []);
  assert.deepEqual(request, {
    ...loads,
    schedule: { controller: "PI", interpolation: "linear_in_gains", allowance: 0.05 },
  });
});

test("a plant that is typed over is a text, one that is not stays as it came", () => {
  const set = { type: "set", plants: [fopdt(1, 2, 3), fopdt(2, 2, 3)] };
  const texts = textsOf({
    ...loads,
    points: [
      { at: 30, plant: set },
      { at: 100, plant: fopdt(1, 8, 2) },
    ],
  });
  texts.points[1]!.text = " 2 e^(-3s)/(12s+1) ";
  assert.deepEqual(read(texts).request.points, [
    { at: 30, plant: set },
    { at: 100, plant: "2 e^(-3s)/(12s+1)" },
  ]);
  assert.equal(plantText(fopdt(4, 20, 4)), "K=4 T=20 L=4");
  assert.equal(plantText(set), "");
  assert.equal(plantText({ ...fopdt(4, 20, 4), uncertainty: { K: [0.8, 1.2] } }), "");
});

test("what is missing or no number is said at its place", () => {
  const texts = textsOf(loads);
  texts.points[0] = { at: "x", text: "" };
  texts.terms.Ms = "calm";
  texts.terms.rows = "two";
  const pointers = read(texts).errors.map((error) => error.pointer);
  assert.deepEqual(pointers, ["/points/0/at", "/points/0/plant", "/schedule/Ms", "/schedule/rows"]);
  const way = textsOf(cone);
  way.way.parameter = "";
  way.way.to = "";
  assert.deepEqual(
    read(way).errors.map((error) => error.pointer),
    ["/range/parameter", "/range/to"],
  );
});

test("records are read in one way for all rows, and only with them limits hold over what they leave open", () => {
  const texts = textsOf({ ...loads, uncertainty: "identified" });
  assert.equal(read(texts).request.uncertainty, undefined);
  texts.points[0] = { at: "30", text: "", record: { csv: "t,u,y" }, file: "a.csv" };
  const parts = { ...noParts, records: { record: { time_unit: "min" }, identify: { model: "fopdt" }, errors: [] } };
  const { request } = read(texts, parts);
  assert.deepEqual(request.points![0], { at: 30, record: { csv: "t,u,y", time_unit: "min" } });
  assert.deepEqual([request.uncertainty, request.identify], ["identified", { model: "fopdt" }]);
  // The service's own default is not sent.
  texts.terms.identified = false;
  assert.equal(read(texts, parts).request.uncertainty, "none");
  assert.equal(textsOf(loads).terms.identified, true);
  assert.deepEqual(
    atSharedFields([
      { pointer: "/points/1/record/columns/u", detail: "No such column." },
      { pointer: "/points/1/record/csv", detail: "Empty." },
    ]),
    [
      { pointer: "/record/columns/u", detail: "Row 2: No such column." },
      { pointer: "/points/1/record/csv", detail: "Empty." },
    ],
  );
});

test("equations with their way, and parts without a field, come back", () => {
  const given = { ...cone, runs: false, schedule: { Ms: 1.6, aim: "mean", rows: 3, given: [] }, notify: { url: "x" } };
  const { request } = read(textsOf(given));
  assert.deepEqual(request.range, cone.range);
  assert.equal(request.points, undefined);
  assert.deepEqual(request.schedule, {
    aim: "mean",
    controller: "PID",
    Ms: 1.6,
    interpolation: "linear_in_gains",
    allowance: 0.05,
    rows: 3,
  });
  assert.equal("notify" in request || "runs" in request, false);
});

test("which jobs are about a range", () => {
  assert.ok(isRangeRequest(loads) && isRangeRequest(cone));
  assert.ok(!isRangeRequest({ plant: fopdt(1, 2, 3), tune: [] }) && !isRangeRequest(undefined));
});

const row = (at: number, Kp = 1): ScheduleRow => ({ at, Kp, Ti: 10, Td: 0, Tf: 0, b: 1 });
const extent = { from: 30, to: 100 };

test("a row moves between its neighbours, within the range, and keeps its settings", () => {
  const rows = [row(30), row(50, 2), row(100)];
  assert.deepEqual(movedRow(rows, 1, 61.23456, extent), [row(30), row(61.23, 2), row(100)]);
  assert.equal(movedRow(rows, 1, 5, extent)[1]!.at, 30.35);
  assert.equal(movedRow(rows, 0, 5, extent)[0]!.at, 30);
  assert.equal(movedRow(rows, 2, 500, extent)[2]!.at, 100);
  assert.deepEqual(reachOf(rows, 2, extent), [50.35, 100]);
});

test("keys move a handle by small and large steps and to its ends", () => {
  const at = (key: string, shift = false): number | null => keyedPlace(key, shift, 50, [31, 99], extent);
  assert.deepEqual(
    [at("ArrowRight"), at("ArrowLeft"), at("ArrowUp", true), at("PageDown")],
    [50.35, 49.65, 53.5, 46.5],
  );
  assert.deepEqual([at("Home"), at("End"), at("a")], [31, 99, null]);
});

const content: RangeContent = {
  scheduling: { name: "load", unit: "%", from: 30, to: 100 },
  stated: "Between the points logarithms are linear.",
  points: [
    { at: 30, plant: fopdt(4, 20, 4) },
    { at: 100, plant: fopdt(1, 8, 2) },
  ],
  one: {
    controller: { form: "ideal", Kp: 0.36, Ti: 11.5, Td: 0 },
    worst_relative_IAE: 7,
    mean_relative_IAE: 3,
    worst_at: 100,
    points: [],
  },
  schedule: {
    interpolation: "linear_in_gains",
    hysteresis: 0,
    rows: [row(30), row(100)],
    holds_limits: true,
    within_allowance: true,
    worst_relative_IAE: 1.03,
  },
  curves: {
    at: [30, 65, 100],
    K: [4, 2, 1],
    T: [20, 12, 8],
    L: [0, 0, 0],
    one: { Ms: [1.4, 1.2, 1.1], Mt: [1, 1, 1], relative_IAE: [1.03, 3, 7] },
    schedule: {
      Ms: [1.39, null, 1.4],
      Mt: [1, 1, 1],
      relative_IAE: [1.02, 1.03, 1.02],
      Kp: [0.4, 0.7, 1.3],
      Ti: [13, 9, 6],
      Td: [0, 0, 0],
    },
  },
  worst: { schedule: [{ quantity: "Ms", at: 100, value: 1.4, limit: 1.4 }] },
  warnings: [],
};

test("while a hand moves a row the schedule is given, records stand for the models that they gave", () => {
  const rows = [row(30), row(90)];
  const request: RangeRequest = {
    ...loads,
    points: [{ at: 30, record: { csv: "t,u,y" } }, loads.points![1]!],
    identify: { model: "auto" },
    uncertainty: "none",
    schedule: { Ms: 1.4, rows: 2 },
  };
  const asked = givenRequest(request, content, rows, { runs: false, quick: false });
  assert.deepEqual(asked.schedule, { Ms: 1.4, given: rows });
  assert.deepEqual(
    [asked.points![0], asked.identify, asked.runs],
    [{ at: 30, plant: fopdt(4, 20, 4) }, undefined, false],
  );
  // With regions the records themselves are used, but not during a drag.
  const region = { ...request, uncertainty: "identified" };
  assert.deepEqual(givenRequest(region, content, rows, { runs: false, quick: false }).points, request.points);
  const quick = givenRequest(region, content, rows, { runs: false, quick: true });
  assert.deepEqual([quick.points, quick.uncertainty], [asked.points, undefined]);
});

test("names and units leave a design as it is; plants and limits do not", () => {
  const schedule = { Ms: 1.4, Mt: 1.4 };
  const asked: RangeRequest = { ...loads, schedule };
  assert.ok(sameDesign(asked, { ...asked, name: "TIC-7", units: { time: "min" }, scheduling: { name: "flow" } }));
  assert.ok(sameDesign(asked, { ...asked, schedule: { ...schedule, given: [row(30)] } }));
  assert.ok(!sameDesign(asked, { ...asked, schedule: { ...schedule, Ms: 1.6 } }));
  assert.ok(!sameDesign(asked, { ...asked, points: [{ at: 30, plant: fopdt(4, 21, 4) }, loads.points![1]!] }));
});

test("the plots show the design with its limits, then the moved rows next to the one setting of the design", () => {
  const moved: RangeContent = { ...content, one: null, curves: { ...content.curves, at: [30, 50, 100], one: null } };
  const shown = { designed: content, moved: null, rows: content.schedule!.rows, Ms: 1.4, IAE: 1.05, units };
  const [Ms, IAE] = robustnessFrame(shown).panes;
  assert.deepEqual(
    Ms!.traces.map((trace) => trace.name),
    ["schedule", "one setting"],
  );
  assert.deepEqual(
    Ms!.marks!.map((mark) => mark.kind),
    ["upright", "upright", "level"],
  );
  assert.ok(IAE!.y.range![1] > 7);
  const after = robustnessFrame({ ...shown, moved }).panes[0]!.traces;
  assert.deepEqual(
    after.map((trace) => trace.x),
    [moved.curves.at, content.curves.at],
  );
  // A PI has no derivative time to draw, a plant without dead time no dead time.
  assert.deepEqual(
    settingsFrame(shown)!.panes.map((pane) => pane.y.label),
    ["Kp (%/°C)", "Ti (s)"],
  );
  assert.deepEqual(
    plantFrame(shown)!.panes.map((pane) => pane.y.label),
    ["K (°C/%)", "T (s)"],
  );
});

test("a run shows the target with y, or a parameter of its own; a run that ended early is shorter", () => {
  const run = {
    y: [1, 2],
    u: [1, 1],
    at: [1, 2],
    Kp: [1, 1],
    IAE: 1,
    largest_error: 1,
    largest_bump: 0,
    switches: 0,
    limited: false,
    settled: true,
  };
  const passage = { name: "step up", horizon: 2, t: [0, 1, 2], target: [2, 2, 2], schedule: run, one: null };
  const names = (parameter: string | null) =>
    passageFrame(passage, parameter, units).panes.map((pane) => pane.traces.map((trace) => trace.name));
  assert.deepEqual(names(null), [["schedule", "set point"], ["schedule"], ["schedule"]]);
  assert.deepEqual(names("c"), [["schedule"], ["c"], ["schedule"], ["schedule"]]);
  assert.deepEqual(passageFrame(passage, null, units).panes[0]!.traces[0]!.x, [0, 1]);
  // A nonlinear controller runs in addition; it has no gain to draw.
  const nonlinear = { y: [1, 2, 2], u: [1, 1, 1], tau: 3, IAE: 0.5, limited: false, settled: true };
  const beside = passageFrame({ ...passage, nonlinear }, null, units).panes.map((pane) => pane.traces.length);
  assert.deepEqual(beside, [3, 2, 1]);
  assert.deepEqual(runFacts(nonlinear, units)[0], ["IAE (°C s)", "0.500"]);
  assert.deepEqual(runFacts(nonlinear, units)[3], ["Switches", "–"]);
});

test("places, settings and verdicts in words", () => {
  assert.equal(placeWords(51.875, content.scheduling), "load 51.9 %");
  assert.equal(placeWords(20, { name: "at", from: 0, to: 1 }), "20");
  assert.equal(settingWords({ Kp: 0.4512345, Ti: 9.1, Td: 0 }, units), "Kp 0.45123, Ti 9.1 s");
  assert.deepEqual(worstWords(content.worst.schedule, content.scheduling), [
    "Ms is largest at load 100 %: 1.40, limit 1.40.",
  ]);
  assert.equal(
    handleWords(row(51.875, 0.553), 1, { designed: content, moved: null }),
    "Row 2 at load 51.875 %, Kp 0.553, largest Ms 1.40",
  );
  const verdict = { code: "schedule-holds", level: "good" as const, text: "These 2 rows hold.", figures: {} };
  assert.equal(verdictOf({ ...content, verdict }), verdict, "the service's, of rows that were moved too");
  const { verdict: _verdict, ...unjudged } = content;
  assert.match(verdictOf(unjudged).text, /older version/, "the page draws no conclusion of its own");
  const { schedule: _schedule, ...none } = unjudged;
  assert.equal(verdictOf(none).level, "bad");
  assert.equal(rangeWords(loads), "operating range over load (%): 2 points");
  assert.equal(rangeWords(cone), "operating range of equations, 10 to 32");
});

test("addresses of a range lead back to themselves", () => {
  for (const hash of ["#/range", "#/range/range-of-loads", "#/jobs/abc/range"])
    assert.equal(formatRoute(parseRoute(hash)), hash);
});
