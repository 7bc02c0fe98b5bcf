import assert from "node:assert/strict";
import test from "node:test";
import { STRUCTURES } from "../../../../web/src/api/structure.ts";
import type { AnswerOf, StructureRequest } from "../../../../web/src/api/structure.ts";
import { levelChoices, structureResponses, structureSensitivities } from "../../../../web/src/charts/structure.ts";
import { formatRoute, parseRoute } from "../../../../web/src/routes.ts";
import { layoutDiagram } from "../../../../web/src/structure/diagram.ts";
import type { Box } from "../../../../web/src/structure/diagram.ts";
import { linkedTexts, objectPlants, parseSettings, readQuestion, settingsLine, textsOf, textsOfLink } from "../../../../web/src/structure/question.ts";
import { fieldsOf, firstExample, STRUCTURE_SPECS } from "../../../../web/src/structure/structures.ts";
import { unitNames } from "../../../../web/src/words/numbers.ts";
import { conclusionWords, nameOfInput, polynomial, settingLines, settingsOfAnswer } from "../../../../web/src/words/structure.ts";
import { structureTables } from "../../../../web/src/structure/figures.ts";

const units = unitNames({ time: "s", u: "%", y: "degC" });
const pid = { form: "ideal", Kp: 0.9348808, Ti: 18.1077739, Td: 4.3558718, b: 1, c: 0, filter: { type: "measurement_second_order", Tf: 0.43558718 } };
const pi = { form: "ideal", Kp: 0.64764, Ti: 2.8449, Td: 0, b: 1, c: 0, filter: { type: "none" } };
const step = (IAE: number) => ({ IAE, IE: -IAE, peak: 0.5, TV: 1 });
const steps = (a: number, b: number, c: number) => ({ inner_load: step(a), outer_load: step(b), setpoint: step(c) });
const cascade = {
  structure: "cascade",
  responses: [],
  sensitivities: { omega: [], curves: [] },
  inner: { controller: pi, robustness: { Ms: 1.4, Mt: 1.06 } },
  outer: { controller: pid, robustness: { Ms: 1.4, Mt: 1.2, Ms_valve: 1.587, gain_margin: null, phase_margin_deg: 51.1, dead_time_up: 17, why_null: { gain_margin: "No gain makes it unstable." } } },
  Ms_valve_limit: 1.6,
  performance: steps(5.561, 24.37, 30.7),
  speed_ratio: 7.16,
  single: { controller: pid, Ms: 1.4, Mt: 1.2, performance: steps(54.05, 27.17, 35.3) },
  gain: { inner_load: 9.72, outer_load: 1.12 },
  verdict: [],
} as unknown as AnswerOf<"cascade">;

/** The request that the form makes of the texts that show a request. */
const again = (id: (typeof STRUCTURES)[number], request: StructureRequest) => readQuestion(id, textsOf(id, request));

test("every example comes back from the form as it was, and from the link too", () => {
  for (const id of STRUCTURES)
    for (const [title, request] of Object.entries(STRUCTURE_SPECS[id].examples)) {
      const { question, errors } = again(id, request);
      assert.deepEqual(errors, [], title);
      for (const [name, value] of Object.entries(request)) assert.deepEqual(question.request[name], value, `${title}: ${name}`);
      const link = formatRoute({ screen: "structure", id, values: linkedTexts(id, textsOf(id, request)), job: null });
      const route = parseRoute(link);
      assert.ok(route.screen === "structure" && route.id === id);
      assert.deepEqual(readQuestion(id, textsOfLink(id, route.values)).question, question, title);
      assert.equal(formatRoute(route), link);
    }
});

test("given controllers, today's settings and members without a field are kept", () => {
  const request = {
    inner: { plant: "2 e^(-s)/(4s+1)", controller: { Kp: 0.65, Ti: 2.8 } },
    outer: { plant: "1.5 e^(-8s)/(30s+1)", controller: { Kp: 0.9, Ti: 18, Td: 4, filter: { type: "measurement_second_order", Tf: 0.4 } } },
    arrangement: "parallel",
    compare_single: false,
    search: "sequential",
    weights: { d1: 1, d2: 2 },
    baseline: { inner: { Kp: 0.5, Ti: 4 }, outer: { Kp: 0.5, Ti: 30 } },
  };
  const { question, errors } = again("cascade", request);
  assert.deepEqual(errors, []);
  assert.deepEqual(question.request, request);
  const given = { plant: "5 e^(-10s)/(5s+1)", controller: { C: { num: [5, 1], den: [25, 0] }, F: { num: [1], den: [20, 1] } } };
  assert.deepEqual(again("predictor", given).question.request, given);
});

