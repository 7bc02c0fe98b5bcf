import assert from "node:assert/strict";
import test from "node:test";
import type { CellPart } from "../../../web/src/form/method_formula.ts";
import { formulaLines } from "../../../web/src/form/method_formula.ts";

const math = (rows: string): string => `<math display="block"><mtable>${rows}</mtable></math>`;
const tags = (parts: CellPart[]): string[] => parts.map((part) => (typeof part === "string" ? `"${part}"` : part.tag));

test("a method's table becomes lines of a label and cells, words without their outer spaces", () => {
  const lines = formulaLines(
    math(
      "<mtr><mtd><mtext>PID, Ms\u00a0</mtext><mn>2</mn><mtext>:</mtext></mtd><mtd><mrow><mi>a</mi></mrow></mtd>" +
        "<mtd><mtext>by\u00a0</mtext><msub><mi>T</mi><mi>i</mi></msub><mtext>\u00a0as it is</mtext></mtd></mtr>" +
        "<mtr><mtd></mtd><mtd><msqrt><mi>x</mi></msqrt></mtd></mtr>",
    ),
  )!;
  assert.deepEqual(
    lines.map(({ label, cells }) => [tags(label), ...cells.map(tags)]),
    [
      [['"PID, Ms"', "mn", '":"'], ["mrow"], ['"by"', "msub", '"as it is"']],
      [[], ["msqrt"]],
    ],
  );
});

test("what is no table of lines is no formula of a method", () => {
  for (const text of [undefined, "", "<math><mi>x</mi></math>", math("<mtr><mtd><script>x</script></mtd></mtr>")])
    assert.equal(formulaLines(text), null, text);
});

test("a line without a label has an empty one", () => {
  const [line] = formulaLines(math("<mtr><mtd></mtd><mtd><mi>x</mi></mtd></mtr>"))!;
  assert.deepEqual(line!.label, []);
});
