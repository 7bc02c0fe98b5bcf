import assert from "node:assert/strict";
import test from "node:test";
import type { Emulation, Entry, Result, TuningRequest } from "../../../../web/src/api/types.ts";
import { drawnEntries } from "../../../../web/src/charts/drawn.ts";
import { costOf, emulationFrame } from "../../../../web/src/charts/emulation.ts";
import { hasLinear, responseFrame } from "../../../../web/src/charts/responses.ts";
import { frameToCsv, frameToSvg } from "../../../../web/src/plot/export.ts";
import { wholeView } from "../../../../web/src/plot/layout.ts";
import {
  boundWords,
  emulationFacts,
  flatnessWords,
  levelRows,
  scenarioNotes,
  scenarioWords,
  targetWords,
} from "../../../../web/src/words/emulation.ts";
import { rootsOf, rootWords, transferFunction } from "../../../../web/src/words/linear_model.ts";

const units = { time: "min", u: "K", y: "K" };
const plant = {
  type: "nonlinear",
  input: { name: "Tj", nominal: 494, min: 300, max: 545 },
};
const emulation: Emulation = {
  formulation: "full",
  J: 13.14,
  J_y: 0.3,
  J_u: 12.84,
  weights: { wy: 1, wu: 1 },
  horizon: 2,
  active_bounds: [{ parameter: "Ti", bound: "low", value: 0.19 }],
  bounds: { Kp: [0.1, 15], Ti: [0.19, 3] },
  flatness: { Kp: 0.3246, Ti: 0.01654 },
  flatness_alone: { Kp: 0.1968, Ti: 0.010026 },
  relative_degree: 1,
  zero_dynamics_stable: true,
  zeros: [-1.9218],
  target: { beta: [1, 0.25] },
  level1: [
    {
      method: "imc",
      title: "IMC",
      test: "step",
      controller: { form: "ideal", Kp: 1.78, Ti: 0.396, Td: 0 },
      J: 800,
      y: [399, 402],
      u: [500, 520],
    },
    { method: "cohen_coon", test: "step", controller: null, error: "There is no dead time.", J: null },
  ],
  scenarios: [
    {
      setpoint_step: 10,
      y_rest: 399,
      u_rest: 494,
      t: [0, 2],
      y_nl: [399, 409],
      u_nl: [534, 539],
      y: [399, 408],
      u: [540, 538],
    },
    {
      setpoint_step: -10,
      y_rest: 399,
      u_rest: 494,
      t: [0, 2],
      y_nl: [399, 389],
      u_nl: [454, 449],
      y: [399, 390],
      u: [450, 452],
    },
  ],
};
const entry: Entry = {
  method: "emulation",
  controller: { form: "ideal", Kp: 4.79, Ti: 0.19, Td: null, filter: { type: "derivative", Tf: 0.1 } },
  emulation,
};

test("both levels stand in one table, refusals with their reason", () => {
  const rows = levelRows(entry);
  assert.deepEqual(
    rows.map((row) => [row.title, row.origin, row.settings.Kp, row.J, row.why, row.drawable]),
    [
      ["IMC", "on a simulated step test", 1.78, 800, "", true],
      ["cohen coon", "on a simulated step test", undefined, null, "There is no dead time.", false],
      ["Emulation", "minimum of J within the bounds", 4.79, 13.14, "", true],
    ],
  );
  assert.equal(boundWords(emulation, "Ti"), "at its lower bound");
  assert.equal(boundWords(emulation, "Kp"), "");
  assert.deepEqual(levelRows({ method: "robust" }), []);
});

test("the optimum's flatness names only what was sought", () => {
  assert.equal(
    flatnessWords(emulation),
    "Kp may move by ±0.325, Ti by ±0.0165 before J grows by 5 %, with the others re-optimised; alone Kp by ±0.197, Ti by ±0.0100.",
  );
  assert.equal(flatnessWords({ J: 1, flatness: { Kp: null, why_null: { Kp: "flat" } } }), "");
});