test("a design has no settings, given settings have no limit, and a path that is not there is 0", () => {
  const texts = textsOf("feedforward", firstExample("feedforward"));
  const given = { ...texts, "feedback.tune.controller": "given", feedback: "Kp 1.3333, Ti 60" };
  assert.deepEqual(readQuestion("feedforward", given).question.request["feedback"], { Kp: 1.3333, Ti: 60 });
  assert.deepEqual(readQuestion("feedforward", { ...given, "feedback.tune.controller": "PID" }).question.request["feedback"], { tune: { controller: "PID" } });
  const column = textsOf("interaction", { plant: [["1/(s+1)", 0], [null, "2/(s+1)"]], controllers: [{ Kp: 1, Ti: 2 }, { Kp: 2, Ti: 3 }], pairing: [2, 1] });
  const { request } = readQuestion("interaction", column).question;
  assert.deepEqual(request["plant"], [["1/(s+1)", 0], [0, "2/(s+1)"]]);
  assert.deepEqual(request["controllers"], [{ Kp: 1, Ti: 2 }, { Kp: 2, Ti: 3 }]);
  assert.deepEqual(request["pairing"], [2, 1]);
});

test("a text that cannot be read is a fault at its field, in words", () => {
  const texts = { ...textsOf("cascade", firstExample("cascade")), "outer.plant": " ", "limits.Ms_valve": "1.x", "baseline.inner": "Kq 3" };
  const { errors } = readQuestion("cascade", texts);
  assert.deepEqual(errors.map(({ pointer }) => pointer), ["/outer/plant", "/limits/Ms_valve", "/baseline/inner"]);
  assert.match(errors[2]!.detail, /"Kq" is not one of Kp, Ti, Td, Tf, b/);
});

test("settings in one line: any separators, a decimal comma, the filter of the measurement", () => {
  assert.deepEqual(parseSettings("Kp=0,65 ; Ti: 2.8, Td 1e-1"), { value: { Kp: 0.65, Ti: 2.8, Td: 0.1 } });
  assert.deepEqual(parseSettings("kp −2"), { value: { Kp: -2 } });
  assert.deepEqual(parseSettings("Kp 1, Tf 0.2"), { value: { Kp: 1, filter: { type: "measurement_second_order", Tf: 0.2 } } });
  assert.ok("sentence" in parseSettings("Ti 3"));
  assert.ok("sentence" in parseSettings("Kp"));
  assert.equal(settingsLine({ Kp: 0.6476398, Ti: 2.84489, Td: 0, b: 1, filter: { type: "none" } }), "Kp 0.6476398, Ti 2.84489");
  assert.equal(settingsLine(pid), "Kp 0.9348808, Ti 18.1077739, Td 4.3558718, Tf 0.43558718");
  for (const other of [{ form: "parallel", Kp: 1, Ki: 2, Kd: 0 }, { Kp: 1, Ti: 2, Td: 1, filter: { type: "derivative", Tf: 0.1 } }, { Kp: 1, c: 1 }])
    assert.deepEqual(parseSettings(settingsLine(other)), { value: other });
  assert.ok("sentence" in parseSettings("{Kp: 1}"));
  assert.deepEqual(parseSettings("Kc 1.1, Ti 7.2", ["Kc", "Ti"]), { value: { Kc: 1.1, Ti: 7.2 } });
});

test("a limit that has no slider is kept too", () => {
  const request = { inner: { plant: "1/(s+1)", tune: { controller: "PI", Ms: 1.5, Mt: 1.2 } }, outer: { plant: "1/(9s+1)", tune: { controller: "PID" } }, arrangement: "series", search: "joint" };
  assert.deepEqual(again("cascade", request).question.request, request);
});

test("a run call by call is asked for by its sample time", () => {
  const request = { plant: "2 e^(-9s)/(4s+1)", kind: "smith", Ms: 1.5, sampled: { sample_time: 0.5, u_min: -1, u_max: 2, steps: { setpoint: 5 } } };
  assert.deepEqual(again("predictor", request).question.request, request);
  const { question } = readQuestion("predictor", { ...textsOf("predictor", request), "sampled.sample_time": " " });
  assert.equal(question.request["sampled"], undefined);
});

