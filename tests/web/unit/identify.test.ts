import assert from "node:assert/strict";
import { formatError } from "../../../web/src/words/numbers.ts";
import test from "node:test";
import { withTraces } from "../../../web/src/api/plants.ts";
import type { Candidate, IdentifyRequest, Model, Preview, TuningRequest } from "../../../web/src/api/types.ts";
import { bareRecordFrame, identifiedFrame } from "../../../web/src/charts/identified.ts";
import { held } from "../../../web/src/charts/record.ts";
import { columnChoices, csvOf, samplesOf } from "../../../web/src/form/record_fields.ts";
import { formWords, timeWords } from "../../../web/src/form/record_preview.ts";
import { stepParts } from "../../../web/src/charts/record.ts";
import { serviceChoice, structureOf, tuneSubject } from "../../../web/src/form/tuning_request.ts";
import { readTest } from "../../../web/src/current_record.ts";
import { parameterTexts } from "../../../web/src/views/cards/candidates_card.ts";
import { cycleRows } from "../../../web/src/words/cycle.ts";
import { formatUncertain, unitNames } from "../../../web/src/words/numbers.ts";
import { structureTitle } from "../../../web/src/words/plant.ts";
import { qualityOf } from "../../../web/src/words/quality.ts";

const units = unitNames({ time: "s", u: "%", y: "degC" });
const fopdt: Candidate = {
  plant: { type: "fopdt", K: 1.25, T: 40, L: 8 },
  fit_percent: 97.2,
  standard_errors: { K: 0.012, T: 0.31, L: 0.22 },
  y_model: [0, 0.5, 1],
};
const ipdt: Candidate = { plant: { type: "ipdt", K: 0.03, L: 7, T: 0 }, fit_percent: 81, y_model: [0, 0.8, 2] };
const model: Model = {
  plant: fopdt.plant,
  fit_percent: 97.2,
  candidates: [fopdt, ipdt],
  fit: { t: [0, 1, 2], u: [0, 5, 5], y: [0, 0.6, 1], y_model: [0, 0.5, 1] },
  data_quality: {
    samples: 3,
    samples_dropped: 2,
    sample_time: 1,
    irregular: false,
    noise_std: 0.01,
    quantisation: 0,
    steps: 1,
    move_times: [1],
    settled: true,
  },
  warnings: [],
};
const request: IdentifyRequest = { units: {}, record: { csv: "t,u,y\n" }, identify: { model: "auto" } };

test("the frame has y over u over the residual of the candidate that is chosen", () => {
  const frame = identifiedFrame(model, ipdt, units, null, null)!;
  assert.deepEqual(
    frame.panes.map((pane) => pane.y.label),
    ["y (°C)", "u (%)", "y − model (°C)"],
  );
  assert.deepEqual(frame.panes[0]!.traces[1]!.y, ipdt.y_model);
  assert.deepEqual(
    frame.panes[2]!.traces[0]!.y.map((value) => Number(value!.toFixed(9))),
    [0, -0.2, -1],
  );
  assert.match(frame.description, /81\.0 %/);
});

test("with a part chosen the whole record stays in sight and the part is marked in every pane", () => {
  const whole = { t: [0, 1, 2, 3, 4], y: [0, 0.6, 1, 7, 7], u: [0, 5, 5, 5, 5] };
  const frame = identifiedFrame(model, fopdt, units, whole, { from: 0, to: 2 })!;
  assert.equal(frame.panes[0]!.traces[0]!.x.length, 5);
  assert.equal(frame.panes[0]!.traces[1]!.x.length, 3);
  for (const pane of frame.panes) assert.equal(pane.marks!.filter((mark) => mark.kind === "band").length, 1);
});

test("a record without a model is drawn alone, with the part that was chosen", () => {
  const frame = bareRecordFrame({ t: [0, 1], y: [1, 2], u: [0, 0] }, units, { from: 0.5, to: 1 });
  assert.deepEqual(
    frame.panes.map((pane) => pane.traces.map((trace) => trace.name)),
    [["record"], ["u"]],
  );
  assert.ok(frame.panes.every((pane) => pane.marks!.length === 1));
});

