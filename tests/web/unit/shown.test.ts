import assert from "node:assert/strict";
import test from "node:test";
import { designBody } from "../../../web/src/api/live.ts";
import type { Entry, Result, TuneEntry, TuningRequest } from "../../../web/src/api/types.ts";
import { proposedEntry } from "../../../web/src/charts/drawn.ts";
import { byAllMethods, rowsOf, tuneEntryOf, withTune } from "../../../web/src/form/tuning_request.ts";
import { designShown, manualShown, questionOf } from "../../../web/src/live/shown.ts";
import { keptOtherwise } from "../../../web/src/words/kept.ts";

const controller = { form: "ideal", Kp: 2, Ti: 10, Td: 2 };
const entry = (method: string, more: Partial<Entry> = {}): Entry => ({ method, controller, ...more });
const region = entry("robust", { over_region: true, title: "Robust optimum (region)" });
const alone = entry("robust", { title: "Robust optimum (model alone)" });
const tune: TuneEntry[] = [{ method: "simc" }, { method: "robust", Ms: 1.5 }, { method: "robust", Ms: 1.7 }];
const request: TuningRequest = { record: { csv: "t,u,y" }, tune, timeout_s: 9, identify: { model: "fopdt" } };
const today = entry("baseline");
const result: Result = {
  controllers: [entry("simc"), region, alone, entry("robust"), today],
  verdict: [{ code: "take", level: "good", text: "", figures: { entry: 3 } }],
  ranking: [3, 1, 2, 0],
  request_hash: "abc",
};

test("both entries of a row that holds on the region belong to that row", () => {
  assert.deepEqual(rowsOf(request, result), [0, 1, 1, 2, -1]);
  for (const index of [1, 2]) assert.deepEqual(tuneEntryOf(request, result, index), tune[1]);
  assert.equal(tuneEntryOf(request, result, 4), null);
  assert.deepEqual(withTune(request, result, 2, { method: "robust", Ms: 2 }).tune, [tune[0], { method: "robust", Ms: 2 }, tune[2]]);
});

test("of a comparison of all methods the moved row alone is asked, and the others stay on the screen", () => {
  const all = { plant: { type: "fopdt" }, tune: [{ method: "all" }] };
  const many = [entry("simc"), ...Array.from({ length: 60 }, (_, k) => entry("lambda", { options: { lambda: k } })), entry("robust"), today];
  const from = { request: all, result: { controllers: many, ranking: [61, 0], verdict: [] }, index: 61 };
  const modified = { method: "robust", Ms: 1.6 };
  for (const held of [true, false]) assert.deepEqual(questionOf(from, modified, held)["tune"], [modified]);
  const shown = designShown(from, modified, { controllers: [entry("robust", { title: "new" }), today], ranking: [0] }, false);
  assert.deepEqual(shown.request.tune, [modified]);
  assert.deepEqual([shown.index, shown.kept, shown.result.controllers.length, shown.whole], [61, 0, 63, true]);
  assert.deepEqual([shown.result.controllers[61]!.title, shown.result.ranking], ["new", undefined]);
  const byHand = manualShown(from, { tune: modified, manual: controller as never }, { controllers: [entry("given"), today] });
  assert.deepEqual([byHand.request.tune, byHand.request.controllers?.length, byHand.kept, byHand.index], [[{ method: "robust" }], 1, 1, 61]);
});

test("a job that was stopped early has entries of the rows that it came to", () => {
  const partial = { ...result, controllers: [region, alone, today] };
  assert.deepEqual(rowsOf(request, partial), [1, 1, -1]);
});

test("a record's model is sent in its place, where the answer tells all of its region", () => {
  const model = { plant: { type: "fopdt", K: 2 }, fit_percent: 97, alternatives: [], candidates: [] };
  assert.deepEqual(designBody(request, { ...result, model }), {
    tune,
    model: { plant: model.plant, fit_percent: 97, alternatives: [] },
  });
  const { alternatives: _of, ...older } = model;
  assert.deepEqual(designBody(request, { ...result, model: older }), { record: request.record, identify: request.identify, tune });
});

