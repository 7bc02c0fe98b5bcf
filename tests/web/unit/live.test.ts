import assert from "node:assert/strict";
import test from "node:test";
import type { Controller, Entry, Method, TuneEntry } from "../../../web/src/api/types.ts";
import { frontFrame } from "../../../web/src/charts/front.ts";
import { manualSliders, manualValue, isTied, optionSliders, withManual, withOption } from "../../../web/src/live/sliders.ts";
import { firstStep, pointOf, stepBack, stepForward, stepInPlace, stepTo, valuesOf } from "../../../web/src/live/point.ts";
import type { Point } from "../../../web/src/live/point.ts";
import { formatRoute, parseRoute } from "../../../web/src/routes.ts";
import { unitNames } from "../../../web/src/words/numbers.ts";

const units = unitNames({ time: "s", u: "%", y: "degC" });
const controller: Controller = {
  form: "ideal",
  Kp: 2,
  Ti: 10,
  Td: 2,
  filter: { type: "measurement_second_order", Tf: 0.2 },
};
const robustness = { stable: true, Ms: 1.4, Mks: 20, gain_crossover: 0.5 } as Entry["robustness"];
const entryOf = (method: string, more: Partial<Entry> = {}): Entry => ({ method, controller, ...(robustness ? { robustness } : {}), ...more });
const limit = { from: 1.1, to: 2.5, step: 0.01, low: "calm", high: "sharp" };
const noise = { logarithmic: true, group: "noise", relative: true, from: 0.2, to: 5 };
const setpoint = { from: 0, to: 40, group: "setpoint" };
const ratio = { from: 0.02, to: 1, logarithmic: true, group: "noise", value_of: "Tf_over_Td", reached: "Tf_over_Td" } as const;
/** In the form of GET /v1/methods. */
const robust: Method = {
  id: "robust",
  title: "Robust",
  options: {
    properties: {
      controller: { type: "string", enum: ["PID", "PI"] },
      Ms: { type: "number", default: 1.4, "x-slider": limit },
      Mt: { type: "number", default: 1.4, "x-slider": { ...limit, moves_with: "Ms" } },
      Mks: { type: "number", "x-slider": { ...noise, to: 2, value_of: "Mks" } },
      rho: { type: "number", default: 0.5 },
      filter: {
        type: "object",
        properties: {
          Tf: { type: "number", "x-slider": { ...noise, value_of: "Tf", reached: "Tf" } },
          Tf_over_Td: { type: "number", "x-slider": ratio },
        },
      },
      setpoint: {
        type: "object",
        properties: {
          weight: { type: "number", "x-slider": { ...setpoint, to: 1 } },
          overshoot: { type: "number", "x-slider": { ...setpoint, reached: "overshoot_percent" } },
        },
      },
    },
  },
};
const idsOf = (tune: TuneEntry, entry = entryOf("robust"), method: Method = robust): string[] =>
  optionSliders(tune, entry, method, units).map((spec) => spec.id);

test("a robust design is turned by its limits, its noise and its set point", () => {
  assert.deepEqual(idsOf({ method: "robust" }), ["Ms", "filter.Tf_over_Td", "setpoint.overshoot"]);
  assert.deepEqual(idsOf({ method: "robust", Ms: 1.4, Mt: 1.2 }), ["Ms", "Mt", "filter.Tf_over_Td", "setpoint.overshoot"]);
  assert.deepEqual(idsOf({ method: "robust", Mks: 5, setpoint: { weight: 0.5 } }), ["Ms", "Mks", "setpoint.weight"]);
  assert.deepEqual(idsOf({ method: "robust", filter: { Tf: 0.3 } }), ["Ms", "filter.Tf", "setpoint.overshoot"]);
  const PI = entryOf("robust", { controller: { ...controller, Td: 0, filter: { type: "none" } } });
  assert.deepEqual(idsOf({ method: "robust", controller: "PI" }, PI), ["Ms", "Mks", "setpoint.overshoot"]);
  assert.deepEqual(idsOf({ method: "robust" }, entryOf("robust"), { id: "robust", title: "" }), [], "of a service that describes none");
  const [Ms] = optionSliders({ method: "robust" }, entryOf("robust"), robust, units);
  assert.deepEqual([Ms!.lo, Ms!.hi, Ms!.step, Ms!.value], [1.1, 2.5, 0.01, 1.4]);
});