test("figures of the record without words of their own have the units of the contract", () => {
  const data_quality = { u0: 5, u_limits: [0, 100], pretest: { duration: 12, drift: 0.1, at_rest: true } } as unknown as Model["data_quality"];
  assert.deepEqual(qualityOf({ ...model, data_quality }, units).rows, [
    ["U0 (%)", "5"],
    ["U limits (%)", "0 to 100"],
    ["Pretest duration (s)", "12"],
    ["Pretest drift (°C/s)", "0.1"],
    ["Pretest at rest", "yes"],
  ]);
});

test("a residual of rounding dust is drawn as nothing, not as a signal", () => {
  const exact: Model = { ...model, fit: { t: [0, 1, 2], y: [0, 0.6, 1], y_model: [1e-13, 0.6, 1] } };
  const frame = identifiedFrame(exact, null, units, null, null)!;
  assert.deepEqual(frame.panes.at(-1)!.y.range, [-1e-3, 1e-3]);
});

test("u is drawn with corners: it holds from its sample to the next", () => {
  assert.deepEqual(held([0, 1, 2], [0, 5, 5]), { x: [0, 1, 1, 2], y: [0, 0, 5, 5] });
});

test("the service's choice is tuned as its record, another structure as that model of the record", () => {
  assert.equal(serviceChoice(model), 0);
  assert.deepEqual(tuneSubject(request, model, fopdt), { record: request.record, identify: { model: "auto" } });
  assert.deepEqual(tuneSubject(request, model, ipdt), { record: request.record, identify: { model: "ipdt" } });
  assert.deepEqual(tuneSubject(request, model, null), { record: request.record, identify: { model: "auto" } });
});

test("a structure that occurs twice is tuned as the plant: its name would not tell which", () => {
  const unstable: Candidate = { plant: { type: "fopdt", K: -2, T: -30, L: 7 }, fit_percent: 90 };
  const both = { ...model, candidates: [fopdt, unstable] };
  assert.deepEqual(tuneSubject(request, both, unstable), { plant: unstable.plant });
  assert.equal(structureOf({ type: "ipdt", K: 1, T: 2 }), "ipdt_lag");
  assert.equal(structureOf({ type: "ipdt", K: 1, T: 0 }), "ipdt");
  assert.equal(structureOf({ type: "transfer_function" }), "sopdt_zero");
  assert.equal(structureTitle(unstable.plant), "unstable first order with dead time");
});

test("parameters carry their errors with as many digits as these allow", () => {
  assert.equal(formatUncertain(2.0001221, 0.000477), "2.00012 ± 0.00048");
  assert.equal(formatUncertain(-39.96, 0.31), "−39.96 ± 0.31");
  assert.equal(formatUncertain(1234, 45), "1234 ± 45");
  assert.equal(formatUncertain(1.25, null), "1.25");
  assert.equal(formatUncertain(40, 1.9e-9), "40");
  assert.equal(formatUncertain(0, 1.9e-9), "0 ± 1.9e−9");
  assert.deepEqual(parameterTexts(fopdt, units), ["K 1.250 ± 0.012 °C/%", "T 40.00 ± 0.31 s", "L 8.00 ± 0.22 s"]);
  assert.deepEqual(parameterTexts(ipdt, units), ["K 0.03 °C/%/s", "L 7 s"]);
});

test("a time that the service says not to be determined is said to be unknown, whatever its error", () => {
  assert.deepEqual(parameterTexts({ ...fopdt, undetermined: ["L"] }, units), [
    "K 1.250 ± 0.012 °C/%",
    "T 40.00 ± 0.31 s",
    "L 8 s, not determined by the record",
  ]);
});

test("an error beyond the value is no error of it: the record does not determine the parameter", () => {
  const loose: Candidate = { ...fopdt, plant: { type: "fopdt", K: 2, T: 40, L: 3.812 }, standard_errors: { K: 0.1, T: 40, L: 370 } };
  assert.deepEqual(parameterTexts(loose, units), ["K 2.00 ± 0.10 °C/%", "T 40 ± 40 s", "L 3.812 s, not determined by the record"]);
  const zero: Candidate = {
    plant: { type: "transfer_function", num: [698.8, 1.601], den: [78170, 616.2, 1], L: 30 },
    fit_percent: 98,
    standard_errors: { L: 0.25, K: 0.0025, a1: 2100, a2: 4.3e5, b: 17 },
  };
  assert.deepEqual(parameterTexts(zero, units).slice(1), [
    "K ± 0.0025",
    "a1, not determined by the record",
    "a2, not determined by the record",
    "b ± 17",
  ]);
  assert.deepEqual([formatError(370, 3.812), formatError(0.2, 3.812)], ["not determined", "0.20"]);
});

