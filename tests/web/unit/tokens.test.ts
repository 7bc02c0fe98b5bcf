import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

const css = readFileSync(path.join(process.env["TUNEWRIGHT_ROOT"]!, "web/src/style/tokens.css"), "utf8");
const pairs = [...css.matchAll(/--([\w-]+):\s*light-dark\((#[0-9a-f]{6}), (#[0-9a-f]{6})\)/g)];
const palettes = [2, 3].map((at) => Object.fromEntries(pairs.map((pair) => [pair[1]!, pair[at]!])));

/** Contrast ratio as WCAG 2.2 defines it. */
function contrast(a: string, b: string): number {
  const luminance = (colour: string): number => {
    const [r, g, blue] = [1, 3, 5].map((at) => {
      const channel = parseInt(colour.slice(at, at + 2), 16) / 255;
      return channel <= 0.04045 ? channel / 12.92 : ((channel + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r! + 0.7152 * g! + 0.0722 * blue!;
  };
  const [high, low] = [luminance(a), luminance(b)].sort((x, y) => y - x);
  return (high! + 0.05) / (low! + 0.05);
}

test("every colour stands once, for light and for dark", () => {
  const names = [...css.matchAll(/--([\w-]+):\s*light-dark/g)].map((match) => match[1]!);
  assert.ok(names.length >= 18);
  assert.deepEqual(names, [...new Set(names)]);
  assert.deepEqual(names, pairs.map((pair) => pair[1]!));
});

test("text, lines and borders have enough contrast on both palettes", () => {
  for (const colours of palettes) {
    for (const name of [
      "text",
      "muted",
      "accent",
      "good",
      "warn",
      "bad",
      "series-1",
      "series-2",
      "series-3",
      "series-4",
      "setpoint",
      "limit",
    ]) {
      assert.ok(contrast(colours[name]!, colours["surface"]!) >= 4.5, `${name} ${colours[name]}`);
    }
    for (const name of ["text", "muted"]) assert.ok(contrast(colours[name]!, colours["bg"]!) >= 4.5, `${name} on bg`);
    assert.ok(contrast(colours["on-accent"]!, colours["accent"]!) >= 4.5);
    for (const name of ["control", "focus"]) assert.ok(contrast(colours[name]!, colours["surface"]!) >= 3, name);
  }
});
