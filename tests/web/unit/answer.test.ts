import assert from "node:assert/strict";
import test from "node:test";
import { isOfLoop, namesOf, usualSpan } from "../../../web/src/words/record_names.ts";
import type { ControllerInRecord, Preview, Product } from "../../../web/src/api/types.ts";
import { foundWords } from "../../../web/src/words/found.ts";

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

test("a record of a loop has a set point, a measurement and an output", () => {
  const trend: [string, string, string][] = [["Zeit", "t", ""], ["SP", "r", ""], ["PV", "y", ""], ["OP", "u", ""]];
  assert.ok(isOfLoop(preview(trend)));
  for (const left of ["SP", "PV", "OP"]) assert.ok(!isOfLoop(preview(trend.filter(([heading]) => heading !== left))), left);
});

test("settings found in a record are written with their errors and remarks, in the product's own names where it has them", () => {
  const found = (identified: object, rest: object = {}): ControllerInRecord =>
    ({
      identified: { controller: { form: "ideal", Kp: 0.8, Ti: 60, Td: 0 }, warnings: [], standard_errors: { Kp: 0.01, Ti: 1.5 }, ...identified },
      ...rest,
    }) as unknown as ControllerInRecord;
  const uncertain = found({ warnings: [{ detail: "Kp is uncertain." }] });
  assert.equal(foundWords(uncertain, null, "s"), "From the record: Kp 0.800 ± 0.010, Ti 60.0 ± 1.5 s. Kp is uncertain.");
  assert.equal(foundWords(found({ standard_errors: {} }), null, "min"), "From the record: Kp 0.8, Ti 60 min.");
  const wide = found({ standard_errors: { Kp: 0.1, Ti: 80 } });
  assert.equal(foundWords(wide, null, "s"), "From the record: Kp 0.80 ± 0.10, Ti 60 ± 80 s.");
  const parameters = ["GAIN", "Reset", "FORM"].map((label) => ({ name: label.toUpperCase(), label, low: null, high: null, resolution: null }));
  const product = { action: {}, parameters } as unknown as Product;
  const typing = {
    as_typed: { FORM: "Standard", RESET: "60.0", GAIN: "1.60" },
    units: { GAIN: "%/%", RESET: "s" },
    standard_errors: { RESET: 1.5, GAIN: 0.02 },
  };
  assert.equal(foundWords(found({}, { typing }), product, "s"), "From the record: GAIN 1.60 ± 0.020 %/%, Reset 60.0 ± 1.5 s.");
  assert.equal(
    foundWords(found({}, { not_typed: "The block has no filter." }), product, "s"),
    "From the record: Kp 0.800 ± 0.010, Ti 60.0 ± 1.5 s. The block has no filter.",
  );
});
