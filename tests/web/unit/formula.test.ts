import assert from "node:assert/strict";
import test from "node:test";
import type { TreeNode } from "../../../web/src/dom.ts";
import { plantFormula } from "../../../web/src/form/formula.ts";

/** A formula as linear text: fractions as (a)/(b), powers as a^(b). */
function read(tree: TreeNode | string | null): string {
  if (tree === null) return "";
  if (typeof tree === "string") return tree;
  const parts = (tree.children ?? []).map(read);
  if (tree.tag === "mfrac") return `(${parts[0]})/(${parts[1]})`;
  if (tree.tag === "msup") return `${parts[0]}^(${parts[1]})`;
  if (tree.tag === "mtr") return `${parts.join(",")};`;
  return parts.join("");
}

const formula = (plant: Record<string, unknown>): string => read(plantFormula(plant as never));

test("plants are written as in the contract", () => {
  assert.equal(formula({ type: "fopdt", K: 1.25, T: 40, L: 8 }), "P(s)=(1.25e^(−8s))/(40s+1)");
  assert.equal(formula({ type: "fopdt", K: -2, T: -10, L: 0 }), "P(s)=−(2)/(−10s+1)");
  assert.equal(formula({ type: "fopdt", K: 2, T: 0, L: 1 }), "P(s)=2e^(−s)");
  assert.equal(formula({ type: "sopdt", K: 1, T1: 10, T2: 5, L: 2 }), "P(s)=(e^(−2s))/((10s+1)(5s+1))");
  assert.equal(formula({ type: "sopdt", K: 3, T: 10, zeta: 0.4, L: 0 }), "P(s)=(3)/(100s^(2)+8s+1)");
  assert.equal(formula({ type: "ipdt", K: 0.02, L: 8 }), "P(s)=(0.02e^(−8s))/(s)");
  assert.equal(formula({ type: "ipdt", K: 0.02, L: 0, T: 3 }), "P(s)=(0.02)/(s(3s+1))");
  assert.equal(
    formula({ type: "transfer_function", num: [-1, 1], den: [1, 0, 4], L: 1 }),
    "P(s)=((−s+1)e^(−s))/(s^(2)+4)",
  );
  assert.equal(
    formula({ type: "zpk", K: 2, zeros: [], poles: [0, -1, [-2, 1], [-2, -1]] }),
    "P(s)=(2)/(s(s+1)(s^(2)+4s+5))",
  );
  assert.equal(
    formula({ type: "state_space", A: [[-1]], B: [[1]], C: [[2]], D: 0, L: 0 }),
    "P(s)=[2;](sI−[−1;])^(−1)[1;]",
  );
});

test("an incomplete or unknown plant has no formula", () => {
  for (const plant of [
    { type: "fopdt", K: 1 },
    { type: "sopdt", K: 1, T1: 1 },
    { type: "zpk", K: 1 },
    { type: "nonlinear" },
  ])
    assert.equal(plantFormula(plant), null);
});

test("the tree is MathML only", () => {
  const allowed = new Set(["math", "mrow", "mn", "mi", "mo", "mfrac", "msup", "mtable", "mtr", "mtd"]);
  const walk = (tree: TreeNode): void => {
    assert.ok(allowed.has(tree.tag), tree.tag);
    for (const child of tree.children ?? []) if (typeof child !== "string") walk(child);
  };
  walk(
    plantFormula({
      type: "state_space",
      A: [
        [-1, 0],
        [1, -2],
      ],
      B: [[1], [0]],
      C: [[0, 1]],
      D: [[1]],
      L: 2,
    })!,
  );
});
