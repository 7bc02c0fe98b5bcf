import assert from "node:assert/strict";
import test from "node:test";
import { codePath } from "../../../web/src/api/products.ts";
import type { AsEntered, Implemented, Product, ProductParameter, ProductSummary, Robustness } from "../../../web/src/api/types.ts";
import { readSettings, settingFields, typedSettings } from "../../../web/src/form/product_settings.ts";
import { readSpan } from "../../../web/src/form/span_fields.ts";
import { withImplement } from "../../../web/src/form/tuning_request.ts";
import {
  implementOf,
  inUnits,
  mineOfRequest,
  missingOf,
  named,
  readMine,
  sameImplement,
  typedInto,
} from "../../../web/src/my_controller.ts";
import type { MyController } from "../../../web/src/my_controller.ts";
import {
  builtRows,
  builtTroubles,
  differenceSentence,
  evidenceSentence,
  findProducts,
  needSentence,
  productTitle,
  rangeWords,
  samplingSentences,
  splitNotes,
  typedRows,
  typedText,
} from "../../../web/src/words/products.ts";

const summary = (id: string, maker: string, name: string, parameters: string[], families: string[] = []): ProductSummary => ({
  id,
  maker,
  name,
  families,
  form: "ideal",
  needs: [],
  evidence: "read",
  parameters,
});

const LIST = [
  summary("siemens_pid_compact", "Siemens", "PID_Compact (S7-1200/1500)", ["Gain", "Ti"], ["TIA Portal"]),
  summary("emerson_deltav_series", "Emerson", "DeltaV PID, FORM Series", ["GAIN", "RESET"]),
  summary("emerson_deltav_standard", "Emerson", "DeltaV PID, FORM Standard", ["GAIN", "BETA"]),
  summary("foxboro_pid", "Foxboro", "I/A Series PID block", ["PBAND", "INT"]),
  summary("klipper", "Klipper", "Klipper heater (control: pid)", ["pid_Kp"]),
];

const found = (typed: string): string[] => findProducts(LIST, typed).map((product) => product.id);

test("a product is found by words of maker, name, id and parameters, in any order and case", () => {
  assert.deepEqual(found("series emerson"), ["emerson_deltav_series"]);
  assert.deepEqual(found("deltav"), ["emerson_deltav_series", "emerson_deltav_standard"]);
  assert.deepEqual(found("PID-compact s7"), ["siemens_pid_compact"]);
  assert.deepEqual(found("pband"), ["foxboro_pid"]);
  assert.deepEqual(found("tia"), ["siemens_pid_compact"], "by the maker's family");
  assert.deepEqual(found("honeywell"), []);
  assert.equal(found("").length, LIST.length);
  assert.equal(found("")[0], "emerson_deltav_series", "by maker");
});

test("a product is found by the family or the tool by which its users know it, before words that hold the letters", () => {
  const list = [
    summary("siemens_pid_compact", "Siemens", "PID_Compact (S7-1200/1500)", ["Gain"], ["TIA Portal"]),
    summary("simple_pid", "m-lundberg", "simple-pid (Python)", ["differential_on_measurement"]),
    summary("rockwell_pide", "Rockwell", "Logix PIDE", ["PGain"], ["ControlLogix", "CompactLogix", "Allen-Bradley"]),
  ];
  const ids = (typed: string): string[] => findProducts(list, typed).map((product) => product.id);
  assert.deepEqual(ids("TIA"), ["siemens_pid_compact", "simple_pid"]);
  assert.deepEqual(ids("ControlLogix"), ["rockwell_pide"]);
  assert.deepEqual(ids("Allen-Bradley"), ["rockwell_pide"]);
  assert.deepEqual(ids("pid compact"), ["siemens_pid_compact", "rockwell_pide"], "a name comes before a family");
});

test("a product is found in each spelling of its letters", () => {
  const list = [summary("a", "Jäger", "Regler", [])];
  for (const typed of ["jager", "Jaeger", "JÄGER"]) assert.deepEqual(findProducts(list, typed).map(({ id }) => id), ["a"], typed);
  assert.equal(productTitle({ maker: "Jäger", name: "Jäger R4" }), "Jäger R4");
});