test("parts without a field are kept as long as the part that they belong to is asked for", () => {
  const sampled = { sample_time: 0.5, u_max: 2, bias: 20, rules: { integral: "backward" }, steps: { setpoint: 5, other: 1 } };
  const predictor = { plant: "2 e^(-9s)/(4s+1)", kind: "smith", sampled };
  assert.deepEqual(again("predictor", predictor).question.request, predictor);
  assert.equal(readQuestion("predictor", { ...textsOf("predictor", predictor), "sampled.sample_time": "" }).question.request["sampled"], undefined);

  const cascade = { inner: { plant: "1/(s+1)", tune: { method: "robust", controller: "PI" } }, outer: { plant: "1/(9s+1)", tune: { controller: "PI" } }, arrangement: "series", search: "sequential" };
  assert.deepEqual(again("cascade", cascade).question.request, cascade);
  const given = { ...textsOf("cascade", cascade), "inner.tune.controller": "given", "inner.controller": "Kp 1, Ti 2" };
  assert.deepEqual(readQuestion("cascade", given).question.request["inner"], { plant: "1/(s+1)", controller: { Kp: 1, Ti: 2 } });
});

test("plants that are objects are left to the service to write", () => {
  const fopdt = { type: "fopdt", K: 1, T: 2, L: 3 };
  const request = { plant: fopdt, kind: "smith", Ms: 1.6 };
  assert.deepEqual(objectPlants("predictor", request as unknown as StructureRequest), [["plant", fopdt]]);
});

test("every conclusion of the contract has a sentence without a gap", () => {
  const figures = { gain: 3, gain_inner: 9.7, gain_outer: 0.8, gain_setpoint: 0.9, Ms: 1.5, limit: 1.4, speed_ratio: 2, at_least: 3, rate_over_bound: 1.04, highest: 2, allowed: 1.8, IAE: 4, IAE_none: 3, peak: 0.7, peak_bound: 0.6, wrong: 0.2, IAE_pid: 5, window: 2, relative_gain: -1, niederlinski: -1, other: 2, mu: 1.9, count: 1 };
  const codes = "unstable cascade-pays cascade-gains-little inner-too-slow inner-peak-above outer-peak-above valve-peak-above near-lowest-rate level-above-room flow-loop-unstable flow-loop-too-slow feedforward-exact feedforward-pays feedforward-gains-little feedforward-worse-than-none gain-alone-worse-than-none peak-unavoidable wrong-model-worse-than-none pid-does-as-well predictor-pays limited-by-dead-time-error narrow-dead-time-window controller-unstable pairing-impossible other-pairing-better hardly-interacting mu-above subsets-unstable better-than-blt decoupler-helps decoupler-worse-than-none decoupler-fragile".split(" ");
  for (const code of codes) {
    const { text } = conclusionWords({ code, figures } as never, units);
    assert.match(text, /^[A-Z].*\.$/, code);
    assert.doesNotMatch(text, /–|NaN|undefined|[{}]/, code);
    assert.notEqual(text, `${code.replaceAll("-", " ")}.`);
  }
  assert.match(conclusionWords({ code: "cascade-pays", figures } as never, units).text, /has 9\.70 times its IAE after a load at the valve, 0\.800 times after .*, and 0\.900 times after a set-point step\.$/);
  assert.match(conclusionWords({ code: "level-above-room", figures } as never, units).text, /by 2\.00 °C, above the allowed 1\.80 °C\.$/);
  assert.match(conclusionWords({ code: "level-above-room", figures } as never, unitNames(undefined)).text, /by 2\.00, above the allowed 1\.80\.$/);
  assert.match(conclusionWords({ code: "wrong-model-worse-than-none", figures } as never, units).text, /wrong by 20 %/);
  assert.deepEqual(conclusionWords({ code: "brand-new", figures: {} } as never, units), { code: "brand-new", level: "note", text: "brand new." });
});