test("a slider asks for the overshoot that was asked for, or for none; what is reached is the loop's that runs", () => {
  const spec = (tune: TuneEntry, more: Partial<Entry> = {}) =>
    optionSliders(tune, entryOf("robust", more), robust, units).find(({ id }) => id === "setpoint.overshoot")!;
  const resolved = { options: { setpoint: { overshoot: 5 } } };
  assert.equal(spec({ method: "robust" }, resolved).value, 5);
  assert.equal(spec({ method: "robust", setpoint: { overshoot: 12 } }, resolved).value, 12);
  assert.equal(spec({ method: "robust", setpoint: { best: "iae" } }, { options: { setpoint: { best: "iae" } } }).value, null);
  assert.equal(spec({ method: "robust", objective: "setpoint_iae" }).value, null);
  const over = (percent: number | null) => ({ setpoint: { overshoot_percent: percent } });
  const { reached } = spec({ method: "robust" });
  const ideal = entryOf("robust", { performance: over(4.9) });
  assert.equal(reached!(ideal), 4.9);
  assert.equal(reached!({ ...ideal, implemented: { performance: over(31) } } as Entry), 31);
  assert.equal(reached!(entryOf("robust", { performance: over(null) })), null);
  assert.equal(reached!(entryOf("robust")), null);
});

test("of the filter's ratio the one asked for is turned, and the design's own is what is reached", () => {
  const entry = entryOf("robust");
  const ratio = optionSliders({ method: "robust", filter: { Tf_over_Td: 0.3 } }, entry, robust, units)[1]!;
  assert.deepEqual([ratio.id, ratio.value, ratio.reached!(entry)], ["filter.Tf_over_Td", 0.3, 0.1]);
  assert.equal(ratio.reached!(entryOf("robust", { controller: { ...controller, Td: 0 } })), null);
  const time = optionSliders({ method: "robust", filter: { Tf: 0.5 } }, entry, robust, units)[1]!;
  assert.deepEqual([time.id, time.value, time.reached!(entry)], ["filter.Tf", 0.5, 0.2]);
});

test("options are moved as the method describes: between ends, about their value, or about the loop's time", () => {
  const method: Method = {
    id: "m",
    title: "",
    options: {
      properties: {
        gain_margin: { type: "number", default: 3, maximum: 20, "x-slider": { from: 1.19, to: 20 } },
        tau_c: { type: "number", "x-unit": "time", "x-slider": { from: 0.2, to: 5, relative: true, logarithmic: true } },
        Ku: { type: "number" },
        kind: { type: "string" },
      },
    },
  };
  const sliders = optionSliders({ method: "m" }, entryOf("m"), method, units);
  assert.deepEqual(
    sliders.map(({ id, value, log, unit }) => [id, value, log, unit]),
    [
      ["gain_margin", 3, false, ""],
      ["tau_c", null, true, "s"],
    ],
  );
  assert.ok(sliders[1]!.lo < 2 && sliders[1]!.hi > 2, "about 1 over the crossover");
  assert.equal(optionSliders({ method: "m", tau_c: 7 }, entryOf("m"), method, units)[1]!.value, 7);
});