test("a name's own words come before what lies inside words and parameters", () => {
  const list = [summary("a", "Acme", "Regulator", ["fox"]), summary("b", "Zeta", "Fox", [])];
  assert.deepEqual(
    findProducts(list, "fox").map((product) => product.id),
    ["b", "a"],
  );
});

test("a maker is not said twice", () => {
  assert.equal(productTitle(LIST[4]!), "Klipper heater (control: pid)");
  assert.equal(productTitle(LIST[1]!), "Emerson DeltaV PID, FORM Series");
});

test("what is missing is asked for, with the reason", () => {
  assert.equal(needSentence([]), "");
  assert.match(needSentence(["y_span", "u_span"]), /^Give the range of the measurement and the range of the output: .*them\. Until then/);
  assert.match(needSentence(["sample_time"]), /^Give the sample time: /);
});

const parameter = (name: string, more: Partial<ProductParameter> = {}): ProductParameter => ({
  name,
  label: name,
  unit: "",
  role: "gain",
  formula: "Kp",
  low: null,
  high: null,
  resolution: null,
  off: null,
  written: true,
  ...more,
});

const PRODUCT: Product = {
  id: "acme",
  maker: "Acme",
  name: "PID",
  families: ["Acme Plant"],
  form: "ideal",
  needs: [],
  law: "u = Kp e",
  gain_basis: "engineering units",
  parameters: [
    parameter("Kp", { label: "S1 Kp", low: 0 }),
    parameter("Ti", { unit: "min", role: "integral", low: 0, high: 60, resolution: 0.01 }),
    parameter("type", { role: "choice", written: false, choices: [{ value: "PI-D" }, { value: "I-PD", b: 0 }] }),
    parameter("code", { role: "weight_b", default: "000" }),
  ],
  setpoint_weights: { b: 1, c: 0 },
  action: { by: "switch", name: "CA", direct: 1, text: "CA turns the error." },
  algorithm: { integral: "backward", derivative: "difference", form: "position", published: true, sample_time: null, clock_fixed: false },
  traps: [],
  evidence: { level: "partly", read: ["form"], unverified: ["filter", "clock"], sources: ["a manual"] },
};

const ENTERED: AsEntered = {
  settings: { CA: 1, Ti: 1.25, Kp: 2.5 },
  as_typed: { CA: "1", Ti: "1.25", Kp: "2.500" },
  units: { Ti: "min" },
  realised: { form: "ideal", Kp: -2.5, Ti: 75, Td: 0 },
  notes: [],
};

test("rows stand in the product's order under its labels; the switch of the direction comes last", () => {
  const rows = typedRows(PRODUCT, ENTERED);
  assert.deepEqual(
    rows.map(({ label, value, unit }) => [label, value, unit]),
    [
      ["S1 Kp", "2.500", ""],
      ["Ti", "1.25", "min"],
      ["CA", "1", ""],
    ],
  );
  assert.equal(rows[1]!.about, "0 to 60, step 0.01");
  assert.equal(rows[2]!.about, "CA turns the error.");
  assert.deepEqual(rows.map(({ explains }) => explains), ["Kp", "Ti", "action"], "by their roles");
  assert.equal(typedText("Acme PID: robust", rows), "Acme PID: robust\nS1 Kp = 2.500\nTi = 1.25 min\nCA = 1");
});

test("a range says what there is of it", () => {
  assert.equal(rangeWords(parameter("a", { low: 0, high: 100 })), "0 to 100");
  assert.equal(rangeWords(parameter("a", { low: 1, resolution: 1 })), "at least 1, step 1");
  assert.equal(rangeWords(parameter("a", { high: 5 })), "at most 5");
  assert.equal(rangeWords(parameter("a")), "");
});