test("a figure that is not known gives its reason in place of the sentence about it", () => {
  const why = "The measurement comes to rest away from its target.";
  const figures = { gain: null, why_null: { gain: why } };
  assert.equal(conclusionWords({ code: "feedforward-pays", figures } as never, units).text, `Feedforward pays. ${why}`);
  const both = { gain_inner: null, gain_outer: 2, gain_setpoint: null, why_null: { gain_inner: why, gain_setpoint: why } };
  assert.equal(conclusionWords({ code: "cascade-gains-little", figures: both } as never, units).text, `The cascade gains little. ${why}`);
});

test("the table has the figures next to the single loop's, and each missing one its reason", () => {
  const { columns, groups } = structureTables(cascade, units)[0]!;
  assert.deepEqual(columns.map(({ title }) => title), ["design", "single loop"]);
  const row = (label: string) => groups.flatMap(({ rows }) => rows).find((candidate) => candidate.label === label)!;
  const texts = (label: string) => columns.map((entry) => row(label).value(entry));
  assert.deepEqual(texts("Ms at the valve").map(({ text }) => text), ["1.59", "1.40"]);
  assert.deepEqual(texts("IAE after a load at the valve (°C s)").map(({ text }) => text), ["5.56", "54.0"]);
  assert.equal(texts("Gain margin, outer loop")[0]!.why, "No gain makes it unstable.");
  assert.equal(texts("Ms, inner loop")[1]!.why, "Not a figure of a single loop.");
});

test("what to type: settings with units, and transfer functions", () => {
  const [outer, inner] = settingsOfAnswer(cascade, units);
  assert.equal(settingLines(outer!), "Outer controller\nKp = 0.93488\nTi (s) = 18.108\nTd (s) = 4.3559\nTf (s) = 0.43559");
  assert.deepEqual(inner!.settings.map(({ name }) => name), ["Kp", "Ti"]);
  assert.equal(polynomial([40.2, 1]), "40.2 s + 1");
  assert.equal(polynomial([1, 0, -2]), "s^2 − 2");
  assert.equal(polynomial([0]), "0");
});

const answered = (of: string, input: string, names: string[]) => ({ of, input, t: [0, 1, 2], signals: names.map((name, index) => ({ name, values: [0, index + 1, -3] })) });

test("responses: a plot for each input, a pane for each signal, the design first and the others thinner", () => {
  const responses = [answered("single", "inner_load", ["y1", "u"]), answered("design", "inner_load", ["y1", "y2", "u"]), answered("design", "setpoint", ["y1", "y2", "u"])];
  const frames = structureResponses({ ...cascade, responses }, units);
  assert.deepEqual(frames.map(([input, { title }]) => [input, title]), [["inner_load", "Load at the valve"], ["setpoint", "Set-point step"]]);
  const panes = frames[0]![1].panes;
  assert.deepEqual(panes.map(({ traces }) => traces.map(({ name, look, thin }) => [name, look, thin])), [
    [["design", 1, false], ["single loop", 2, true]],
    [["design", 1, false]],
    [["design", 1, false], ["single loop", 2, true]],
  ]);
  assert.match(frames[0]![1].description, /design: y1 is farthest from 0 at −3/);
  assert.deepEqual(structureResponses(cascade, units), []);
  assert.equal(nameOfInput("load_2"), "Load at the plant input 2");
});

test("the run call by call is drawn with the design, with a step of another size by itself, and has a table", () => {
  const figures = [{ IAE: 6.173, IE: 0, peak: 0.18, TV: 1.3 }];
  const run = (input: string) => ({ input, figures, largest_rate: 0.38, t: [0, 0.5], signals: [{ name: "y1", values: [0, 1] }, { name: "r2", values: [0, 2] }] });
  const answer = {
    ...cascade,
    responses: [answered("design", "inner_load", ["y1", "u"]), answered("single", "inner_load", ["y1", "u"]), answered("design", "setpoint", ["y1", "u"])],
    sampled: { sample_time: 0.5, Ms: { inner: 1.574 }, responses: [run("inner_load"), run("setpoint")] },
  } as unknown as AnswerOf<"cascade">;
  const frames = structureResponses(answer, units, { setpoint: 5 });
  assert.deepEqual(frames.map(([, { title, panes }]) => [title, panes[0]!.traces.map(({ name, thin }) => [name, thin])]), [
    ["Load at the valve", [["design", false], ["call by call, with limits", false], ["single loop", true]]],
    ["Set-point step", [["design", false]]],
    ["Set-point step, size 5", [["call by call, with limits", false]]],
  ]);
  const { columns, groups } = structureTables(answer, units).at(-1)!;
  const rows = groups.flatMap(({ title, rows }) => rows.map((row) => [title, row.label, row.value(columns[0]!).text]));
  assert.deepEqual(rows.slice(0, 3), [["Ms without limits", "inner loop", "1.57"], ["Load at the valve", "IAE (°C s)", "6.17"], ["Load at the valve", "Peak", "0.180"]]);
});

