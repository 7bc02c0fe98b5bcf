import assert from "node:assert/strict";
import test from "node:test";
import type { TreeNode } from "../../../web/src/dom.ts";
import { parseMathml, rounded } from "../../../web/src/form/formula.ts";

/** A formula as linear text: fractions as (a)/(b), powers as a^(b). */
function read(tree: TreeNode | string | null): string {
  if (tree === null) return "no formula";
  if (typeof tree === "string") return tree;
  const parts = (tree.children ?? []).map(read);
  if (tree.tag === "mfrac") return `(${parts[0]})/(${parts[1]})`;
  if (tree.tag === "msup") return `${parts[0]}^(${parts[1]})`;
  return parts.join("");
}

test("the service's MathML becomes nodes", () => {
  const formula =
    '<math xmlns="http://www.w3.org/1998/Math/MathML" display="block"><mrow><mi>P</mi><mo>=</mo><mfrac><mrow><mn>2</mn>' +
    "<msup><mi>e</mi><mrow><mo>−</mo><mn>3</mn><mi>s</mi></mrow></msup></mrow><mrow><mi>s</mi></mrow></mfrac></mrow></math>";
  const tree = parseMathml(formula);
  assert.equal(read(tree), "P=(2e^(−3s))/(s)");
  assert.equal(tree?.tag, "math");
  assert.deepEqual(tree?.attributes, { display: "block" });
  assert.equal(read(parseMathml("<math><mo>&lt;</mo><mi>a&amp;b</mi></math>")), "<a&b");
});

test("nothing but formulas comes in", () => {
  for (const text of [
    "<math><script>alert(1)</script></math>",
    '<math><mi href="javascript:alert(1)"><a>x</a></mi></math>',
    "<math><mi>x</math>",
    "<math><mi>x</mi>",
    "<math></math><math></math>",
    "<mi>x</mi></math>",
    "x",
    "<!-- x -->",
    "",
  ])
    assert.equal(parseMathml(text), null, text);
  const tree = parseMathml('<math onclick="alert(1)"><mi style="color:red" onclick="x()">x</mi></math>');
  assert.deepEqual((tree!.children![0] as TreeNode).attributes, {}, "attributes stay outside");
  const signs = parseMathml('<math><mo stretchy="false">(</mo><mo stretchy="false" onclick="x()">(</mo></math>');
  assert.deepEqual(
    signs!.children!.map((sign) => (sign as TreeNode).attributes),
    [{ stretchy: "false" }, {}],
    "but for brackets that must not grow",
  );
});

test("identified numbers are shown with four digits", () => {
  const plant = { type: "transfer_function", num: [1.23456, 2], den: [1, 0.333333], L: 1.000049 };
  assert.deepEqual(rounded(plant), { type: "transfer_function", num: [1.235, 2], den: [1, 0.3333], L: 1 });
});
