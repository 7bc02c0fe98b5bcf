// Words that users would not understand, which the page must not contain.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import test from "node:test";
import { fileURLToPath } from "node:url";

const FORBIDDEN = [
  "limit that stops it",
  "limits stop it",
  ") has room.",
  "of integrated error",
  "times less",
  "that this one may be",
  "that the record leaves possible",
  "to mend`",
  "time of the row above",
  "lies on a grid",
  "for one unit of u",
  "as usual (",
  "Relay looks every",
  "worth making",
  "tell noise_std",
  "int (u_nl",
  "This could not be done",
  "The valve moves",
];

// The test runs as a bundle in build/web-unit-tests.
const SOURCES = fileURLToPath(new URL("../../web/src", import.meta.url));

test("no sentence of the page falls back into old words", () => {
  const files = readdirSync(SOURCES, { recursive: true, encoding: "utf8" }).filter((name) => name.endsWith(".ts"));
  assert.ok(files.length > 50);
  for (const file of files) {
    const source = readFileSync(`${SOURCES}/${file}`, "utf8");
    for (const phrase of FORBIDDEN) assert.ok(!source.includes(phrase), `${file} says "${phrase}"`);
  }
});
