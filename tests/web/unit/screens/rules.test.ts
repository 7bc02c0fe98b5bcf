import assert from "node:assert/strict";
import test from "node:test";
import type { ProblemScore, ScoreAnswer, ScoreRequest } from "../../../../web/src/api/score.ts";
import type { Method } from "../../../../web/src/api/types.ts";
import { profileFrame, profileSteps, ratioFrame } from "../../../../web/src/charts/score.ts";
import { fieldsOf } from "../../../../web/src/form/fields.ts";
import { frameToCsv, frameToRows, frameToSvg } from "../../../../web/src/plot/export.ts";
import { wholeView } from "../../../../web/src/plot/layout.ts";
import { readings } from "../../../../web/src/plot/readout.ts";
import { formatRoute, parseRoute } from "../../../../web/src/routes.ts";
import { comparedRules, otherRules } from "../../../../web/src/rules/others.ts";
import { byScore, hasSettings } from "../../../../web/src/rules/others_card.ts";
import { atLines, designRequest, FIRST_RULE, linkedTexts, readRule, readSettings } from "../../../../web/src/rules/question.ts";
import { commonFault, commonStructure, headline, scoreCells, scoreFacts, scoreRows, sortScores } from "../../../../web/src/rules/words.ts";
import type { Library } from "../../../../web/src/rules/words.ts";

const problem = (name: string, status: ProblemScore["status"], tau: number, ratio?: number, more: Partial<ProblemScore> = {}): ProblemScore =>
  ({ name, status, tau, ...(ratio === undefined ? {} : { ratio, IAE: 2 * ratio, Ms: 1.3, Mt: 1.1 }), ...more }) as ProblemScore;

const answer: ScoreAnswer = {
  name: "mine",
  kept: 2,
  limits_broken: 1,
  unstable: 0,
  no_settings: 1,
  median_ratio: 1.75,
  worst_ratio: 2,
  range: { tau_low: 0.2, tau_high: 0.5, problems: 2, worst_ratio: 2 },
  profile: [
    { ratio: 1.5, share: 0.25 },
    { ratio: 2, share: 0.5 },
  ],
  problems: [
    problem("a/10/pi/1.4", "kept", 0.5, 2),
    problem("a/2/pi/1.4", "kept", 0.2, 1.5),
    problem("b/pi/1.4", "limits-broken", 0.7, 0.8),
    problem("c/pi/1.4", "no-settings", 0, undefined, { why: "There is no figure L." }),
  ],
};

const known = { plant: "e^(-s)/(s+1)", structure: "pi" as const, Ms: 1.4, Mt: 1.4, upper: 3, lower: 2 };
const library: Library = { families: ["a"], problems: Object.fromEntries(answer.problems.map(({ name }) => [name, known])) };

test("formulas become the method formula; empty ones are left out, and Kp is needed", () => {
  const { request, errors } = readRule({ kind: "formula", Kp: " 0.3/(Kv*L) ", Ti: "T", Td: "", name: "mine", structure: "pi", Ms: "1.4", family: "amigo/" }, []);
  assert.deepEqual(errors, []);
  assert.deepEqual(request, { name: "mine", tune: { method: "formula", Kp: "0.3/(Kv*L)", Ti: "T" }, problems: { name: "amigo/", structure: "pi", Ms: 1.4 } });
  assert.deepEqual(readRule({ kind: "formula", Ti: "T" }, []).errors.map(({ pointer }) => pointer), ["/tune/Kp"]);
});

test("a method has its options at their paths, and a text that is no number has its error there", () => {
  const options = fieldsOf({ properties: { tau_c: { type: "number" }, reduction: { type: "object", properties: { method: { type: "string", enum: ["auto", "tangent"] } } } } });
  const texts = { kind: "method", method: "simc", "option.tau_c": "2", "option.reduction.method": "tangent" };
  assert.deepEqual(readRule(texts, options).request, { tune: { method: "simc", tau_c: 2, reduction: { method: "tangent" } }, problems: {} });
  assert.deepEqual(readRule({ ...texts, "option.tau_c": "x" }, options).errors.map(({ pointer }) => pointer), ["/tune/tau_c"]);
});