const robustness = (Ms: number | null): Robustness => ({ stable: Ms !== null, Ms }) as unknown as Robustness;
type Differs = NonNullable<Implemented["difference"]["differs"]>;
const built = (Ms_percent: number | null, load_IAE_percent: number | null, differs: Differs = []): Implemented => ({
  sample_time: 0.5,
  robustness: robustness(1.44),
  performance: { load: { IAE: 8.37 } },
  difference: { Ms_percent, load_IAE_percent, overshoot_points: null, differs },
});

test("the implemented loop stands next to the ideal one; what the service says to differ is marked", () => {
  const ideal = { robustness: robustness(1.4), performance: { load: { IAE: 8.4 } } };
  assert.deepEqual(builtRows(ideal, built(2.857, -0.36, ["Ms"])), [
    { label: "Ms", ideal: "1.40", built: "1.44", difference: "+2.9 %", far: true },
    { label: "Load IAE", ideal: "8.40", built: "8.37", difference: "−0.4 %", far: false },
  ]);
  assert.ok(builtRows(ideal, built(0, 0.1, ["load_IAE"]))[1]!.far, "as the service says, whatever the figure");
  assert.equal(builtRows(ideal, built(-0.001, null))[0]!.difference, "0.0 %");
  assert.deepEqual(
    builtRows(ideal, built(null, null)).map(({ difference, far }) => [difference, far]),
    [
      ["–", false],
      ["–", false],
    ],
  );
});

test("the implemented overshoot stands next to the ideal loop's, in percent of the step", () => {
  const over = (percent: number | null) => ({ setpoint: { overshoot_percent: percent } });
  const loop = (percent: number, points: number | null, differs: Differs = []): Implemented => {
    const of = built(0, 0, differs);
    return { ...of, performance: over(percent), difference: { ...of.difference, overshoot_points: points } };
  };
  const row = (before: number, of: Implemented) => builtRows({ performance: over(before) }, of)[2];
  const far = loop(29.83, 24.832, ["overshoot"]);
  assert.deepEqual(row(4.998, far), { label: "Overshoot (%)", ideal: "5.00", built: "29.8", difference: "+24.8", far: true });
  assert.deepEqual(row(5, loop(3.1, -1.9)), { label: "Overshoot (%)", ideal: "5.00", built: "3.10", difference: "−1.9", far: false });
  assert.equal(row(5, loop(3, null)), undefined, "what settles nowhere has none");
  assert.equal(differenceSentence(far), "The implemented loop differs from the ideal one: the overshoot 24.8 percentage points higher.");
});

test("what differs is said as the service concludes, and what leaves nothing to compare is handed on", () => {
  assert.equal(
    differenceSentence(built(5.91, -2.05, ["Ms", "load_IAE"])),
    "The implemented loop differs from the ideal one: Ms 5.9 % higher, the load IAE 2.0 % lower.",
  );
  assert.equal(differenceSentence(built(5.91, null)), "");
  const { difference, ...loop } = built(5.91, 30);
  const kept = { ...loop, difference: { Ms_percent: difference.Ms_percent, load_IAE_percent: 30 } } as Implemented;
  assert.equal(
    differenceSentence(kept),
    "Tuned by an older version: tune again to see whether the implemented loop differs from the ideal one.",
  );
  const over = (percent: number) => ({ setpoint: { overshoot_percent: percent } });
  assert.deepEqual(
    builtRows({ performance: over(5) }, { ...kept, performance: over(30) }).map(({ label, difference: away, far }) => [label, away, far]),
    [["Ms", "+5.9 %", false], ["Load IAE", "+30.0 %", false], ["Overshoot (%)", "–", false]],
  );
  const warning = (code: string) => ({ code, detail: code });
  const entry = { warnings: ["differs-as-built", "far-from-linear", "unstable-as-built"].map(warning) };
  assert.deepEqual(
    builtTroubles(entry).map(({ code }) => code),
    ["unstable-as-built"],
  );
  assert.deepEqual(builtTroubles({}), []);
});

