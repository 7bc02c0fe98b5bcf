// The work list of a check as data, and the map of periods.
import assert from "node:assert/strict";
import test from "node:test";
import { eventsIn } from "../../../../web/src/api/events.ts";
import { earlierOf } from "../../../../web/src/check/earlier.ts";
import { counts, mendedBefore, shownRows, workColumns, workCsv, workRows } from "../../../../web/src/check/columns.ts";
import { alongAxis, clusterOf, periodGroups, periodOf, periodRange, periodTicks, ridge } from "../../../../web/src/check/periods.ts";
import { WHOLE_LIST } from "../../../../web/src/routes.ts";
import { verdictOrder } from "../../../../web/src/words/check.ts";
import { unitNames } from "../../../../web/src/words/numbers.ts";
import { madeAnswer, madeLoop } from "../../made_checks.mjs";

const answer = madeAnswer();
const rows = workRows(answer);
const columns = workColumns(rows, unitNames({ time: "s" }));
const shown = (change: object) => shownRows(rows, columns, { ...WHOLE_LIST, ...change }).map(({ loop }) => loop.tag);
const figure = (tag: string, id: string) => columns.find((column) => column.id === id)!.figure(rows.find(({ loop }) => loop.tag === tag)!);

test("the rows are in the service's order, and back in it after another one", () => {
  const inOrder = answer.ranking.map(({ loop }: { loop: number }) => answer.loops[loop].tag);
  assert.deepEqual(shown({}), inOrder);
  assert.deepEqual(shown({ sort: "-rank" }), [...inOrder].reverse());
  assert.deepEqual(shown({ sort: "unknown" }), inOrder);
});

test("figures sort with missing ones last in both directions, names by their numbers", () => {
  assert.deepEqual(shown({ sort: "-gain" }).slice(0, 4), ["FIC-102", "PIC-105", "TIC-104", "FIC-101"]);
  assert.deepEqual(shown({ sort: "gain" }).slice(0, 4), ["FIC-101", "TIC-104", "PIC-105", "FIC-102"]);
  assert.deepEqual(shown({ sort: "-period" }).slice(0, 4), ["LIC-103", "FIC-102", "AIC-107", "PIC-105"]);
  assert.deepEqual(shown({ sort: "loop" })[0], "AIC-107");
  assert.deepEqual(shown({ sort: "-money" }).slice(0, 2), ["PIC-105", "FIC-102"]);
  assert.deepEqual(shown({ sort: "record" }).at(-1), "TIC-108");
  assert.deepEqual(shown({ sort: "cause" }).at(-1), "FIC-101", "healthy loops are last");
});

test("a cause, an owner and a part of the name narrow the list together", () => {
  assert.deepEqual(shown({ cause: "tight" }), ["PIC-105"]);
  assert.deepEqual(shown({ owner: "control" }), ["PIC-105", "TIC-104", "AIC-107", "TIC-108"]);
  assert.deepEqual(shown({ text: "tic1" }), ["TIC-104", "TIC-108"], "tags are written with and without hyphens");
  assert.deepEqual(shown({ owner: "control", text: "TIC-1", cause: "sluggish" }), ["TIC-104"]);
  assert.deepEqual(shown({ cause: "frozen" }), []);
});

test("figures are those of the answer, with the reason where there is none", () => {
  assert.deepEqual(figure("FIC-102", "gain"), { text: "50", why: "" });
  assert.deepEqual(figure("AIC-107", "gain"), { text: "–", why: "The cause is open." });
  assert.equal(figure("FIC-102", "cause").text, "Sticking valve, sure");
  assert.equal(figure("FIC-102", "effort").text, "work on the plant");
  assert.equal(figure("FIC-102", "limit").text, "12.5");
  assert.equal(figure("FIC-101", "period").why, "No regular oscillation was found.");
  assert.equal(figure("TIC-108", "record").text, "not sufficient");
  assert.equal(figure("AIC-107", "automatic").why, "The record has no column of the mode.");
});

test("without modes there is no share in automatic, without weights no money", () => {
  const ids = (loops: unknown[]) => workColumns(workRows({ ...answer, loops, ranking: [{ loop: 0, gain: 1, share: 0.2, money: null, effort: 1 }] } as never), unitNames(undefined)).map(({ id }) => id);
  assert.ok(!ids([madeLoop("A", "tight", { automatic: null })]).includes("automatic"));
  assert.ok(!ids([madeLoop("A", "tight")]).includes("money"));
  assert.ok(ids([madeLoop("A", "tight")]).includes("automatic"));
  assert.ok(columns.some(({ id }) => id === "money"));
});