test("a frame asks for the turned row alone, and the hand's letting go for the whole request", () => {
  const from = { request, result, index: 2 };
  const modified = { method: "robust", Ms: 1.6 };
  assert.deepEqual(questionOf(from, modified, true)["tune"], [modified]);
  assert.deepEqual(questionOf(from, modified, false)["tune"], [tune[0], modified, tune[2]]);
});

test("a design over the record's region stays one when it is moved", () => {
  const one: TuningRequest = { record: { csv: "t,u,y" }, tune: [{ method: "robust" }] };
  const from = { request: one, result: { controllers: [region, alone, today] }, index: 0 };
  assert.equal(questionOf(from, { method: "robust", Ms: 1.2 }, true)["uncertainty"], "identified");
  assert.equal(questionOf({ ...from, index: 1 }, { method: "robust", Ms: 1.2 }, true)["uncertainty"], undefined);
});

test("all methods are compared at the limits of the design that one comes from", () => {
  const design = (options: Partial<TuneEntry>): TuningRequest => ({ plant: { type: "fopdt", K: 2, T: 10, L: 3 }, tune: [{ method: "robust", ...options }] });
  assert.deepEqual(byAllMethods(design({ Ms: 1.497, Mt: 1.497, Mks: 3 })).tune, [{ method: "all", Ms: 1.497, Mt: 1.497 }]);
  assert.deepEqual(byAllMethods(design({})).tune, [{ method: "all" }]);
  assert.deepEqual(byAllMethods({ tune: [{ method: "simc" }, { method: "robust", Ms: 2 }] }).tune, [{ method: "all" }]);
});

test("an answer of the row alone stands among the others, whose common verdict waits", () => {
  const from = { request, result, index: 2 };
  const answer = { controllers: [{ ...region, title: "new" }, { ...alone, title: "new" }, { ...today, title: "new" }] };
  const shown = designShown(from, { method: "robust", Ms: 1.6 }, answer, true);
  assert.deepEqual(shown.result.controllers.map(({ title }) => title === "new"), [false, true, true, false, true]);
  assert.deepEqual([shown.index, shown.origin, shown.whole], [2, [0, 1, 2, 3, 4], false]);
  const { verdict, ranking, request_hash } = shown.result;
  assert.deepEqual([verdict, ranking, request_hash], [undefined, undefined, undefined]);
});

test("one entry in the place of two, and two in the place of one, are found again", () => {
  const one = designShown({ request, result, index: 1 }, { method: "robust", Ms: 1.1 }, { controllers: [alone, today] }, true);
  assert.deepEqual([one.index, one.origin], [1, [0, 1, 3, 4]]);
  const two = designShown({ request, result, index: 3 }, { method: "robust", Ms: 2 }, { controllers: [region, alone, today] }, true);
  assert.deepEqual([two.index, two.origin], [4, [0, 1, 2, 3, 3, 4]]);
  const whole = { controllers: [entry("simc"), alone, entry("robust"), today], verdict: [], ranking: [1] };
  const letGo = designShown({ request, result, index: 1 }, { method: "robust", Ms: 1.1 }, whole, false);
  assert.deepEqual([letGo.index, letGo.origin, letGo.whole, letGo.result.ranking], [1, [0, 1, 3, 4], true, [1]]);
});

test("the entry that the answer proposes is shown first; of an older one that of its verdict", () => {
  assert.equal(proposedEntry({ ...result, proposed: 1 }), 1);
  assert.equal(proposedEntry(result), 3);
  const { verdict: _told, ...silent } = result;
  assert.equal(proposedEntry(silent), 0);
});

test("what is kept otherwise than it was shown is named", () => {
  const job = (Kp: number, partial = false) =>
    ({ id: "j", status: "succeeded" as const, result: { controllers: [{ method: "robust", controller: { ...controller, Kp } }], partial } });
  assert.equal(keptOtherwise(entry("robust"), job(2), 0), "");
  assert.match(keptOtherwise(entry("robust"), job(2.5), 0), /Kp 2 is now 2\.5; the service/);
  assert.match(keptOtherwise(entry("robust"), job(2.5, true), 0), /stopped before its end/);
});