test("it is said how the loop was reckoned and how slow it may be sampled", () => {
  const sampled = (implemented: Implemented, longest_sample_time: number | null) => ({ implemented, longest_sample_time });
  assert.deepEqual(samplingSentences(sampled(built(0, 0), 3.61), "s"), [
    "Evaluated with a sample every 0.5 s.",
    "Sampling up to every 3.61 s keeps Ms within 5 %.",
  ]);
  assert.deepEqual(samplingSentences(sampled({ ...built(0, 0), sample_time: null }, null), "s"), [
    "Evaluated as continuous, because no sample time is known.",
  ]);
  const verdict = [{ code: "sample-time", level: "warning" as const, text: "", figures: {} }];
  assert.match(samplingSentences({ ...sampled(built(0, 0), 3.61), verdict }, "s")[1]!, /^That is slow: up to 3.61 s /, "as the verdict says");
  assert.match(samplingSentences(sampled(built(0, 0), 0.2), "s")[1]!, /^Sampling up to every 0.200 s /);
  assert.deepEqual(samplingSentences({}, "s"), []);
});

test("evidence names what was not verified, and sends to the manual where not all was read", () => {
  assert.equal(
    evidenceSentence(PRODUCT.evidence),
    "Read in part, or in documents of third parties. Not verified: filter; clock. Check the settings against your manual before you use them.",
  );
  assert.equal(evidenceSentence({ level: "read", read: [], unverified: [], sources: [] }), "Read in the maker's code or text.");
});

test("notes on what the block cannot be are kept apart as the service tells them; of an older answer all are shown", () => {
  const notes = [true, false, true].map((deviation, at) => ({ code: `note-${at}`, detail: "", deviation }));
  const codes = ({ deviations, remarks }: ReturnType<typeof splitNotes>) => [deviations, remarks].map((list) => list.map(({ code }) => code));
  assert.deepEqual(codes(splitNotes(notes)), [["note-0", "note-2"], ["note-1"]]);
  const older = [{ code: "unverified", detail: "" }] as unknown as typeof notes;
  assert.deepEqual(codes(splitNotes(older)), [["unverified"], []]);
});

test("a product's parameters are fields, with one for the direction", () => {
  assert.deepEqual(
    settingFields(PRODUCT).map(({ name, label, choices, standard, main }) => [name, label, choices, standard, main]),
    [
      ["Kp", "S1 Kp", [], "", true],
      ["Ti", "Ti", [], "", true],
      ["type", "type", ["PI-D", "I-PD"], "PI-D", false],
      ["code", "code", [], "000", true],
      ["CA", "CA", [1], "reverse action", false],
    ],
  );
});

test("typed settings become values: numbers, words, codes and switches; empty ones stay away", () => {
  assert.deepEqual(readSettings(PRODUCT, { Kp: "1,5", Ti: " ", type: "I-PD", code: "165", CA: "1" }), {
    settings: { Kp: 1.5, type: "I-PD", code: "165", CA: 1 },
    errors: [],
  });
  assert.deepEqual(readSettings(PRODUCT, {}), { settings: undefined, errors: [] });
  const { errors } = readSettings(PRODUCT, { Kp: "much" });
  assert.deepEqual(errors.map((error) => error.pointer), ["/baseline/settings/Kp"]);
  assert.match(errors[0]!.detail, /^S1 Kp "much" is not a number/);
  assert.deepEqual(typedSettings({ Kp: 1.5, on: true, code: "165" }), { Kp: "1.5", on: "true", code: "165" });
});

test("a range needs both ends, the second above the first", () => {
  assert.deepEqual(readSpan(["0", "200"], "Output range", "/u"), { span: [0, 200], errors: [] });
  assert.deepEqual(readSpan(["-5", "2,5"], "Output range", "/u").span, [-5, 2.5]);
  assert.deepEqual(readSpan(["0", ""], "Output range", "/u"), { span: null, errors: [] });
  assert.deepEqual(
    readSpan(["a", "b"], "Output range", "/u").errors.map((error) => error.pointer),
    ["/u/0", "/u/1"],
  );
  assert.match(readSpan(["5", "5"], "Output range", "/u").errors[0]!.detail, /the end must be higher/);
});

const MINE: MyController = { product: "acme", name: "Acme PID", needs: ["y_span"], y_span: [0, 200], u_span: [0, 100], sample_time: 0.5 };