test("facts say J with its parts, the target and the zero dynamics", () => {
  const facts = Object.fromEntries(emulationFacts(emulation, units));
  assert.equal(facts["J"], "13.14 = 1 × 0.300 of y + 1 × 12.8 of u");
  const least = { J: 49, J_y: null, J_u: 49, why_null: { J_y: "Remark 6 leaves the output out." } };
  assert.deepEqual(emulationFacts(least, units), [
    ["J", "49.00 = 1 × 49.0 of u"],
    ["y in J", "Remark 6 leaves the output out."],
  ]);
  assert.equal(facts["Target"], "0.25 y′ + y = set point");
  assert.equal(facts["Zero dynamics"], "stable; zeros −1.922");
  assert.equal(targetWords([1, 0.42, 0.04]), "0.04 y″ + 0.42 y′ + y = set point");
  const unstable = Object.fromEntries(emulationFacts({ J: 1, zero_dynamics_stable: false }, units));
  assert.match(unstable["Zero dynamics"]!, /^unstable/);
});

test("a scenario is named by all that makes it one", () => {
  assert.equal(
    scenarioWords({ ...emulation.scenarios![1]!, initial: { T: 380 }, parameters: { k0: 5e8 } }),
    "set point −10, T from 380, k0 500000000",
  );
});

test("a scenario says what limits or ends it, settings why their run ended", () => {
  const scenario = emulation.scenarios![0]!;
  assert.equal(scenarioNotes(scenario), "");
  assert.match(
    scenarioNotes({ ...scenario, limited: true, ended: "T is below 0." }),
    /clips .* ends early: T is below 0\./,
  );
  const ended = { ...emulation, level1: [{ ...emulation.level1![0]!, J: null, ended: "h fell below 0." }] };
  assert.equal(levelRows({ ...entry, emulation: ended })[0]!.why, "h fell below 0.");
});

test("the cost of a run is the criterion's over its samples", () => {
  const scenario = { ...emulation.scenarios![0]!, t: [0, 1, 2], y_nl: [0, 1, 1], u_nl: [4, 4, 4] };
  const run = { t: [0, 2], y: [0, 1], u: [4, 6] };
  // Squares at 0, 1, 2: 0, 0.25, 0 of y and 0, 1, 4 of u.
  const cost = costOf({ J: 1, weights: { wy: 2, wu: 10 } }, scenario, run)!;
  assert.ok(Math.abs(cost - (2 * 0.25 + 10 * (0.5 * (0 + 1) + 0.5 * (1 + 4)))) < 1e-12);
  assert.equal(costOf({ J: 1 }, scenario, { ...run, y: [0, null] }), null);
});

test("the chart has the PID, the nonlinear controller and chosen settings; classical ones in the first scenario only", () => {
  const chosen = [{ index: 0, name: "IMC" }];
  const frame = emulationFrame(emulation, 0, chosen, plant, units)!;
  assert.deepEqual(
    frame.panes.map((pane) => pane.traces.map((trace) => trace.name)),
    [
      ["PID", "nonlinear controller", "IMC"],
      ["PID", "nonlinear controller", "IMC"],
    ],
  );
  assert.deepEqual(frame.panes[0]!.marks, [{ kind: "level", value: 409, role: "setpoint", label: "set point" }]);
  // The input approaches its upper limit; the lower one is far away.
  assert.deepEqual(frame.panes[1]!.marks, [{ kind: "level", value: 545, role: "limit" }]);
  assert.equal(emulationFrame(emulation, 1, chosen, plant, units)!.panes[0]!.traces.length, 2);
  assert.equal(emulationFrame({ J: null }, 0, [], plant, units), null);
  const alone = emulationFrame({ J: 1, t: [0, 1], y_nl: [1, 2], u_nl: [3, 4] }, 0, [], undefined, units)!;
  assert.deepEqual(alone.panes[0]!.marks, []);
  assert.equal(alone.panes[0]!.traces.length, 1);
});

