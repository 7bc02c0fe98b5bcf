import assert from "node:assert/strict";
import test from "node:test";
import type { Schema } from "../../../web/src/api/types.ts";
import { pick, place } from "../../../web/src/form/cases.ts";
import { inLabels, matchPointer } from "../../../web/src/form/errors.ts";
import { fieldsOf, readField, typedText } from "../../../web/src/form/fields.ts";
import { keptWords } from "../../../web/src/form/kept_note.ts";
import { atRecordText } from "../../../web/src/form/record_text.ts";
import { formOf, PLANT_FORMS, readPlant } from "../../../web/src/form/plant.ts";
import { formatRoute, parseRoute, rewriteAddress } from "../../../web/src/routes.ts";
import type { Route } from "../../../web/src/routes.ts";

const schema: Schema = {
  type: "object",
  $defs: { positive: { type: "number", exclusiveMinimum: 0 } },
  properties: {
    Ms: { oneOf: [{ const: "free" }, { type: "number" }], default: 1.4, description: "limit of |S|" },
    controller: { type: "string", enum: ["PI", "PID"], default: "PID" },
    order: { type: ["integer", "null"] },
    surface: { type: "boolean" },
    poles: { type: "array", items: { type: "number" } },
    scenarios: { type: "array", items: { type: "object" } },
    filter: { type: "object", properties: { Tf: { $ref: "#/$defs/positive", "x-unit": "time" } } },
  },
};

test("a method's schema becomes fields; nested objects are opened, shapes without a field left out", () => {
  const fields = fieldsOf(schema);
  assert.deepEqual(
    fields.map((field) => [field.label, field.kind]),
    [
      ["Ms", "number"],
      ["controller", "choice"],
      ["order", "integer"],
      ["surface", "boolean"],
      ["poles", "numbers"],
      ["filter Tf", "number"],
    ],
  );
  assert.deepEqual(fields[0]!.words, ["free"]);
  assert.equal(fields[0]!.defaultText, "1.4");
  assert.equal(fields[0]!.hint, "limit of |S|");
  assert.deepEqual(fields[1]!.choices, ["PI", "PID"]);
  assert.equal(fields[5]!.unit, "time");
  assert.deepEqual(fieldsOf(undefined), []);
});

test("a fault names fields by their labels, and leaves signals and words alone", () => {
  const labels = new Map([
    ["u_plus", "Upper level"],
    ["u0", "u before"],
    ["u", "Output u"],
  ]);
  const said = (pointer: string, own: string, detail: string): string => inLabels({ pointer, detail }, own, labels);
  assert.equal(
    said("/relay/u_minus", "Lower level", "u_minus is 2; it must be less than u_plus, 1."),
    'Lower level is 2; it must be less than "Upper level", 1.',
  );
  const still = "u never moves, so nothing can be learned. Record a test in which u changes, or give u0.";
  assert.equal(said("/record/csv", "or paste it", still), still.replace("u0", '"u before"'));
  assert.equal(
    said("/record/csv", "or paste it", "csv has headings but no line of numbers."),
    "The text has headings but no line of numbers.",
  );
  assert.equal(said("/plant/K", "K", "No loop_gain is known."), "No loop_gain is known.");
});

test("what the service says of a record's columns stands at its text", () => {
  const pointers = ["/record/u", "/record/y/3", "/record/u0", "/plant/K"];
  const moved = atRecordText(pointers.map((pointer) => ({ pointer, detail: "" })));
  assert.deepEqual(moved.map(({ pointer }) => pointer), ["/record/csv", "/record/csv", "/record/u0", "/plant/K"]);
});

test("what is typed becomes values at their paths; empty fields send nothing", () => {
  const [Ms, controller, order, surface, poles, Tf] = fieldsOf(schema);
  const entry: Record<string, unknown> = { method: "robust" };
  for (const [field, text] of [
    [Ms, "free"],
    [controller, ""],
    [order, "2"],
    [surface, "true"],
    [poles, "-1 -2"],
    [Tf, "0,1"],
  ] as const) {
    const parsed = readField(field!, text);
    assert.ok(parsed.ok);
    place(entry, field!.path, parsed.value);
  }
  assert.deepEqual(entry, {
    method: "robust",
    Ms: "free",
    order: 2,
    surface: true,
    poles: [-1, -2],
    filter: { Tf: 0.1 },
  });
  assert.equal(pick(entry, ["filter", "Tf"]), 0.1);
  assert.equal(typedText(pick(entry, ["poles"])), "-1 -2");
  assert.equal(readField(order!, "2.5").ok, false);
  assert.equal(readField(Tf!, "x").ok, false);
});

