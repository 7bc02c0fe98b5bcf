import assert from "node:assert/strict";
import test from "node:test";
import type { TreeNode } from "../../../web/src/dom.ts";
import { lawFormulas } from "../../../web/src/form/law.ts";

/** A formula as text again: fractions with a colon, which separates numerator and denominator. */
function told(tree: TreeNode | string): string {
  if (typeof tree === "string") return tree;
  const parts = (tree.children ?? []).map(told).filter((part) => part !== "" && part !== "\u2062");
  if (tree.tag === "mfrac") return `{${parts[0]} : ${parts[1]}}`;
  return parts.join(tree.tag === "mrow" || tree.tag === "math" ? " " : "");
}

const formulas = (law: string): string[] => (lawFormulas(law) ?? ["none"]).map(told);

test("a product binds tighter than the slash, and the fraction's line replaces brackets", () => {
  assert.deepEqual(formulas("out = gain [ 1 + 1/(Ti s) + Td s/(Tf s + 1) ] (SP - PV)"), [
    "out = gain [ 1 + {1 : Ti s} + {Td s : Tf s + 1} ] ( SP − PV )",
  ]);
  assert.deepEqual(formulas("MV = (1000/P) [ ((1 - alpha) SV - PV) - (Td s/(lambda Td s + 1)) PV ]"), [
    "MV = {1000 : P} [ ( ( 1 − alpha ) SV − PV ) − {Td s : lambda Td s + 1} PV ]",
  ]);
  assert.deepEqual(formulas("u = [ p e - d y ]/255"), ["u = {p e − d y : 255}"]);
});

test("a lead of leads keeps its brackets", () => {
  assert.deepEqual(formulas("OUT = GAIN (1 + 1/(RESET s)) (SP - ((RATE s + 1)/(ALPHA RATE s + 1)) PV)"), [
    "OUT = GAIN ( 1 + {1 : RESET s} ) ( SP − {RATE s + 1 : ALPHA RATE s + 1} PV )",
  ]);
});

test("factors are multiplied, not run together, and powers stand above", () => {
  const [formula] = lawFormulas("y = ALPHA RATE s") ?? [];
  assert.equal(JSON.stringify(formula).split("\u2062").length - 1, 2);
  assert.deepEqual(formulas("y = PV/(1 + Tf s + (Tf s)^2/2)"), ["y = {PV : 1 + Tf s + {( Tf s )2 : 2}}"]);
});

test("several equations, and words among them", () => {
  assert.deepEqual(formulas("pwm = P e - (D s/(Tf s + 1)) y, Tf = dt K1/(1 - K1), pwm from 0 to 255"), [
    "pwm = P e − {D s : Tf s + 1} y",
    "Tf = {dt K1 : 1 − K1}",
    "pwm from 0 to 255",
  ]);
  assert.deepEqual(formulas("out = Gain (b SP - PV) (believed)"), ["out = Gain ( b SP − PV )", "believed"]);
});

test("what is no equation has no formula", () => {
  for (const law of ["a table of gains", "u = (1 + s", "u = 3 * e", "= 2", ""]) assert.equal(lawFormulas(law), null, law);
});
