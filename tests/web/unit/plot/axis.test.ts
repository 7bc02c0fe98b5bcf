import assert from "node:assert/strict";
import test from "node:test";
import { extent, makeScale, ticks, tickText, tickTexts, usableRange } from "../../../../web/src/plot/axis.ts";

test("axes without data have a range and ticks, linear and logarithmic", () => {
  for (const kind of ["linear", "log"] as const) {
    const range = extent([], kind);
    assert.ok(range[0] < range[1]);
    const list = ticks(kind, range, 5);
    assert.ok(list.length >= 3 && list.length <= 20, `${kind}: ${list.join(" ")}`);
  }
  for (const range of [
    [NaN, NaN],
    [Infinity, -Infinity],
    [0, 0],
    [-1, 0],
    [5, 5],
    [1, -1],
    [0, Infinity],
  ] as const) {
    for (const kind of ["linear", "log"] as const) {
      const usable = usableRange(range[0], range[1], kind);
      assert.ok(usable[0] < usable[1] && Number.isFinite(usable[0]) && Number.isFinite(usable[1]));
      assert.ok(ticks(kind, range, 4).every(Number.isFinite));
    }
  }
});

test("an extent leaves out what cannot be drawn", () => {
  assert.deepEqual(extent([[1, null, NaN, 3], [2]], "linear"), [1, 3]);
  assert.deepEqual(extent([[0, -1, 10, 100]], "log"), [10, 100]);
  assert.deepEqual(extent([[0, 10]], "linear", 0.1), [-1, 11]);
});

test("linear ticks are round, inside the range and at least three", () => {
  assert.deepEqual(ticks("linear", [0, 1], 5), [0, 0.2, 0.4, 0.6, 0.8, 1]);
  assert.deepEqual(ticks("linear", [-1.3, 0.2], 3), [-1, -0.5, 0]);
  for (let trial = 0; trial < 200; trial += 1) {
    const lo = Math.sin(trial) * 10 ** ((trial % 13) - 6);
    const hi = lo + (1 + (trial % 7)) * 10 ** ((trial % 9) - 4);
    for (const count of [1, 3, 6]) {
      const list = ticks("linear", [lo, hi], count);
      assert.ok(list.length >= 3 && list.length <= 40, `${lo} ${hi}: ${list.length}`);
      assert.ok(
        list.every((value) => value >= lo - 1e-9 * Math.abs(hi - lo) && value <= hi + 1e-9 * Math.abs(hi - lo)),
      );
    }
  }
});

test("log ticks cover narrow and wide ranges", () => {
  assert.deepEqual(ticks("log", [0.001, 1], 3), [0.001, 0.01, 0.1, 1]);
  // If they do not overlap, 1, 2 and 5; and never only two of them.
  assert.deepEqual(ticks("log", [0.01, 1], 3), [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1]);
  assert.deepEqual(ticks("log", [0.04, 2], 1.6), [0.1, 0.3, 1]);
  assert.ok(ticks("log", [20, 2e8], 4).length >= 3);
  assert.ok(ticks("log", [0.9, 2.1], 3).length >= 3);
  assert.ok(ticks("log", [1e-12, 1e12], 6).length <= 9);
  assert.ok(ticks("log", [1.01, 1.02], 4).length >= 3);
});

test("scales and their inverses agree", () => {
  for (const scale of [makeScale("linear", [-2, 5], [50, 450]), makeScale("log", [0.01, 100], [300, 10])]) {
    for (const share of [0, 0.3, 1]) {
      const value = scale.toValue(50 + share * 200);
      assert.ok(Math.abs(scale.toPixel(value) - (50 + share * 200)) < 1e-9);
    }
  }
});

test("tick texts have no dust and a true minus", () => {
  assert.equal(tickText(-0.30000000000000004), "−0.3");
  assert.equal(tickText(0), "0");
  assert.equal(tickText(1e-4), "1e−4");
  assert.equal(tickText(2e6), "2e6");
});

test("the ticks of an axis are written in one notation", () => {
  assert.deepEqual(tickTexts([0, 50000, 100000]), ["0", "5e4", "1e5"]);
  assert.deepEqual(tickTexts([0.001, 0.1, 10]), ["0.001", "0.1", "10"]);
  assert.deepEqual(tickTexts([1e-4, 0.01, 1]), ["1e−4", "1e−2", "1"]);
});