test("causes are counted in a fixed order, and each loop once", () => {
  const numbers = counts(rows, ({ loop }) => loop.cause.verdict, verdictOrder);
  assert.deepEqual(numbers.map(([code]) => code), ["stiction", "tight", "sluggish", "external", "manual", "undetermined", "insufficient-data", "healthy"]);
  assert.equal(numbers.reduce((sum, [, count]) => sum + count, 0), rows.length);
});

test("a comparison with an earlier check adds its cause and the change of the error, with the reason where there is none", () => {
  const change = { before: "stiction", now: "healthy", variability_ratio: 0.25, likelihood: 1e-5, significant: true };
  const changes = [
    { loop: 0, change },
    { loop: 1, change: { ...change, now: "stiction", variability_ratio: 1.2, likelihood: 0.4, significant: false } },
    { loop: 7, change: { ...change, variability_ratio: null, likelihood: null, significant: false, why_null: { variability_ratio: "The two records cannot be compared." } } },
  ];
  const compared = workRows({ ...answer, changes } as never);
  const all = workColumns(compared, unitNames({ time: "s" }), "Unit 21 in May");
  assert.deepEqual(all.map(({ id }) => id).slice(0, 4), ["cause", "before", "error", "significant"]);
  assert.ok(!columns.some(({ id }) => id === "before"), "without a comparison there are no such columns");
  const texts = (tag: string) => all.slice(1, 4).map((column) => column.figure(compared.find(({ loop }) => loop.tag === tag)!).text);
  assert.deepEqual(texts("FIC-101"), ["Sticking valve", "0.250", "yes"]);
  assert.deepEqual(texts("FIC-102"), ["Sticking valve", "1.20", "no"]);
  assert.deepEqual(texts("TIC-108"), ["Sticking valve", "–", "–"]);
  assert.deepEqual(texts("TIC-104"), ["–", "–", "–"], "the earlier check does not have it");
  const why = (tag: string) => all[2]!.figure(compared.find(({ loop }) => loop.tag === tag)!).why;
  assert.equal(why("TIC-108"), "The two records cannot be compared.");
  assert.equal(why("TIC-104"), "The earlier check has no loop with this name.");
  const order = shownRows(compared, all, { ...WHOLE_LIST, sort: "-error" }).map(({ loop }) => loop.tag);
  assert.deepEqual(order.slice(0, 2), ["FIC-102", "FIC-101"]);
  assert.match(workCsv(compared, all, compared), /^#,Loop,Cause,Cause before,Error now\/before,Significant,/);
});

test("a disturbed loop names the loop to mend first", () => {
  const disturbed = rows.find(({ loop }) => loop.tag === "LIC-103")!;
  assert.equal(mendedBefore(disturbed, rows)!.loop.tag, "FIC-102");
  assert.equal(mendedBefore(rows[0]!, rows), null);
});

test("the list as CSV has the shown rows with figures that a spreadsheet reads", () => {
  const awkward = { ...rows[0]!, loop: { ...rows[0]!.loop, tag: 'A "b", c' } };
  const lines = workCsv([awkward, rows[4]!], columns, rows).split("\r\n");
  assert.equal(lines.length, 4);
  assert.match(lines[0]!, /^#,Loop,Cause,What to do,Owner,Gain \(%\),.*,Mend first,Sentence$/);
  assert.match(lines[1]!, /^1,"A ""b"", c","Sticking valve, sure",repair the valve,instruments,50,/);
  assert.ok(lines[2]!.includes(",FIC-102,What to do about external."), lines[2]);
  assert.ok(!lines[2]!.includes("–"));
});

test("the map of periods has the clusters of the answer, then the other loops by their period", () => {
  const groups = periodGroups({ ...answer, clusters: answer.clusters.slice(0, 1) });
  assert.deepEqual(groups.map(({ places }) => places), [[1, 2], [4, 6]]);
  assert.deepEqual(groups.map(({ cluster }) => cluster?.source ?? null), [1, null]);
  assert.deepEqual(periodGroups({ ...answer, loops: [answer.loops[0]], clusters: [] }), []);
  assert.equal(clusterOf(answer, 2), answer.clusters[0]);
  assert.equal(clusterOf(answer, 0), null);
});

test("the axis of periods holds every period, with round figures of a clock", () => {
  const range = periodRange(answer)!;
  for (const { shape } of answer.loops) if (shape.period > 0) assert.ok(alongAxis(shape.period, range) > 0 && alongAxis(shape.period, range) < 1);
  assert.equal(alongAxis(range[0], range), 0);
  assert.equal(alongAxis(range[1], range), 1);
  assert.equal(periodRange({ ...answer, loops: [answer.loops[0]] }), null);
  assert.deepEqual(periodTicks([8, 400], 8).map(([, name]) => name), ["10 s", "20 s", "30 s", "1 min", "2 min", "5 min"]);
  const ticks = periodTicks([1, 200_000], 6);
  assert.ok(ticks.length <= 6 && ticks.length > 3);
  assert.ok(ticks.every(([tick], index) => index === 0 || tick > ticks[index - 1]![0]));
});

test("the map of a batch has periods without spectra, in the unit of its times", () => {
  const bare = answer.loops.map(({ shape: _shape, ...loop }: { shape: unknown }) => loop);
  const batch = { ...answer, loops: bare, units: { time: "min" } } as never;
  assert.equal(periodOf(batch, 1), 6000);
  assert.equal(periodOf(batch, 0), 0);
  assert.deepEqual(periodGroups(batch).map(({ places }) => places), [[1, 2], [4, 6]]);
  assert.deepEqual(ridge(undefined, [1, 100]), []);
});

test("a spectrum is drawn where its periods are", () => {
  const range = periodRange(answer)!;
  const curve = ridge(answer.loops[1].shape, range);
  const [at, power] = curve.reduce((best, point) => (point[1] > best[1] ? point : best));
  assert.equal(power, 1);
  assert.ok(Math.abs(at - alongAxis(100, range)) < 0.08);
  assert.ok(curve.every(([place]) => place >= 0 && place <= 1));
  assert.deepEqual(ridge({ ...answer.loops[1].shape, spectrum: [0, 0] }, range), []);
});

test("events are read whole, however the stream is cut", () => {
  const stream = 'retry: 2000\n\nevent: progress\nid: 1\ndata: {"fraction":0.5}\n\n: comment\n\nevent: done\ndata: {}\n\n';
  for (let cut = 0; cut <= stream.length; cut += 1) {
    const first = eventsIn(stream.slice(0, cut));
    const second = eventsIn(first.rest + stream.slice(cut));
    assert.deepEqual([...first.events, ...second.events], [
      { name: "progress", data: '{"fraction":0.5}' },
      { name: "done", data: "{}" },
    ]);
    assert.equal(second.rest, "");
  }
});

test("earlier checks are jobs and batches of them, the newest first", () => {
  const job = (id: string, more: object) => ({ id, name: null, status: "succeeded", created_at: "2026-05-04T06:00:00Z", outline: { method: "check", check: { loops: 1, tag: "A", verdict: "tight", action: "retune" } }, ...more });
  const batch = (id: string, more: object = {}) => ({ id, name: "Unit 22", total: 500, created_at: "2026-05-04T06:30:00Z", ...more });
  const tuned = { outline: { method: "robust" } };
  const found = earlierOf(
    [job("j1", { name: "Unit 21" }), job("j0", { created_at: "2026-05-04T05:30:00Z" }), job("j2", tuned), job("j3", { created_at: "2026-05-04T05:00:00Z", outline: { method: "check", check: { loops: 3, tag: "A", verdict: "tight", action: "retune" } } })] as never,
    [[batch("b1"), job("x", {})], [batch("b2"), job("y", tuned)], [batch("b3"), undefined], [batch("b4567890abc", { name: null, created_at: "2026-05-04T04:00:00Z" }), job("z", {})]] as never,
    Date.parse("2026-05-04T07:00:00Z"),
  );
  assert.deepEqual(found, [
    { of: { kind: "batch", id: "b1" }, name: "Unit 22", words: "500 loops, 30 min" },
    { of: { kind: "job", id: "j1" }, name: "Unit 21", words: "tuned too tight, 1 h" },
    { of: { kind: "job", id: "j0" }, name: "A", words: "tuned too tight, 1 h" },
    { of: { kind: "job", id: "j3" }, name: "Check j3", words: "3 loops, first A, tuned too tight, 2 h" },
    { of: { kind: "batch", id: "b4567890abc" }, name: "Batch b4567890", words: "500 loops, 3 h" },
  ]);
});
