import assert from "node:assert/strict";
import test from "node:test";
import { namesOf, usualSpan } from "../../../web/src/words/record_names.ts";
import type { Preview } from "../../../web/src/api/types.ts";

const preview = (columns: [heading: string, guess: string, unit: string][]): Pick<Preview, "columns"> => ({
  columns: columns.map(([heading, guess, unit]) => ({ heading, guess, unit })) as Preview["columns"],
});

test("a file names its units, and the tag that its columns share", () => {
  const trend = preview([["Zeit", "t", ""], ["TIC101.SP", "r", "°C"], ["TIC101.PV", "y", "°C"], ["TIC101.OP", "u", "%"]]);
  assert.deepEqual(namesOf(trend), { u: "%", y: "°C", tag: "TIC101" });
  const tags: [string, string, string][] = [
    ["Area 3/FIC-7.PV", "Area 3/FIC-7.OUT", "Area 3/FIC-7"],
    ["LIC_12_PV", "LIC_12_OP", "LIC_12"],
    ["T1", "Q1", ""],
    ["PV", "OP", ""],
    ["TIC101", "TIC101", ""],
    ["TIC101.PV", "TIC102.OP", ""],
  ];
  for (const [y, u, tag] of tags) assert.equal(namesOf(preview([[y, "y", ""], [u, "u", ""]])).tag, tag, `${y}, ${u}`);
  assert.deepEqual(namesOf(preview([["a", "-", ""]])), { u: "", y: "", tag: "" });
});

test("only a unit or values that tell a range propose one", () => {
  assert.deepEqual(usualSpan("%"), [0, 100]);
  assert.deepEqual(usualSpan("", [0, 0.4, null, 1]), [0, 1]);
  assert.equal(usualSpan("", [0, 40]), undefined);
  assert.equal(usualSpan("", []), undefined);
  assert.equal(usualSpan("V", [0, 1]), undefined);
  assert.equal(usualSpan("°C"), undefined);
});