test("what the service concludes of a model is shown, whatever its figures are", () => {
  assert.equal(qualityOf(model, units).head, "Good enough.");
  const warnings = [{ code: "drift", detail: "y drifts." }];
  const warned = qualityOf({ ...model, grade: "usable", warnings }, units);
  assert.deepEqual([warned.level, warned.head], ["warn", "Usable with care: 1 warning."]);
  const noted = { ...model, data_quality: { ...model.data_quality, notes: ["a", "b"] } };
  assert.equal(qualityOf(noted, units).head, "Good enough, with 2 remarks.");
  const poor = qualityOf({ ...model, grade: "doubtful", fit_percent: 84 }, units);
  assert.deepEqual([poor.level, poor.head], ["bad", "A doubtful model: it explains 84.0 % of the record's movement."]);
  const biased = qualityOf({ ...model, grade: "doubtful", fit_percent: 84, warnings }, units);
  assert.match(biased.head, /^A doubtful model: .*; 1 warning\.$/);
  const other = qualityOf({ ...model, grade: "doubtful", grade_reason: "warning", fit_percent: 99, warnings }, units);
  assert.equal(other.head, "A doubtful model: 1 warning.", "what explains its record is not said to explain too little");
  assert.equal(qualityOf({ ...model, grade: "good", fit_percent: 46 }, units).level, "good");
});

test("a record in automatic is named by what was stepped in it", () => {
  const data_quality = {
    ...model.data_quality,
    kind: "several_steps",
    test: "one step of the set point, in automatic",
    steps: 19,
    closed_loop: { evidence: "", used: "set_point", share: 0.9, set_point_moves: 1 },
  };
  const words = qualityOf({ ...model, data_quality }, units);
  assert.equal(Object.fromEntries(words.rows)["Test"], "one step of the set point, in automatic");
  assert.match(words.input, /^One step of the set point, in automatic: the controller moved u from 0 to 5 %\.$/);
  assert.doesNotMatch(JSON.stringify(words.rows), /several.steps/);
});

test("the record is described by its figures, and by those that this page does not know by their names", () => {
  const data_quality = {
    ...model.data_quality,
    drift: 0.02,
    saturated: false,
    gaps: ["3 s at 120 s"],
    relay: { cycles: 9 },
  };
  const words = qualityOf({ ...model, data_quality }, units);
  assert.equal(words.input, "u steps once, at 1 s, from 0 to 5 %.");
  assert.deepEqual(Object.fromEntries(words.rows), {
    Samples: "3, 2 left out",
    "Moves of u": "1",
    "Spacing (s)": "1",
    "Noise of y (°C)": "0.010, 1.0 %",
    "Smallest step of y (°C)": "none found",
    "y came to rest": "yes",
    Drift: "0.02",
    Saturated: "no",
    Gaps: "3 s at 120 s",
    "Relay cycles": "9",
  });
});

test("a limit cycle is given with the plant's ultimate point and the describing function's", () => {
  const cycle = { Pu: 14.391, Au: 0.22326, phi_u: -2.21885, periods: 9, describing_function: { Ku: 3.9, Pu: 14.391 } };
  const rows = cycleRows(cycle, { Ku: 8.1, Pu: 7.7 }, units);
  assert.deepEqual(
    rows.map((row) => `${row.label} ${row.text}`),
    [
      "Pu (s) 14.391",
      "Au (°C/%) 0.2233",
      "φu (rad) −2.219",
      "Periods 9",
      "Ku (%/°C) 8.100",
      "Pu at Ku (s) 7.700",
      "Ku, estimated (%/°C) 3.900",
    ],
  );
  assert.match(rows[2]!.meaning, /−127°/);
});

test("records given as numbers and as text are distinguished by their samples alone", () => {
  const arrays = { dt: 2, u: [0, 1], y: [5, 6], kind: "relay", u0: 0, from: 1 };
  assert.deepEqual(samplesOf(arrays), { dt: 2, u: [0, 1], y: [5, 6] });
  assert.equal(csvOf(arrays), "t,u,y\n0,0,5\n2,1,6");
  assert.deepEqual(samplesOf({ csv: "x", columns: { t: 1 } }), { csv: "x" });
  const controlled = { ...arrays, r: [7, 8] };
  assert.deepEqual(samplesOf(controlled).r, [7, 8]);
  assert.equal(csvOf(controlled), "t,u,y,r\n0,0,5,7\n2,1,6,8");
  const switched = { ...arrays, mode: ["AUTO", "MAN"] };
  assert.deepEqual(samplesOf(switched).mode, ["AUTO", "MAN"]);
  assert.equal(csvOf(switched), "t,u,y,mode\n0,0,5,AUTO\n2,1,6,MAN");
});