test("a request names what the product needs, and nothing while that is missing", () => {
  assert.deepEqual(implementOf(MINE), { product: "acme", y_span: [0, 200], sample_time: 0.5 });
  const { y_span: _y, ...without } = MINE;
  assert.deepEqual(missingOf(without), ["y_span"]);
  assert.equal(implementOf(without), null);
  assert.equal(implementOf(null), null);
  assert.ok(sameImplement({ sample_time: 0.5, y_span: [0, 200], product: "acme" }, implementOf(MINE)));
  assert.ok(!sameImplement(undefined, implementOf(MINE)));
  assert.ok(sameImplement(undefined, null));
});

test("what a job was made for is shown; ranges that the product does not need stay known", () => {
  const shown = mineOfRequest({ product: "acme", y_span: [0, 50] }, MINE);
  assert.deepEqual(shown, { product: "acme", name: "Acme PID", needs: ["y_span"], u_span: [0, 100], y_span: [0, 50] });
  assert.deepEqual(mineOfRequest({ product: "foxboro_pid" }, MINE), { product: "foxboro_pid", name: "foxboro_pid", needs: [] });
  assert.equal(mineOfRequest({ sample_time: 1 }, MINE), MINE);
  assert.deepEqual(named({ product: "foxboro_pid", name: "foxboro_pid", needs: [] }, LIST)?.name, "Foxboro I/A Series PID block");
  assert.equal(named(MINE, LIST), MINE);
});

test("ranges and sample time that were given in other units are not taken for this loop", () => {
  const given: MyController = { ...MINE, units: { time: "s", u: "%", y: "°C" } };
  assert.deepEqual(inUnits(given, { time: "s", u: "", y: "°C" }), { ...MINE, units: { time: "s", u: "%", y: "°C" } }, "they are still in %");
  const other = inUnits(given, { time: "min", u: "%", y: "bar" })!;
  assert.deepEqual([other.sample_time, other.y_span, other.u_span], [undefined, undefined, [0, 100]]);
  assert.deepEqual(missingOf(other), ["y_span"]);
  assert.equal(inUnits(MINE, { time: "min", u: "", y: "" }), MINE, "nobody knows what they were in");
  assert.equal(inUnits(null, { time: "s", u: "", y: "" }), null);
});

test("what stands in the browser's storage is read with care", () => {
  assert.deepEqual(readMine(JSON.parse(JSON.stringify(MINE))), MINE);
  assert.deepEqual(readMine({ product: "a", name: "A", needs: ["y_span", "more"], y_span: [2, 1], sample_time: "1" }), {
    product: "a",
    name: "A",
    needs: ["y_span"],
  });
  for (const broken of [null, "a", 1, [], {}, { product: 1 }, { product: "a", name: "A" }]) assert.equal(readMine(broken), null);
});

test("a request is made for another product, keeps what belongs to its own, and goes back to the ideal", () => {
  const request = { plant: { type: "fopdt" }, implement: { product: "acme", sample_time: 2, computation_delay: 0.1 } };
  assert.deepEqual(withImplement(request, { product: "acme", y_span: [0, 1] }).implement, {
    product: "acme",
    y_span: [0, 1],
    computation_delay: 0.1,
  });
  assert.deepEqual(withImplement(request, { product: "other" }).implement, { product: "other" });
  assert.deepEqual(withImplement(request, null), { plant: { type: "fopdt" } });
});

test("today's settings carry the ranges that they were typed for", () => {
  assert.deepEqual(typedInto(implementOf(MINE)!, { Kp: 1 }), {
    product: "acme",
    settings: { Kp: 1 },
    y_span: [0, 200],
    sample_time: 0.5,
  });
});

test("the address of a controller's code holds what was asked for alone", () => {
  assert.equal(
    codePath({ job: "a b", index: 1, language: "c", sample_time: 0.5, u_min: undefined, u_max: 100 }),
    "v1/jobs/a%20b/controllers/1/code?language=c&sample_time=0.5&u_max=100",
  );
});
