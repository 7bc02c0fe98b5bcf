import assert from "node:assert/strict";
import test from "node:test";
import type { Plant } from "../../../web/src/api/types.ts";
import {
  equationsAddress,
  equationsOfAddress,
  readEquations,
  writeEquations,
} from "../../../web/src/form/equations.ts";
import type { EquationTexts } from "../../../web/src/form/equations.ts";
import { matchPointer } from "../../../web/src/form/errors.ts";
import { formatRoute, parseRoute } from "../../../web/src/routes.ts";
import { plantTitle, plantWords } from "../../../web/src/words/plant.ts";

const reactor: Plant = {
  type: "nonlinear",
  states: { CA: 0.52, T: 398.97 },
  parameters: { k0: 4.71e8, ER: 8000, a: "2*ER" },
  equations: { CA: "1 - CA - k0*exp(-ER/T)*CA", T: "400 - T + (Tj - T)" },
  input: { name: "Tj", nominal: 493.87, min: 300, max: 600 },
  output: "T",
  L: 0.1,
};
const texts = (): EquationTexts => writeEquations(reactor)!;

test("a plant becomes texts and the texts the same plant", () => {
  assert.deepEqual(readEquations(texts()), { plant: reactor, errors: [] });
  assert.equal(texts().parameters[0]!.value, "4.71e8");
  const small: Plant = {
    type: "nonlinear",
    states: { h: 1 },
    parameters: {},
    equations: { h: "q - sqrt(h)" },
    input: { name: "q", nominal: 1 },
    output: "h",
  };
  assert.deepEqual(readEquations(writeEquations(small)!), { plant: small, errors: [] });
});

test("an address keeps the texts, whatever stands in them", () => {
  const given = texts();
  given.states[0]!.rate = "CA > 1 ? 50% & +1 : CA^2 / T";
  const route = parseRoute(formatRoute({ screen: "new", plant: "nonlinear", values: equationsAddress(given) }));
  assert.equal(route.screen, "new");
  assert.deepEqual(route.screen === "new" && equationsOfAddress(route.values), given);
});

test("plants of other kinds, or with parts that have no field, are not taken", () => {
  assert.equal(writeEquations({ type: "fopdt", K: 1, T: 1, L: 1 }), null);
  assert.equal(writeEquations({ ...reactor, uncertainty: {} }), null);
});

test("numbers are read as people type them, expressions kept on one line, empty rows left out", () => {
  const given = texts();
  given.states[0]!.value = "0,52";
  given.states[1]!.rate = "400 - T\n  + (Tj - T)";
  given.parameters = [
    { name: " k ", value: "1e-3" },
    { name: "", value: " " },
    { name: "c", value: " k / 2 " },
  ];
  given.single.L = "";
  given.single.min = "";
  const { plant, errors } = readEquations(given);
  assert.deepEqual(errors, []);
  assert.deepEqual(plant["states"], { CA: 0.52, T: 398.97 });
  assert.deepEqual(plant["parameters"], { k: 0.001, c: "k / 2" });
  assert.equal((plant["equations"] as Record<string, string>)["T"], "400 - T + (Tj - T)");
  assert.deepEqual(plant["input"], { name: "Tj", nominal: 493.87, max: 600 });
  assert.ok(!("L" in plant));
});

test("what is missing is said at its field", () => {
  const given = texts();
  given.states.push({ name: "T", value: "1", rate: "0" }, { name: "", value: "1", rate: "0" });
  given.states[0]!.value = "half";
  given.states[1]!.rate = "";
  given.parameters.push({ name: "b", value: "" });
  given.single.nominal = "x";
  given.single.output = " ";
  assert.deepEqual(
    readEquations(given).errors.map(({ pointer }) => pointer),
    [
      "/plant/#/states/2",
      "/plant/#/states/3",
      "/plant/states/CA",
      "/plant/equations/T",
      "/plant/parameters/b",
      "/plant/input/nominal",
      "/plant/output",
    ],
  );
  assert.match(readEquations(given).errors[0]!.detail, /^T is used twice/);
  const empty = readEquations({ states: [], parameters: [], single: given.single });
  assert.match(empty.errors[0]!.detail, /no state/);
});

test("the service's pointers lead to the row they are about", () => {
  const known = ["/plant/states/CA", "/plant/equations/CA", "/plant/states/T", "/plant/equations/T", "/plant/output"];
  assert.equal(matchPointer("/plant/equations/T", known), 3);
  assert.equal(matchPointer("/plant/states/T", known), 2);
  assert.equal(matchPointer("/plant/states", known), 0);
  assert.equal(matchPointer("/plant/equations", known), 1);
});

test("a plant of equations is named by its states, input and output", () => {
  assert.equal(plantTitle("nonlinear"), "nonlinear equations");
  assert.equal(plantWords(reactor, { time: "min", u: "K", y: "K" }), "2 states, from Tj to T, L 0.1 min");
  const units = { time: "min", u: "", y: "pH" };
  assert.equal(plantWords({ ...reactor, output: "6 - log(T)", L: 0 }, units), "2 states, from Tj to y");
});