test("the page asks for the traces of a record's models and of nothing else", () => {
  const record = { csv: "t,u,y\n" };
  assert.deepEqual(withTraces({ record, identify: { model: "fopdt" } }), {
    record,
    identify: { model: "fopdt", traces: true },
  });
  const plant = { plant: { type: "fopdt", K: 1, T: 1, L: 1 } };
  assert.deepEqual(withTraces(plant as TuningRequest), plant);
});

const previewed: Preview = {
  columns: ["Time", "", "PV", "PV", "4"].map((heading) => ({
    heading,
    guess: "-",
    confidence: 0,
    unit: "",
    first: "20,5",
    thumbnail: [],
  })),
  rows: 1200,
  separator: "tab",
  decimal: ",",
  encoding: "windows-1252",
  time: { unit: "s", assumed: true, from: 0, to: 599.5, dt: 0.5, gaps: 1, duplicates: 2 },
  skipped: [],
  skipped_lines: 0,
  runs: [],
  notes: [],
  problems: [],
};

test("columns are chosen by their headings, by their numbers where these say nothing or two things", () => {
  assert.deepEqual(
    columnChoices(previewed).map(([value]) => value),
    ["Time", "2", "3", "4", "5"],
  );
});

test("a preview says how the file is written and what its times are", () => {
  assert.equal(formWords(previewed), "1200 rows, columns separated by tabs, decimal comma, WINDOWS-1252.");
  assert.match(timeWords(previewed), /^One row every 0\.5 s, over 599\.5 s, 1 gap, 2 duplicate time stamps\. The file does not say/);
  assert.equal(timeWords({ ...previewed, time: undefined } as unknown as Preview), "");
});

test("each move of u that the service names has the part of the record that shows it alone", () => {
  const t = Array.from({ length: 100 }, (_, index) => index);
  assert.deepEqual(stepParts(t, [20, 60]), [
    { at: 20, from: 10, to: 59 },
    { at: 60, from: 40, to: 99 },
  ]);
  assert.deepEqual(stepParts(t, []), []);
});

test("what u does is said as the service counts its moves: jitter is none, whatever the samples show", () => {
  const fit = { t: [0, 1, 2, 3], u: [0, 0.01, 5, 5.01], y: [0, 0, 1, 2], y_model: [0, 0, 1, 2] };
  const words = (more: Partial<NonNullable<Model["data_quality"]>>): string =>
    qualityOf({ ...model, fit, data_quality: { ...model.data_quality!, ...more } }, units).input;
  assert.equal(words({ steps: 1, move_times: [2] }), "u steps once, at 2 s, from 0 to 5.01 %.");
  assert.equal(words({ steps: 40, move_times: Array.from({ length: 20 }, (_, at) => at) }), "u changes 40 times, from 0 to 5.01 %.");
  assert.equal(words({ steps: 0, move_times: [] }), "u is constant at 0 % from the first sample on.");
  assert.equal(words({ steps: 1, move_times: [0] }), "u is constant at 0 % from the first sample on.", "it moved before the record");
  const { move_times: _times, ...kept } = model.data_quality!;
  assert.equal(qualityOf({ ...model, fit, data_quality: kept as typeof model.data_quality }, units).input, "u steps once, from 0 to 5.01 %.");
});

test("what the tab's storage holds is a record, or is passed over", () => {
  const test: IdentifyRequest = { name: "TIC-9", record: { csv: "t,u,y" } };
  assert.deepEqual(readTest(JSON.parse(JSON.stringify(test))), test);
  const others = [null, 3, "t,u,y", {}, { record: null }, { record: "t,u,y" }];
  for (const other of others) assert.equal(readTest(other), null);
});

test("an error that no digit of the value shows is told as exact", () => {
  assert.equal(formatError(1.9e-9, 40), "exact");
  assert.equal(formatError(0, 40), "exact");
  assert.equal(formatError(0.5, 40), "0.50");
  assert.equal(formatError(undefined, 40), "–");
});
