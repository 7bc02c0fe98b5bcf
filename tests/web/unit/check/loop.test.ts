// A checked loop in words and pictures.
import assert from "node:assert/strict";
import test from "node:test";
import { loopFrames } from "../../../../web/src/charts/loop_check.ts";
import { frameToSvg } from "../../../../web/src/plot/export.ts";
import { wholeView } from "../../../../web/src/plot/layout.ts";
import { actionWords, changeWords, confidenceWords, gainWords, loopFigures, ownerWords, periodText, timeWords, toneOf, verdictOrder, verdictWords } from "../../../../web/src/words/check.ts";
import { EXPLANATIONS } from "../../../../web/src/words/explained.ts";
import { unitNames } from "../../../../web/src/words/numbers.ts";
import { madeAnswer, madeLoop, madeRank } from "../../made_checks.mjs";

const units = unitNames({ time: "min", y: "degC", u: "%" });
const sticking = madeLoop("FIC-102", "stiction");

test("codes are words; a code that is newer than the page is shown as it is", () => {
  assert.equal(verdictWords("insufficient-data"), "Record not sufficient");
  assert.equal(verdictWords("leaking-valve"), "leaking valve");
  assert.equal(actionWords("return-to-automatic"), "return to automatic");
  assert.equal(ownerWords("nobody"), "–");
  assert.equal(confidenceWords("likely"), "likely");
  assert.ok(verdictOrder("leaking-valve") > verdictOrder("healthy"));
});

test("only a cause that was found has a colour", () => {
  assert.equal(toneOf({ verdict: "healthy", confidence: "likely" }), "good");
  assert.equal(toneOf({ verdict: "tight", confidence: "likely" }), "bad");
  assert.equal(toneOf({ verdict: "undetermined", confidence: "open" }), "open");
});

test("figures have the units of the request, and a reason where there is none", () => {
  const all = loopFigures(sticking, units).flatMap(({ rows }) => rows);
  const of = (label: string) => all.find((row) => row.label === label)!;
  assert.equal(of("Mean error").text, "1.25 °C");
  assert.equal(of("Dead band and stick").text, "3.20 %");
  assert.equal(of("Duration").text, "1440 h");
  assert.equal(of("Output at its upper limit").text, "12.5 %");
  assert.equal(of("Harris range").text, "0.10 to 0.45, dead time 10.0 to 90.0 min");
  assert.equal(of("Idle index").text, "−0.25");
  assert.equal(of("Smallest step of the output").text, "none found");
  assert.deepEqual([of("Following").text, of("Following").why], ["–", "The set point hardly moves."]);
  for (const { about, label } of all) if (about !== null) assert.ok(about in EXPLANATIONS, label);
});

test("a change since an earlier check is a sentence", () => {
  const change = { before: "stiction", now: "healthy", variability_ratio: 0.25, likelihood: 1e-5, significant: true } as const;
  assert.equal(changeWords(change), "The cause was: Sticking valve. The standard deviation of the error is 0.250 times that of then; chance does not explain this.");
  assert.match(changeWords({ ...change, now: "stiction", significant: false }), /^The cause was the same\. .* chance may explain this\.$/);
  assert.equal(changeWords({ ...change, variability_ratio: null, why_null: { variability_ratio: "They cannot be compared." } }), "The cause was: Sticking valve. They cannot be compared.");
});

test("a loop without a valve's fault has no figures of a valve", () => {
  const titles = loopFigures(madeLoop("A", "healthy"), units).map(({ title }) => title);
  assert.deepEqual(titles, ["Error and output", "Service", "Record"]);
  assert.equal(loopFigures(sticking, units)[0]!.title, "Cause");
});

test("the gain is a share and an amount, or nothing", () => {
  assert.equal(gainWords(madeRank(0, 0.5), sticking, units), "50 %: 0.625 °C of a mean error of 1.25 °C");
  assert.equal(gainWords(madeRank(0, null), sticking, units), "");
});

test("times are in the unit in which they are read best", () => {
  for (const [seconds, text] of [[3.09, "3.09 s"], [155, "155 s"], [299, "299 s"], [300, "5.00 min"], [3600, "60.0 min"], [18_000, "5.00 h"]] as const)
    assert.equal(timeWords(seconds), text);
  assert.equal(periodText({ period: 100.4, period_error: 2.13, regularity: 2, share: 0.4, amplitude: 1 }), "100.4 ± 2.1");
});