test("a pointer goes to its own field, else to the field around it, else to one inside", () => {
  const known = ["/plant/K", "/plant/den", null, "/tune/0/filter/Tf", "/baseline/Kp"];
  assert.equal(matchPointer("/plant/K", known), 0);
  assert.equal(matchPointer("/plant/den/2", known), 1);
  assert.equal(matchPointer("/tune/0/filter", known), 3);
  assert.equal(matchPointer("/plant/Kx", known), -1);
  assert.equal(matchPointer("", known), -1);
  assert.equal(matchPointer("/timeout_s", known), -1);
});

test("each plant form writes the contract's plant and reads it back", () => {
  for (const form of PLANT_FORMS) {
    const examples = Object.fromEntries(form.fields.map((field) => [field.name, field.example]));
    const { plant, errors } = readPlant(form, (name) => examples[name] ?? "");
    assert.deepEqual(errors, [], form.id);
    assert.equal(plant.type, form.type);
    assert.equal(formOf(plant)?.id, form.id);
    const again = readPlant(form, (name) => form.fields.find((field) => field.name === name)!.write(plant[name]));
    assert.deepEqual(again.plant, plant, form.id);
  }
});

test("faults of a plant name their field", () => {
  const { errors } = readPlant(PLANT_FORMS[0]!, (name) => (name === "T" ? "forty" : ""));
  assert.deepEqual(
    errors.map((error) => error.pointer),
    ["/plant/K", "/plant/T", "/plant/L"],
  );
  assert.match(errors[1]!.detail, /T "forty" is not a number/);
});

test("plants that no form shows are not forced into one", () => {
  assert.equal(formOf({ type: "nonlinear" }), null);
  assert.equal(formOf({ type: "transfer_function", num: [1], den: [1, 1], uncertainty: { K: [0.8, 1.2] } }), null);
});

test("an uncertain plant is shown and read back as it was", () => {
  const plant = { type: "fopdt", K: 2, T: 10, L: 3, uncertainty: { K: [0.8, 1.2], L: [0.9, 1.2] } };
  const form = formOf(plant)!;
  const texts = Object.fromEntries(
    form.fields.map((field) => [field.name, field.write((plant as Record<string, unknown>)[field.name])]),
  );
  assert.deepEqual(
    readPlant(form, (name) => texts[name]!),
    { plant, errors: [] },
  );
});

test("addresses are read back as the routes they came from", () => {
  for (const route of [
    { screen: "start" },
    { screen: "new", plant: "fopdt", values: { K: "1,25", T: "40", L: "8" } },
    { screen: "example", id: "a b/c" },
    { screen: "edit", job: "x1" },
    { screen: "design", job: "x1", entry: null },
    { screen: "design", job: "x1", entry: 2 },
  ] as const) {
    assert.deepEqual(parseRoute(formatRoute(route)), route);
  }
  assert.deepEqual(parseRoute("#/nowhere/%E0%A4%A"), { screen: "start" });
  assert.deepEqual(parseRoute(""), { screen: "start" });
});