test("peaks: a curve for each loop and a line for each limit", () => {
  const curve = (of: string, loop: string, limit?: number) => ({ of, loop, ...(limit ? { limit } : {}), values: [0.1, 1.4, 1] });
  const frame = structureSensitivities({ ...cascade, sensitivities: { omega: [0.1, 1, 10], curves: [curve("design", "inner", 1.4), curve("design", "outer", 1.4), curve("design", "valve", 1.6), curve("single", "outer")] } }, units)!;
  assert.deepEqual(frame.panes[0]!.traces.map(({ name, thin }) => [name, thin]), [["inner loop", false], ["outer loop", false], ["at the valve", false], ["single loop, outer loop", true]]);
  assert.deepEqual(frame.panes[0]!.marks!.map((mark) => mark.kind === "level" && mark.value), [1.4, 1.6]);
  assert.equal(structureSensitivities(cascade, units), null);
});

test("choices of a level: by overshoot, with the design among them", () => {
  const design = (zeta: number, rate_over_bound: number, overshoot_percent: number) => ({ Kc: 1, Ti: 1, zeta, highest: 1, time_of_highest: 1, largest_rate: 1, rate_over_bound, overshoot_percent });
  const frame = levelChoices({ structure: "level", responses: [], sensitivities: { omega: [], curves: [] }, design: design(0.4, 1.04, 36), bound: 1, robustness: { Ms: 1.2 }, frontier: [design(0.4, 1.04, 36), design(1, 1.47, 13.5)], verdict: [] })!;
  assert.deepEqual(frame.panes[0]!.traces[0]!.x, [13.5, 36]);
  assert.ok(frame.panes[0]!.marks!.some((mark) => mark.kind === "point" && mark.label === "design" && mark.x === 36));
  assert.equal(levelChoices(cascade), null);
});

const overlaps = (a: Box, b: Box): boolean => a.left < b.left + b.width && b.left < a.left + a.width && a.top < b.top + b.height && b.top < a.top + a.height;

test("diagrams: every block has its place inside, and no two overlap, at every width", () => {
  for (const id of STRUCTURES)
    for (const more of [{}, { arrangement: "parallel" }, { size: "3" }] as Record<string, string>[])
      for (const width of [340, 366, 700, 800, 1000, 1200, 1384]) {
        const texts = { ...textsOf(id, {}), ...more };
        const plan = layoutDiagram(id, texts, width);
        if (!plan) continue;
        const names = STRUCTURE_SPECS[id].blocks(texts).map((block) => block.id);
        assert.deepEqual(Object.keys(plan.boxes).sort(), [...names].sort(), `${id} ${width}`);
        assert.ok(plan.width <= width + 0.5, `${id}: ${plan.width} in ${width}`);
        const boxes = Object.values(plan.boxes);
        for (const [index, box] of boxes.entries()) {
          assert.ok(box.left >= 0 && box.top >= 0 && box.left + box.width <= plan.width && box.top + box.height <= plan.height, `${id} ${width}`);
          for (const other of boxes.slice(index + 1)) assert.ok(!overlaps(box, other), `${id} ${JSON.stringify(more)} ${width}`);
        }
        assert.doesNotMatch(JSON.stringify(plan.drawing), /NaN|null|Infinity/);
      }
  assert.ok(layoutDiagram("cascade", {}, 340), "a cascade is turned on a phone");
  assert.equal(layoutDiagram("interaction", {}, 340), null);
});

test("the fields of a block exist, and each field has one place", () => {
  for (const id of STRUCTURES) {
    const texts = textsOf(id, {});
    const keys = fieldsOf(id, texts).map(({ key }) => key);
    assert.equal(new Set(keys).size, keys.length);
    const placed = STRUCTURE_SPECS[id].blocks(texts).flatMap(({ fields }) => fields);
    for (const key of placed) assert.ok(keys.includes(key), key);
    assert.equal(new Set(placed).size, placed.length);
  }
});