test("the pictures of a loop have its record, its path and its periods", () => {
  const frames = loopFrames(sticking, units);
  const [measurement, setPoint] = frames.trend!.panes[0]!.traces;
  assert.deepEqual(measurement!.y, sticking.trend.y);
  assert.equal(setPoint!.name, "set point");
  assert.deepEqual(frames.trend!.panes.map(({ y }) => y.label), ["FIC-102 PV (°C)", "FIC-102 OP (%)"]);
  assert.equal(loopFrames({ ...sticking, tag: "refinery_2111LIC31102B" }, units).trend!.panes[0]!.y.label, "PV (°C)");
  const [path] = frames.plane!.panes[0]!.traces;
  assert.deepEqual([path!.x, path!.y, path!.parameter], [sticking.excerpt.u, sticking.excerpt.y, sticking.excerpt.t.map((at: number) => at / 60)]);
  assert.deepEqual(frames.spectrum!.panes[0]!.marks, [{ kind: "upright", value: 100, label: "100 min", role: "limit" }]);
  assert.equal(frames.spectrum!.panes[0]!.traces[0]!.y[6], 80);
  assert.equal(frames.spectrum!.x.kind, "log");
  assert.ok(frames.autocorrelation!.description.includes("periods of 100 min"));
  for (const frame of Object.values(frames)) {
    const svg = frameToSvg(frame!, wholeView(frame!), 480, 300, () => "black");
    assert.ok(!/NaN|Infinity|undefined/.test(svg), frame!.title);
  }
});

test("the band of a valve stands about the middle of the output", () => {
  const [band] = loopFrames(sticking, units).plane!.panes[0]!.marks!;
  // The output swings from 39 to 41; its band is 3.2.
  assert.ok(band!.kind === "band" && Math.abs(band.from - 38.4) < 0.01 && Math.abs(band.to - 41.6) < 0.01, JSON.stringify(band));
  assert.equal(band.label, "dead band and stick 3.20 %");
  assert.deepEqual(loopFrames(madeLoop("A", "tight"), units).plane!.panes[0]!.marks, []);
});

test("a long record is drawn in hours, a short one in its own unit", () => {
  const axis = (last: number, time: string) => {
    const t = sticking.trend.t.map((_: number, index: number) => (index * last) / (sticking.trend.t.length - 1));
    const { x, panes } = loopFrames({ ...sticking, trend: { ...sticking.trend, t } }, unitNames({ time })).trend!;
    return [x.label, panes[0]!.traces[0]!.x.at(-1)];
  };
  assert.deepEqual(axis(86_400, "s"), ["time (h)", 24]);
  assert.deepEqual(axis(1440, "min"), ["time (h)", 24]);
  assert.deepEqual(axis(590, "s"), ["time (s)", 590]);
  assert.deepEqual(axis(48, "h"), ["time (h)", 48]);
});

test("another loop is drawn below on the same clock", () => {
  const started = (tag: string, from: number) => {
    const loop = madeLoop(tag, "tight");
    return { ...loop, shape: { ...loop.shape, dated: true, from } };
  };
  const other = started("B", 1_000_120);
  const frame = loopFrames(started("A", 1_000_000), unitNames({ time: "min" }), other).trend!;
  assert.deepEqual(frame.panes.map(({ y }) => y.label), ["A PV", "A OP", "B PV"]);
  const trace = frame.panes[2]!.traces[0]!;
  // Its first row is two minutes later.
  assert.deepEqual([trace.x[0], trace.y], [2 / 60, other.trend.y]);
  assert.deepEqual(frame.x.range, [frame.panes[0]!.traces[0]!.x[0], frame.panes[0]!.traces[0]!.x.at(-1)]);
  const undated = loopFrames(sticking, units, madeLoop("B", "tight")).trend!;
  assert.equal(undated.panes[2]!.traces[0]!.x[0], 0);
});

test("a record without a set point is drawn without one; one that could not be read not at all", () => {
  const { r: _r, ...bare } = sticking.trend;
  const frames = loopFrames({ ...sticking, trend: bare, excerpt: bare }, units);
  assert.equal(frames.trend!.panes[0]!.traces.length, 1);
  assert.deepEqual(Object.values(loopFrames(madeAnswer().loops[7], units)), [null, null, null, null, null]);
});