const response = { t: [0, 1], y: [0, 1], u: [2, 1] };
const nonlinear = (method: string): Entry => ({
  method,
  responses: { setpoint: response, load: response },
  linear: { responses: { setpoint: { ...response, y: [0, 0.9] }, load: response } },
});

test("a nonlinear plant's responses are drawn with the linear model's, thin, where they do not crowd", () => {
  const two: Result = { controllers: [nonlinear("emulation"), nonlinear("robust")] };
  const frame = responseFrame("setpoint", drawnEntries(two, [0, 1]), undefined);
  assert.deepEqual(
    frame.panes[0]!.traces.map((trace) => [trace.name, trace.look, trace.thin ?? false]),
    [
      ["emulation", 1, false],
      ["emulation, linear model", 1, true],
      ["robust", 2, false],
      ["robust, linear model", 2, true],
    ],
  );
  const three: Result = { controllers: [...two.controllers, nonlinear("imc")] };
  const many = responseFrame("load", drawnEntries(three, [0, 1, 2]), undefined, 1);
  assert.deepEqual(
    many.panes[0]!.traces.map((trace) => trace.name),
    ["emulation", "robust", "robust, linear model", "imc"],
  );
  assert.ok(hasLinear(drawnEntries(two, [0])));
  assert.ok(!hasLinear(drawnEntries({ controllers: [{ method: "simc", responses: {} }] }, [0])));
});

test("exports carry the linear model's lines under their own name and look", () => {
  const one: Result = { controllers: [nonlinear("emulation")] };
  const frame = responseFrame("setpoint", drawnEntries(one, [0]), undefined);
  assert.match(frameToCsv(frame), /"emulation, linear model",y,1,0\.9/);
  const svg = frameToSvg(frame, wholeView(frame), 480, 300, () => "#000000");
  assert.match(svg, /emulation, linear model<\/text>/);
  assert.match(svg, /stroke-dasharray="1 3"/);
});

test("limits of a nonlinear plant's input are drawn as deviations where u comes near them", () => {
  const request: TuningRequest = { plant: { type: "nonlinear", input: { name: "q", nominal: 5, min: -95, max: 7.2 } } };
  const frame = responseFrame("setpoint", drawnEntries({ controllers: [nonlinear("robust")] }, [0]), request);
  const levels = frame.panes[1]!.marks!.map((mark) => (mark.kind === "level" ? mark.value : null));
  assert.equal(levels.length, 1);
  assert.ok(Math.abs(levels[0]! - 2.2) < 1e-12);
});

test("the linear model is read as a transfer function with poles and zeros", () => {
  const A = [
    [-1.9218572983488496, -0.024107735705294824],
    [-184.3714596697699, -6.821547141058964],
  ];
  // Reference values: reactor of Mhaskar, El-Farra and Christofides (2004), linearised around its steady state.
  const T = transferFunction({ type: "state_space", A, B: [0, 1], C: [0, 1], L: 0 })!;
  assert.equal(T.num[0], 1);
  assert.ok(Math.abs(T.num[1]! - 1.9218572983488496) < 1e-12);
  assert.ok(Math.abs(T.den[1]! - 8.743404439407813) < 1e-12 && Math.abs(T.den[2]! - 8.665261737756662) < 1e-12);
  const CA = transferFunction({ type: "state_space", A, B: [[0], [1]], C: [[1, 0]] })!;
  assert.deepEqual(CA.num, [-0.024107735705294824]);
  const poles = rootsOf(T.den);
  assert.ok(Math.abs(poles[0]![0] + 1.1395947709937921) < 1e-10 && Math.abs(poles[1]![0] + 7.603809668414021) < 1e-10);
  assert.equal(rootWords(poles), "−1.14, −7.604");
  assert.equal(rootWords(rootsOf([1, 2, 5])), "−1 ± 2i");
  assert.equal(rootWords(rootsOf([1, 0, 0])), "0, 0");
  assert.equal(rootWords(rootsOf([3])), "none");
  assert.equal(transferFunction({ type: "fopdt", K: 1, T: 1, L: 0 }), null);
});