test("limits go together while they are tied, and parts of an option replace each other", () => {
  const tied = (tune: TuneEntry): boolean => isTied(tune, robust);
  assert.ok(tied({ method: "robust" }) && tied({ method: "robust", Ms: 1.6, Mt: 1.6 }));
  assert.ok(!tied({ method: "robust", Ms: 1.6 }), "Mt is 1.4 then");
  assert.ok(isTied({ method: "robust", Ms: 1.6 }, undefined), "nothing is known of other limits");
  assert.deepEqual(withOption({ method: "robust" }, "Ms", 1.7, ["Mt"]), { method: "robust", Ms: 1.7, Mt: 1.7 });
  assert.deepEqual(withOption({ method: "robust", Mt: 1.3 }, "Ms", 1.7), { method: "robust", Ms: 1.7, Mt: 1.3 });
  const weighted: TuneEntry = { method: "robust", setpoint: { weight: 0.4 } };
  assert.deepEqual(withOption(weighted, "setpoint.overshoot", 10)["setpoint"], { overshoot: 10 });
});

test("settings by hand are those that the controller has, on both sides of the proposal", () => {
  assert.deepEqual(manualSliders(controller, units).map((spec) => spec.id), ["Kp", "Ti", "Td", "Tf"]);
  const PI = { ...controller, Kp: -3, Td: 0, filter: { type: "none" } };
  const [Kp, ...rest] = manualSliders(PI, units);
  assert.deepEqual(rest.map((spec) => spec.id), ["Ti"]);
  assert.ok(Kp!.lo < 0 && Kp!.hi < Kp!.lo, "further from 0 to the right");
  assert.equal(manualValue(withManual(controller, "Tf", 0.5), "Tf"), 0.5);
  assert.equal(withManual(controller, "Tf", 0.5).filter!.type, "measurement_second_order");
});

test("steps go back and forth, a hundred of them, and a new one forgets what was undone", () => {
  const at = (Ms: number): Point => ({ tune: { method: "robust", Ms }, manual: null });
  let steps = firstStep(at(1.4));
  steps = stepTo(steps, at(1.5));
  assert.equal(stepTo(steps, at(1.5)), steps, "nothing moved");
  steps = stepTo(steps, at(1.6));
  steps = stepBack(steps);
  assert.deepEqual(steps.now, at(1.5));
  assert.deepEqual(stepForward(steps).now, at(1.6));
  steps = stepTo(steps, at(2));
  assert.equal(stepForward(steps), steps);
  assert.deepEqual(stepBack(stepBack(steps)).now, at(1.4));
  for (let index = 0; index < 150; index += 1) steps = stepTo(steps, at(1.1 + index / 1000));
  assert.equal(steps.past.length, 100);
});

test("keys that go on with a step are undone together", () => {
  const at = (Ms: number): Point => ({ tune: { method: "robust", Ms }, manual: null });
  let steps = stepTo(firstStep(at(1.4)), at(1.41));
  for (const Ms of [1.42, 1.43]) steps = stepInPlace(steps, at(Ms));
  assert.deepEqual([steps.now, stepBack(steps).now], [at(1.43), at(1.4)]);
  assert.deepEqual(stepForward(stepBack(steps)).now, at(1.43));
});

test("the address says where the sliders stand, and brings them back", () => {
  const proposal: Point = { tune: { method: "robust", Ms: 1.4, Mt: 1.4 }, manual: null };
  const sliders = optionSliders(proposal.tune!, entryOf("robust"), robust, units);
  assert.deepEqual(valuesOf(proposal, proposal, controller, sliders), {});
  const modified: Point = {
    tune: { method: "robust", Ms: 1.65, Mt: 1.65, filter: { Tf_over_Td: 0.3 }, setpoint: { overshoot: 12 } },
    manual: null,
  };
  for (const point of [modified, { ...modified, manual: withManual(controller, "Kp", 2.5) }]) {
    const values = valuesOf(point, proposal, controller, sliders);
    const route = parseRoute(formatRoute({ screen: "design", job: "j", entry: 1, values }));
    assert.ok(route.screen === "design");
    assert.equal(route.entry, 1);
    assert.deepEqual(pointOf(route.values ?? {}, proposal, controller, sliders), point);
  }
  assert.deepEqual(pointOf({ Ms: "nonsense", other: "3" }, proposal, controller, sliders), proposal);
});

