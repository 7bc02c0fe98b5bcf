// The search over the whole page, and the keys that the help lists.
import assert from "node:assert/strict";
import test from "node:test";
import { PLOT_KEYS } from "../../../../web/src/plot/keys.ts";
import { search } from "../../../../web/src/reach/finds.ts";
import type { Find, FindKind } from "../../../../web/src/reach/finds.ts";
import { KEY_GROUPS } from "../../../../web/src/reach/keys.ts";

const find = (kind: FindKind, text: string, aside = "", words = ""): Find => ({ id: text, kind, text, aside, words, go: () => undefined });

const ALL = [
  find("method", "SIMC", "simc", "Skogestad, Journal of Process Control, 2003"),
  find("controller", "Rockwell PIDE", "", "rockwell-pide ControlLogix Studio 5000"),
  find("job", "Ofen 3, Hägglund"),
  find("action", "Compare all methods", "Design"),
  find("screen", "Compare"),
  find("document", "Tuning methods", "", "methods"),
];
const texts = (typed: string): string[] => search(ALL, typed).map(({ text }) => text);

test("every typed word must be found, in the text, beside it or in its words", () => {
  assert.deepEqual(texts("skogestad simc"), ["SIMC"]);
  assert.deepEqual(texts("controllogix"), ["Rockwell PIDE"]);
  assert.deepEqual(texts("controllogix simc"), []);
});

test("accents, capitals and signs do not matter", () => {
  for (const typed of ["HAGGLUND", "Hägglund", "haegglund", "Ha\u0308gg", "ofen haegglund"]) assert.deepEqual(texts(typed), ["Ofen 3, Hägglund"], typed);
  assert.deepEqual(texts("studio-5000"), ["Rockwell PIDE"]);
});

test("a text that begins with the typed one comes first, then one that has its words", () => {
  assert.deepEqual(texts("compare"), ["Compare all methods", "Compare"]);
  assert.deepEqual(texts("methods"), ["Compare all methods", "Tuning methods"]);
  assert.deepEqual(texts("tun"), ["Tuning methods"]);
});

test("with nothing typed: screens, jobs and actions", () => {
  assert.deepEqual(texts("  "), ["Compare", "Ofen 3, Hägglund", "Compare all methods"]);
});

test("the help lists the keys of a plot as the plot itself names them", () => {
  assert.ok(KEY_GROUPS.some(({ keys }) => keys === PLOT_KEYS));
});