test("settings are read by the names of their columns, also with a decimal comma; a fault names its line", () => {
  assert.deepEqual(readSettings("Ti,Kp,problem\n1.5,0.4,a/2/pi/1.4\n\n3,0.5,b/pi/1.4\n"), {
    settings: [
      { problem: "a/2/pi/1.4", Kp: 0.4, Ti: 1.5 },
      { problem: "b/pi/1.4", Kp: 0.5, Ti: 3 },
    ],
    lines: [2, 4],
    fault: "",
  });
  assert.deepEqual(readSettings("problem;Kp;Ti;Td\na;0,4;1,5;0,2").settings, [{ problem: "a", Kp: 0.4, Ti: 1.5, Td: 0.2 }]);
  assert.match(readSettings("problem,Kp\na,1").fault, /no column Ti/);
  assert.match(readSettings("problem,Kp,Ti\na,1,2\nb,1,").fault, /^Line 3: Ti is missing/);
  assert.match(readSettings("problem,Kp,Ti").fault, /no settings/);
  const service = [{ pointer: "/settings/1/problem", detail: "The library has no problem \"x\"." }, { pointer: "/problems", detail: "None." }];
  assert.deepEqual(atLines(service, [2, 4]), [{ pointer: "/settings", detail: "Line 4: The library has no problem \"x\"." }, service[1]]);
});

test("a link holds the whole question of the chosen kind, and nothing else", () => {
  const typed = { ...FIRST_RULE, Td: "", method: "simc", "option.tau_c": "3", settings: "problem,Kp,Ti\na,1,2" };
  for (const [kind, names] of [["formula", ["Kp", "Ti"]], ["method", ["method", "option.tau_c"]], ["settings", ["settings"]]] as const) {
    const values = linkedTexts({ ...typed, kind });
    assert.deepEqual(Object.keys(values).sort(), ["Ms", "kind", "structure", ...names].sort(), kind);
    const route = { screen: "rules", values } as const;
    assert.deepEqual(parseRoute(formatRoute(route)), route);
    assert.deepEqual(readRule(values, []).request, readRule({ ...typed, kind }, []).request);
  }
  assert.deepEqual(parseRoute("#/rules"), { screen: "rules", values: {} });
});

test("the profile begins at no problem, jumps at each ratio and stays", () => {
  const { x, y } = profileSteps(answer, 10);
  assert.deepEqual(x, [1, 1.5, 1.5, 2, 2, 10]);
  assert.deepEqual(y, [0, 0, 0.25, 0.25, 0.5, 0.5]);
  // What is beyond the end is not drawn; a ratio within rounding of 1 begins at 1.
  assert.deepEqual(profileSteps(answer, 1.8).y, [0, 0, 0.25, 0.25]);
  assert.deepEqual(profileSteps({ ...answer, profile: [{ ratio: 0.99999, share: 1 }] }, 2), { x: [1, 1, 1, 2], y: [0, 0, 1, 1] });
});

test("rules among many have no name in the legend and at the cursor, but stand in the data", () => {
  const frame = profileFrame([
    { answer, name: "mine", look: 1 },
    { answer, name: "other", look: 2 },
    { answer, name: "one among many", look: null },
  ]);
  assert.deepEqual(frame.panes[0]!.traces.map(({ name }) => name), ["one among many", "mine", "other"]);
  assert.ok(frameToCsv(frame).includes("one among many"));
  const svg = frameToSvg(frame, wholeView(frame), 600, 300, () => "#000");
  assert.ok(svg.includes(">other<") && !svg.includes(">one among many<"));
  const read = readings(frame, { pane: frame.panes[0]! } as never, 3);
  assert.ok(read.some((text) => text.startsWith("mine")) && !read.some((text) => text.startsWith("one")), read.join());
  assert.match(frame.description, /mine solves 50/);
});

test("each judged problem is a point over tau; broken limits are apart", () => {
  const frame = ratioFrame(answer)!;
  const points = frame.panes.map(({ marks = [] }) => marks.flatMap((mark) => (mark.kind === "point" ? [[mark.x, mark.y]] : [])));
  assert.deepEqual(points, [[[0.5, 2], [0.2, 1.5]], [[0.7, 0.8]]]);
  for (const [index, pane] of frame.panes.entries()) for (const [, y] of points[index]!) assert.ok(pane.y.range![0] < y! && y! < pane.y.range![1]);
  assert.deepEqual(frameToRows(frame).rows.map((row) => row.slice(1)), [["ratio, limits hold", 0.5, 2], ["ratio, limits hold", 0.2, 1.5], ["ratio, limits broken", 0.7, 0.8]]);
  assert.equal(ratioFrame({ ...answer, problems: answer.problems.slice(3) }), null);
});

