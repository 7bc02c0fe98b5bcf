import assert from "node:assert/strict";
import test from "node:test";
import type { Entry } from "../../../web/src/api/types.ts";
import { settingsOf } from "../../../web/src/words/settings.ts";
import { mentions, optionRows } from "../../../web/src/words/methods.ts";
import { unitNames } from "../../../web/src/words/numbers.ts";

test("options are rows with what they may be, from any schema", () => {
  const rows = optionRows({
    properties: {
      Ms: { type: "number", exclusiveMinimum: 1, maximum: 4, default: 1.4, description: "Limit." },
      controller: { enum: ["PI", "PID"], default: "PID" },
      level: { oneOf: [{ const: "free" }, { type: "number", minimum: 1.4, maximum: 2 }, { type: "null" }] },
      filter: { properties: { Tf: { type: ["number", "null"], minimum: 0, "x-unit": "time" } } },
      poles: { type: "array", items: { type: "number" } },
      exact: { type: "boolean", default: false },
      reduction: { $ref: "#/$defs/Reduction" },
    },
    $defs: { Reduction: { type: "object", properties: { method: { enum: ["auto"] } } } },
  });
  assert.deepEqual(
    rows.map((row) => [row.name, row.values, row.standard]),
    [
      ["Ms", "number in (1, 4]", "1.4"],
      ["controller", "PI or PID", "PID"],
      ["level", "free or number in [1.4, 2]", ""],
      ["filter.Tf", "number from 0, in time", ""],
      ["poles", "list of number", ""],
      ["exact", "true or false", "false"],
      ["reduction.method", "auto", ""],
    ],
  );
  assert.deepEqual(optionRows(undefined), []);
});

test("a search finds a method by any of its words, in any order", () => {
  const method = {
    id: "ziegler_nichols_step",
    title: "Ziegler-Nichols, step response",
    source: "Trans. ASME 64 (1942)",
  };
  for (const words of ["", "ziegler", "NICHOLS step", "1942 ziegler", "ziegler_nichols"])
    assert.ok(mentions(method, words), words);
  assert.ok(!mentions(method, "ziegler imc"));
});

const nonlinear: Entry = {
  method: "npid_iae",
  controller: { form: "npid", Kp: 2, Ti: 10, Td: 1, delta_r: 5, filter: { type: "derivative", Tf: 0.1 } },
  robustness: { stable: true, Ms: 1.8, omega_Ms: 1, Mt: 1.2, omega_Mt: 1 } as Entry["robustness"] & object,
};

test("a nonlinear controller is entered in its own form", () => {
  const settings = settingsOf(nonlinear, "npid", unitNames({ y: "degC", time: "s" }));
  assert.ok(typeof settings !== "string");
  assert.deepEqual(
    settings.map((setting) => [setting.name, setting.value, setting.unit]),
    [
      ["Kp", 2, "1/°C"],
      ["Ti", 10, "s"],
      ["Td", 1, "s"],
      ["delta_r", 5, "°C"],
      ["Tf", 0.1, "s"],
    ],
  );
});