test("settings by hand on a modified design come back from the address with all that belongs to them", () => {
  const proposal: Point = { tune: { method: "robust" }, manual: null };
  const filtered: Controller = { ...controller, b: 0, setpoint_filter: { T: 16.8 } };
  const sliders = optionSliders(proposal.tune!, entryOf("robust"), robust, units);
  const back = (manual: Controller, from: Controller): Controller | null => {
    const values = valuesOf({ ...proposal, manual }, proposal, from, sliders);
    const route = parseRoute(formatRoute({ screen: "design", job: "j", entry: null, values }));
    return pointOf(route.screen === "design" ? (route.values ?? {}) : {}, proposal, from, sliders).manual;
  };
  const modified: Controller = { ...filtered, Td: 3.3592532104, b: 0.3, setpoint_filter: { T: 4.851 } };
  assert.deepEqual(back(modified, filtered), modified, "not those of the proposal, and no digit less");
  assert.deepEqual(back(controller, filtered), controller, "nor a filter that the modified design has not");
  assert.deepEqual(back(filtered, controller), filtered);
  const bare: Controller = { ...controller, filter: { type: "none" } };
  assert.deepEqual(back(controller, bare), controller, "the modified design filters the measurement");
  assert.deepEqual(back(bare, controller), bare);
});

test("settings typed into a product come back from the address as they were typed", () => {
  const proposal: Point = { tune: { method: "robust" }, manual: null };
  const sliders = optionSliders(proposal.tune!, entryOf("robust"), robust, units);
  const typed = { product: "a_block", settings: { GAIN: 1.3, FORM: "Standard & more" }, y_span: [0, 200] as [number, number] };
  const point: Point = { ...proposal, manual: withManual(controller, "Kp", 0.65), typed };
  const values = valuesOf(point, proposal, controller, sliders);
  const route = parseRoute(formatRoute({ screen: "design", job: "j", entry: null, values }));
  assert.ok(route.screen === "design");
  assert.deepEqual(pointOf(route.values ?? {}, proposal, controller, sliders), point);
  for (const cut of ["", "{", "3", '{"product":"a_block"}'])
    assert.equal(pointOf({ ...values, typed: cut }, proposal, controller, sliders).typed, undefined, cut);
  const { typed: text } = values;
  assert.deepEqual(pointOf({ typed: text! }, proposal, controller, sliders), proposal, "without a controller for the sliders");
});

test("the front has the design as a point that can be taken, today's settings, and the rules by name", () => {
  const point = (Ms: number, IAE: number) => ({
    Ms,
    controller,
    load_IAE: IAE,
    overshoot_percent: 5,
    Mks: 10,
    achieved: { Ms, Mt: Ms },
  });
  const front = { points: [point(1.2, 20), point(2, 5)], infeasible_below: null };
  const judged = (method: string, IAE: number): Entry => entryOf(method, { performance: { load: { IAE } } });
  const shown = {
    PID: front,
    PI: null,
    here: { entry: judged("robust", 12), at: 1.5 as number | null },
    today: judged("baseline", 33),
    rules: [judged("simc", 15), { method: "amigo", error: { detail: "no" } }],
    load: 2,
  };
  const { panes } = frontFrame(shown, units);
  assert.deepEqual(panes[0]!.traces[0]!.y, [40, 10], "fronts are of unit steps");
  const marks = panes[0]!.marks!.filter((mark) => mark.kind === "point");
  assert.deepEqual(marks.map((mark) => [mark.label, mark.x, mark.quiet ?? false, mark.handle ?? false]), [
    ["simc", 1.4, true, false],
    ["today", 1.4, false, false],
    ["", 1.5, false, true],
  ]);
  const isManual = frontFrame({ ...shown, here: { ...shown.here, at: null } }, units).panes[0]!.marks!.at(-1)!;
  assert.ok(isManual.kind === "point" && !isManual.handle, "settings by hand are no point of the front");
});