test("an address that Back has changed already is not overwritten by the screen that is left", () => {
  const written: string[] = [];
  const page = globalThis as unknown as { location?: object; history?: object };
  const { location, history } = page;
  const at = (hash: string, from: Route, next: Route): string[] => {
    page.location = { hash };
    rewriteAddress(from, next);
    return written.splice(0);
  };
  page.history = { replaceState: (_state: unknown, _title: string, to: string) => written.push(to) };
  const design = (job: string, entry: number | null): Route => ({ screen: "design", job, entry });
  assert.deepEqual(at("#/jobs/a/design", design("a", null), design("a", 1)), ["#/jobs/a/design?entry=1"]);
  assert.deepEqual(at("#/jobs/a/design", design("a", null), design("b", 1)), ["#/jobs/b/design?entry=1"]);
  assert.deepEqual(at("#/jobs/a/compare?Ms=1.7", design("a", null), design("a", 1)), []);
  assert.deepEqual(at("#/jobs/b/design", design("a", null), design("a", 1)), []);
  const typed: Route = { screen: "new", plant: "fopdt", values: { K: "2" } };
  assert.deepEqual(at("#/", { screen: "start" }, typed), ["#/new/fopdt?K=2"]);
  assert.deepEqual(at("#/jobs", { screen: "start" }, typed), []);
  Object.assign(page, { location, history });
});

const emulation: Schema = {
  type: "object",
  properties: {
    target: {
      type: "object",
      properties: {
        gamma: { type: "number" },
        poles: {
          type: "array",
          items: { oneOf: [{ type: "number" }, { type: "array", items: { type: "number" } }] },
        },
      },
    },
    scenarios: {
      type: "array",
      items: {
        type: "object",
        required: ["setpoint_step"],
        properties: {
          initial: { type: "object", additionalProperties: { type: "number" } },
          setpoint_step: { type: "number" },
        },
      },
    },
    Tf: { oneOf: [{ type: "number" }, { type: "array", items: { type: "number" } }] },
    bounds: {
      oneOf: [{ type: "null" }, { type: "object", properties: { Kp: { type: "array", items: { type: "number" } } } }],
    },
    bounds_from: { type: "object", properties: { methods: { type: "array", items: { type: "string" } } } },
  },
};

test("options of lists, spreads, roots and cases are typed as text and read back as they were", () => {
  const fields = fieldsOf(emulation);
  assert.deepEqual(
    fields.map((field) => [field.label, field.kind]),
    [
      ["target gamma", "number"],
      ["target poles", "roots"],
      ["scenarios", "cases"],
      ["Tf", "spread"],
      ["bounds Kp", "numbers"],
      ["bounds_from methods", "names"],
    ],
  );
  const entry: Record<string, unknown> = { method: "emulation" };
  const texts = [
    "",
    "-3±2i -4",
    "10; -5 initial.T 380 initial.CA 0,5; setpoint_step 2",
    "0.05 0.2",
    "-2000 -1000",
    "imc, simc",
  ];
  fields.forEach((field, index) => {
    const parsed = readField(field, texts[index]!);
    assert.ok(parsed.ok, field.label);
    place(entry, field.path, parsed.value);
  });
  assert.deepEqual(entry, {
    method: "emulation",
    target: {
      poles: [[-3, 2], [-3, -2], -4],
    },
    scenarios: [{ setpoint_step: 10 }, { setpoint_step: -5, initial: { T: 380, CA: 0.5 } }, { setpoint_step: 2 }],
    Tf: [0.05, 0.2],
    bounds: { Kp: [-2000, -1000] },
    bounds_from: { methods: ["imc", "simc"] },
  });
  const again: Record<string, unknown> = { method: "emulation" };
  for (const field of fields) {
    const parsed = readField(field, typedText(pick(entry, field.path), field));
    assert.ok(parsed.ok);
    place(again, field.path, parsed.value);
  }
  assert.deepEqual(again, entry);
  assert.deepEqual(readField(fields[3]!, "0,1"), { ok: true, value: 0.1 });
  assert.equal(readField(fields[2]!, "10 initial.T").ok, false);
  assert.equal(readField(fields[2]!, "ten").ok, false);
});

test("what a request has without a field is named by its place, its value cut where it is long", () => {
  assert.deepEqual(keptWords({ evaluate: { horizon: 77, actuator: { min: 0, max: null } }, gone: undefined }), [
    "evaluate.horizon 77",
    "evaluate.actuator.min 0",
    "evaluate.actuator.max null",
  ]);
  const [long] = keptWords({ list: Array.from({ length: 50 }, (_, at) => at) });
  assert.match(long!, /^list \[0,1,2,.*…$/);
  assert.deepEqual(keptWords({ evaluate: {} }), []);
});
