import assert from "node:assert/strict";
import test from "node:test";
import type { Entry, Finding, OwnStep, Result, TuningRequest } from "../../../../web/src/api/types.ts";
import { drawnEntries } from "../../../../web/src/charts/drawn.ts";
import { ownStepFrame } from "../../../../web/src/charts/own_step.ts";
import { proposedStep, readStep, sameStep, textsOf } from "../../../../web/src/form/own_step.ts";
import { formatRoute, parseRoute } from "../../../../web/src/routes.ts";
import { ownStepGroups, withStepFindings } from "../../../../web/src/words/own_step.ts";

const units = { time: "min", u: "%", y: "°C" };
const whole: OwnStep = {
  y: 20,
  u: 5,
  target: 200,
  u_min: 0,
  u_max: 100,
  ramp_rate: 2,
  hold: 0,
  load: { size: -10, at: "output", shape: "pulse", duration: 60 },
  length: 500,
};

test("every member of a step becomes a text and is read back", () => {
  assert.deepEqual(readStep(textsOf(whole)), { step: whole, errors: [] });
  assert.deepEqual(textsOf({ target: 3 }), { y: "0", u: "0", target: "3" }, "the defaults of the contract");
  assert.deepEqual(readStep({ target: "1,5", "load.at": "output" }).step, { target: 1.5 }, "without a size there is no load");
  const stays = readStep({ target: "1", "load.size": "2", "load.duration": "9" }).step!;
  assert.deepEqual(stays, { target: 1, load: { size: 2, shape: "step" } }, "only a pulse and a ramp end");
});

test("a text that is no number is told at its field, and so is a missing set point", () => {
  const { step, errors } = readStep({ y: "warm", "load.size": "1", "load.shape": "ramp", "load.duration": "a" });
  assert.equal(step, null);
  assert.deepEqual(errors.map(({ pointer }) => pointer).sort(), ["y", "load/duration", "target"].map((name) => `/evaluate/own_step/${name}`).sort());
  assert.equal(readStep({ target: "1", "load.size": "1", "load.shape": "pulse" }).errors[0]!.pointer, "/evaluate/own_step/load/duration", "a pulse needs its length");
  assert.match(errors.find(({ pointer }) => pointer.endsWith("target"))!.detail, /^New set point is empty/);
});

test("steps are the same if a request with either means the same", () => {
  assert.ok(sameStep({ target: 3, load: { size: 1 } }, { y: 0, u: 0, target: 3, load: { size: 1, at: "input", shape: "step", duration: 4 } }));
  assert.ok(!sameStep({ target: 3 }, { target: 3, u_max: 1 }) && !sameStep({ target: 3 }, undefined) && sameStep(undefined, undefined));
});

const recorded = (more: object, fit: object = {}): Result =>
  ({
    controllers: [],
    model: {
      plant: { type: "ipdt", K: 5, L: 1 },
      data_quality: { u0: 0.0001234567, y0: 20.94951, ...more },
      fit: { t: [0, 1, 2], u: [0, 50, 50], y: [21, 30, 70], y_model: [20.9, null, 55.812], ...fit },
    },
  }) as unknown as Result;

test("a record proposes the step from its rest to the y that its model reached, within the limits that are known", () => {
  const request: TuningRequest = { units: { u: "%" } };
  const step = proposedStep(request, recorded({}));
  assert.deepEqual([step.y, step.u], [20.95, 0.0001235]);
  assert.equal(step.target, 20.95 + 35, "the change of 34.86 in two digits; the noise of y does not count");
  assert.deepEqual([step.u_min, step.u_max], [0, 100], "percent of the actuator");
  const limits = (given: TuningRequest, result = recorded({})) => {
    const { u_min, u_max } = proposedStep(given, result);
    return [u_min, u_max];
  };
  assert.deepEqual(limits({}), [undefined, undefined]);
  assert.deepEqual(limits(request, recorded({ u_limits: [-5, 60] })), [-5, 60], "those of the record come first");
  assert.deepEqual(limits({ implement: { product: "x", u_span: [0, 80] } }), [0, 80]);
  assert.deepEqual(limits({ implement: { product: "x", u_span: [4, 20] } }), [undefined, undefined], "u at rest is outside");
  assert.deepEqual(limits({ evaluate: { actuator: { min: -1, max: 9 } } }, recorded({ u0: 40 })), [39, 49], "deviations from the rest");
  assert.equal(proposedStep(request, recorded({ u0: -0.02 })).u, 0, "noise below the limit");
  const falling = proposedStep({}, recorded({ y0: 80 }, { y_model: [80, 60, 66] }));
  assert.equal(falling.target, 60);
  const untraced = recorded({ u_limits: [0, 80] }, { y_model: [] });
  assert.equal(proposedStep({}, untraced).target, 21.95, "a step that the service refuses is not proposed");
  Object.assign(untraced.model!, { plant: { type: "fopdt", K: -2, T: 9, L: 1 } });
  assert.equal(proposedStep({}, untraced).target, 20.95 - 80, "half of the way of u, by the gain");
});

test("the record of a loop proposes the step of its own set points", () => {
  const result = { ...recorded({ y0: 49.2, u0: 25 }), replay: { r: [50, 50, 55, 47, 53, null] } } as unknown as Result;
  const { y, target } = proposedStep({}, result);
  assert.deepEqual([y, target], [50, 55]);
  const still = { ...recorded({}), replay: { r: [50, 50] } } as unknown as Result;
  assert.equal(proposedStep({}, still).y, 20.95, "a set point that rests proposes nothing");
});

