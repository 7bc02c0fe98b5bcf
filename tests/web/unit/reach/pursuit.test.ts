// A slider that follows a dragged figure: it comes to the value whose figure is the target, for figures that rise or fall.
import assert from "node:assert/strict";
import test from "node:test";
import { pursue } from "../../../../web/src/live/pursuit.ts";
import type { KnownFigure } from "../../../../web/src/live/pursuit.ts";

const CASES: [string, (value: number) => number, boolean][] = [
  ["rising", (value) => 1 + 0.3 * (value - 1) ** 2, true],
  ["falling", (value) => 2 / value ** 1.5, false],
  ["falling, though it was expected to rise", (value) => 3 - value, true],
];

for (const [name, figure, rises] of CASES)
  test(`the target is reached within eight designs: ${name}`, () => {
    for (const wanted of [1.2, 1.5, 1.9, 2.4]) {
      const known: KnownFigure[] = [{ value: 1.6, figure: figure(1.6) }];
      for (let step = 0; step < 8; step += 1) {
        const value = pursue(known, figure(wanted), 1.1, 2.5, rises);
        assert.ok(value >= 1.1 && value <= 2.5);
        known.push({ value, figure: figure(value) });
      }
      assert.ok(Math.abs(known.at(-1)!.value - wanted) < 0.01, `${wanted}: ${known.map(({ value }) => value.toFixed(3)).join(" ")}`);
    }
  });

test("a target out of reach leads to the end of the slider", () => {
  const known: KnownFigure[] = [{ value: 1.6, figure: 1.6 }];
  for (let step = 0; step < 12; step += 1) {
    const value = pursue(known, 9, 1.1, 2.5, true);
    known.push({ value, figure: value });
  }
  assert.equal(known.at(-1)!.value, 2.5);
});