test("rows are sorted by value, names with their numbers, and rows without a value stay last", () => {
  const rows = scoreRows(answer, library);
  const names = (column: string, falling: boolean): string[] => sortScores(rows, { column, falling }).map(({ score }) => score.name);
  assert.deepEqual(names("problem", false), ["a/2/pi/1.4", "a/10/pi/1.4", "b/pi/1.4", "c/pi/1.4"]);
  assert.deepEqual(names("ratio", false), ["b/pi/1.4", "a/2/pi/1.4", "a/10/pi/1.4", "c/pi/1.4"]);
  assert.deepEqual(names("ratio", true), ["a/10/pi/1.4", "a/2/pi/1.4", "b/pi/1.4", "c/pi/1.4"]);
  const [head, ...cells] = scoreCells(rows);
  assert.equal(cells.length, 4);
  assert.deepEqual([cells[0]![head!.indexOf("ratio")], cells[0]![head!.indexOf("lower")], cells[3]![head!.indexOf("why")]], [2, 2, "There is no figure L."]);
});

test("the head counts, and one reason for all problems is told once", () => {
  assert.equal(headline(answer), "mine: the limits hold on 2 of 4 problems.");
  assert.deepEqual(scoreFacts(answer).map(([, value]) => value), ["2", "1", "0", "1", "1.75", "2.00", "0.200 to 0.500"]);
  assert.equal(commonFault(answer), "");
  const none = answer.problems.map(({ name }) => problem(name, "no-settings", 0, undefined, { why: "character 8: ..." }));
  assert.equal(commonFault({ ...answer, kept: 0, limits_broken: 0, no_settings: 4, problems: none }), "character 8: ...");
  assert.equal(commonStructure(answer, library), "pi");
  assert.equal(commonStructure(answer, { ...library, problems: { ...library.problems, "b/pi/1.4": { ...known, structure: "pid_tied" } } }), undefined);
});

const method = (id: string): Method => ({ id, title: id }) as Method;

test("other rules are computed one after the other with the same problems, once; a failed one is asked again", async () => {
  const methods = ["robust", "frontier", "npid_iae", "formula", "simc", "amigo"].map(method);
  assert.deepEqual(comparedRules(methods).map(({ id }) => id), ["simc", "amigo"]);
  const asked: string[] = [];
  let running = 0;
  const others = otherRules(() => methods, async ({ tune, problems }: ScoreRequest) => {
    assert.equal(++running, 1);
    await Promise.resolve();
    running -= 1;
    asked.push(`${tune!.method} ${problems?.Ms}`);
    if (tune!.method === "amigo" && asked.length < 3) throw new Error("Not connected.");
    return answer;
  });
  const steps: number[] = [];
  await others.compute({ Ms: 1.4 }, (done) => steps.push(done));
  assert.deepEqual([asked, steps], [["simc 1.4", "amigo 1.4"], [0, 1, 2]]);
  assert.equal(others.known({ Ms: 1.4 })[1]!.fault, "Not connected.");
  await others.compute({ Ms: 1.4 }, () => undefined);
  assert.deepEqual(asked.slice(2), ["amigo 1.4"]);
  assert.ok(others.known({ Ms: 1.4 }).every((rule) => hasSettings(rule)));
  assert.ok(others.known({ Ms: 2 }).every((rule) => rule.answer === undefined));
});

test("a stopped comparison asks no further rule", async () => {
  const asked: string[] = [];
  const others = otherRules(() => ["simc", "amigo"].map(method), (request) => {
    asked.push(request.tune!.method);
    others.stop();
    return Promise.resolve(answer);
  });
  await others.compute(undefined, () => undefined);
  assert.deepEqual(asked, ["simc"]);
});

test("the rule that holds the limits more often stands first, then the one with the lower median", () => {
  const rule = (name: string, kept: number, median_ratio: number) => ({ method: name, title: name, answer: { ...answer, kept, median_ratio } });
  assert.deepEqual([rule("a", 2, 1.1), rule("b", 3, 2), rule("c", 3, 1.5)].sort(byScore).map(({ method: id }) => id), ["c", "b", "a"]);
});

test("a problem opens with its own limits and filter, beside the scored settings", () => {
  const controller = { form: "ideal", Kp: 1, Ti: 2, Td: 0 } as never;
  const request = designRequest("a/2/pi/1.4", known, problem("a/2/pi/1.4", "kept", 0.2, 1.5, { controller }));
  assert.deepEqual(request, { name: "a/2/pi/1.4", plant: known.plant, tune: [{ method: "robust", controller: "PI", Ms: 1.4, Mt: 1.4 }], controllers: [controller] });
  const tuneOf = (more: object) => (designRequest("x", { ...known, ...more }, answer.problems[3]!).tune as object[])[0];
  assert.deepEqual(tuneOf({ structure: "pid_tied" }), { method: "robust", controller: "PID", Ms: 1.4, Mt: 1.4, filter: { Tf_over_Td: 0.1 } });
  assert.deepEqual(tuneOf({ structure: "pid_fixed", Tf: 0.3 }), { method: "robust", controller: "PID", Ms: 1.4, Mt: 1.4, filter: { Tf: 0.3 } });
});