test("a model proposes a step from the middle of the controller's ranges, else the step of the request", () => {
  const spans = { product: "x", y_span: [0, 400], u_span: [0, 100] } as TuningRequest["implement"];
  assert.deepEqual(proposedStep(spans ? { implement: spans } : {}, { controllers: [] }), { y: 200, u: 50, target: 240, u_min: 0, u_max: 100 });
  assert.deepEqual(proposedStep({ evaluate: { setpoint_step: 5 } }, { controllers: [] }), { y: 0, u: 0, target: 5 });
});

const traces = { t: [0, 1, 2], r: [25, 30, 30], y: [20, 25, 30], u: [5, 100, 60] };
const own = {
  setpoint: { IAE: 40, overshoot: 0.5, overshoot_percent: 5, settling_time: null, why_null: { settling_time: "It does not." } },
  load: { start: 1, IAE: 1, peak: -3, recovery_time: 2 },
  u_min: 5,
  u_max: 100,
  travel: 135,
  time_at_min: 0,
  time_at_max: 0.4,
  u_needed: 60,
  y_final: 30,
  settles: true,
  trace: traces,
};
const responses = { setpoint: { t: [0, 1], y: [0, 1], u: [2, 1] }, load: { t: [0, 1], y: [0, 1], u: [2, 1] } };
const entry = (method: string, own_step?: object): Entry => ({ method, options: {}, responses, own_step, verdict: [] }) as unknown as Entry;
const refused = { refused: { code: "unstable", text: "The loop is unstable." } };

test("the step is drawn from the rest on, with the load's begin and the limit that u reaches", () => {
  const drawn = drawnEntries({ controllers: [entry("robust", own), entry("simc", refused), entry("baseline", { ...own, trace: undefined })] }, [0, 1, 2]);
  const frame = ownStepFrame(drawn, { ...whole, y: 20, u_min: -5000 }, units)!;
  assert.deepEqual(frame.panes.map(({ traces: lines }) => lines.map(({ name }) => name)), [["robust", "set point"], ["robust"]]);
  const [y, u] = frame.panes;
  assert.deepEqual([y!.traces[1]!.x, y!.traces[1]!.y], [[0, ...traces.t], [20, ...traces.r]], "with a corner at the step");
  assert.deepEqual(y!.marks, [{ kind: "upright", value: 1, role: "zero", label: "load" }]);
  assert.deepEqual(u!.marks, [{ kind: "level", value: 100, role: "limit" }], "a limit far away would compress the curve");
  assert.deepEqual([y!.y.label, u!.y.label, frame.x.label], ["y (°C)", "u (%)", "time (min)"]);
  assert.equal(ownStepFrame(drawn.slice(1), whole, units), null);
});

test("the figures of the step have the contract's units, and only its own parts", () => {
  const labels = (step: OwnStep) => ownStepGroups(step, units).flatMap(({ rows }) => rows.map(({ label }) => label));
  assert.deepEqual(labels(whole), [
    "IAE (°C min)", "Overshoot (°C)", "Overshoot (%)", "Settling (min)",
    "IAE (°C min)", "Peak (°C)", "Recovery (min)",
    "Smallest u (%)", "Largest u (%)", "TV of u (%)", "Time at the lower limit (min)", "Time at the upper limit (min)",
    "u needed (%)", "y in the end (°C)",
  ]);
  assert.deepEqual(labels({ y: 3, target: 3, load: { size: 1 } }).slice(0, 3), ["IAE (°C min)", "Peak (°C)", "Recovery (min)"]);
  const settling = ownStepGroups(whole, units)[0]!.rows[3]!;
  assert.deepEqual(settling.value(entry("robust", own)), { text: "", why: "It does not." });
  assert.deepEqual(settling.value(entry("robust", refused)), { text: "", why: "The loop is unstable." });
});

test("what a verdict says of another step takes the place of the old one", () => {
  const of = (...codes: string[]): Finding[] => codes.map((code) => ({ code, level: "note", text: code, figures: {} }));
  const codes = (verdict: Finding[]) => verdict.map(({ code }) => code);
  const about = of("robust", "load-error", "own-step-saturates", "as-built", "noise");
  assert.deepEqual(codes(withStepFindings(of("robust", "own-step", "noise"), about)), ["robust", "noise", "own-step-saturates"]);
  const far: Finding[] = [{ code: "own-step-out-of-reach", level: "warning", text: "", figures: {} }];
  assert.deepEqual(codes(withStepFindings(of("robust", "noise"), far)), ["robust", "own-step-out-of-reach", "noise"], "a warning is read first");
  assert.deepEqual(codes(withStepFindings(of("robust", "own-step"), [])), ["robust"], "it is not known yet");
});

test("the address of a design holds the step next to its sliders", () => {
  const route = { screen: "design", job: "j1", entry: 2, values: { Ms: "1.6" }, step: { target: "1,5", "load.size": "-2" } } as const;
  assert.deepEqual(parseRoute(formatRoute(route)), route);
  assert.deepEqual(parseRoute("#/jobs/j1/design?Ms=1.6"), { screen: "design", job: "j1", entry: null, values: { Ms: "1.6" } });
});
