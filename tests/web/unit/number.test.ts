import assert from "node:assert/strict";
import test from "node:test";
import { parseMatrix, parseNumber, parseNumbers, parseRanges, parseRoots } from "../../../web/src/form/number.ts";
import { figureUnit, unitIn } from "../../../web/src/words/figure_units.ts";
import { figureGroups } from "../../../web/src/words/figures.ts";

const value = (text: string): unknown => {
  const parsed = parseNumber(text, "K");
  return parsed.ok ? parsed.value : parsed.sentence;
};

test("numbers are read with a point, a comma, an exponent, and a true minus", () => {
  assert.equal(value("1.25"), 1.25);
  assert.equal(value("2,5"), 2.5);
  assert.equal(value("1e-3"), 1e-3);
  assert.equal(value("−4"), -4);
  assert.equal(value("  +.5 "), 0.5);
  assert.equal(value("1,5E2"), 150);
});

test("what is not a number is refused with its text and a cure", () => {
  for (const text of ["1,2,3", "abc", "1.2.3", "--1", "0x10", "Infinity", "NaN", "1e", "1 2", "1.234,5"]) {
    assert.match(String(value(text)), /is not a number\. Write for example/, text);
    assert.ok(String(value(text)).includes(text));
  }
  assert.match(String(value("")), /K is empty/);
  assert.match(String(value("1e999")), /too large/);
});

test("lists are separated by spaces, semicolons or commas with a space; a bare comma is asked about", () => {
  const list = (text: string): unknown => {
    const parsed = parseNumbers(text, "den");
    return parsed.ok ? parsed.value : parsed.sentence;
  };
  assert.deepEqual(list("1 3 3 1"), [1, 3, 3, 1]);
  assert.deepEqual(list("[1, 2.5, 1]"), [1, 2.5, 1]);
  assert.deepEqual(list("1;2"), [1, 2]);
  assert.deepEqual(list("2,5 1"), [2.5, 1]);
  assert.match(String(list("1,2")), /may be one number or several/);
  assert.match(String(list("1 x")), /"x" is not a number/);
  assert.match(String(list(" ")), /empty/);
});

test("matrices have rows of one length", () => {
  const matrix = (text: string): unknown => {
    const parsed = parseMatrix(text, "A");
    return parsed.ok ? parsed.value : parsed.sentence;
  };
  assert.deepEqual(matrix("-1 0; 1 -2"), [
    [-1, 0],
    [1, -2],
  ]);
  assert.deepEqual(matrix("1\n0"), [[1], [0]]);
  assert.deepEqual(matrix("0,5"), [[0.5]]);
  assert.match(String(matrix("1 2; 3")), /Row 2 of A has 1 numbers, the first has 2/);
});

test("roots are real, complex, or pairs", () => {
  const roots = (text: string): unknown => {
    const parsed = parseRoots(text, "poles");
    return parsed.ok ? parsed.value : parsed.sentence;
  };
  assert.deepEqual(roots(""), []);
  assert.deepEqual(roots("-1 -2±1i"), [-1, [-2, 1], [-2, -1]]);
  assert.deepEqual(roots("-0,5+2i; -0,5-2j"), [
    [-0.5, 2],
    [-0.5, -2],
  ]);
  assert.deepEqual(roots("2i -i"), [
    [0, 2],
    [0, -1],
  ]);
  assert.deepEqual(roots("-1 + 2i"), [[-1, 2]]);
  assert.match(String(roots("-1 q")), /"q" is not a number/);
});

test("ranges are read by name, and a bad one is shown as typed", () => {
  assert.deepEqual(parseRanges("K 0.8 1.2; L 0,9 1.2", "uncertainty"), {
    ok: true,
    value: { K: [0.8, 1.2], L: [0.9, 1.2] },
  });
  for (const text of ["K 0.8", "0.8 1.2", "K 0.8 1.2 1.3", "K low high"]) {
    const read = parseRanges(text, "uncertainty");
    assert.equal(read.ok, false, text);
    assert.ok(!read.ok && read.sentence.includes(`"${text}"`), text);
  }
});

const named = { time: "s", u: "%", y: "°C" };

test("a unit of the contract is written in the user's names", () => {
  const written = ["y time", "y^2 time", "y time^2", "u/y", "rad/time", "deg", "%", "y/time"].map((unit) => unitIn(unit, named));
  assert.deepEqual(written, ["°C s", "°C² s", "°C s²", "%/°C", "rad/s", "°", "%", "°C/s"]);
  assert.equal(unitIn("y^2 time", { ...named, y: "m³/h" }), "(m³/h)² s");
  assert.equal(unitIn("u/y", { ...named, y: "%" }), "", "of the same unit: a plain number");
});

test("a name that is not known is left out", () => {
  const open = { time: "min", u: "", y: "" };
  assert.deepEqual(["y^2 time", "y time", "u/y", "u"].map((unit) => unitIn(unit, open)), ["min", "min", "", ""]);
  assert.equal(unitIn("u/y", { ...open, y: "°C" }), "1/°C");
});

test("every figure with a dimension shows its unit", () => {
  assert.equal(figureUnit("Robustness", "Ms", named), "");
  const bare = figureGroups(named, true, true).flatMap(({ rows }) => rows.filter(({ label }) => !label.includes("(")).map(({ label }) => label));
  assert.deepEqual(bare, ["Ms", "Mt", "Gain margin", "Worst Ms", "Filter", "b", "c", "Action", "Gain margin, low"]);
});
