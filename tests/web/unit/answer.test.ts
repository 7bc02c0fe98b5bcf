import assert from "node:assert/strict";
import test from "node:test";
import { pasteOf } from "../../../web/src/words/paste.ts";
import { namesOf, usualSpan } from "../../../web/src/words/record_names.ts";
import type { Preview } from "../../../web/src/api/types.ts";

const preview = (columns: [heading: string, guess: string, unit: string][]): Pick<Preview, "columns"> => ({
  columns: columns.map(([heading, guess, unit]) => ({ heading, guess, unit })) as Preview["columns"],
});

test("a file names its units, and the tag that its columns share", () => {
  const trend = preview([["Zeit", "t", ""], ["TIC101.SP", "r", "°C"], ["TIC101.PV", "y", "°C"], ["TIC101.OP", "u", "%"]]);
  assert.deepEqual(namesOf(trend), { u: "%", y: "°C", tag: "TIC101" });
  const tags: [string, string, string][] = [
    ["Area 3/FIC-7.PV", "Area 3/FIC-7.OUT", "Area 3/FIC-7"],
    ["LIC_12_PV", "LIC_12_OP", "LIC_12"],
    ["T1", "Q1", ""],
    ["PV", "OP", ""],
    ["TIC101", "TIC101", ""],
    ["TIC101.PV", "TIC102.OP", ""],
  ];
  for (const [y, u, tag] of tags) assert.equal(namesOf(preview([[y, "y", ""], [u, "u", ""]])).tag, tag, `${y}, ${u}`);
  assert.deepEqual(namesOf(preview([["a", "-", ""]])), { u: "", y: "", tag: "" });
});

test("only a unit or values that tell a range propose one", () => {
  assert.deepEqual(usualSpan("%"), [0, 100]);
  assert.deepEqual(usualSpan("", [0, 0.4, null, 1]), [0, 1]);
  assert.equal(usualSpan("", [0, 40]), undefined);
  assert.equal(usualSpan("", []), undefined);
  assert.equal(usualSpan("V", [0, 1]), undefined);
  assert.equal(usualSpan("°C"), undefined);
});

test("lines to paste have every setting, and only products with such lines have them", () => {
  assert.equal(
    pasteOf("klipper", { pid_Kp: "12.75", pid_Ki: "0.1594", pid_Kd: "153.00", smooth_time: "1.50" })?.text,
    "control: pid\npid_Kp: 12.75\npid_Ki: 0.1594\npid_Kd: 153.00\nsmooth_time: 1.50",
  );
  assert.equal(pasteOf("marlin", { P: "12.75", I: "0.16", D: "153.00", PID_K1: "0.88" })?.text, "M301 P12.75 I0.16 D153.00\nM500");
  assert.equal(
    pasteOf("arduino_pid_v1", { Kp: "2", Ki: "0.1", Kd: "3", POn: "P_ON_E", ControllerDirection: "REVERSE" })?.text,
    "PID controller(&y, &u, &r, 2, 0.1, 3, P_ON_E, REVERSE);",
  );
  assert.match(pasteOf("esphome_pid", { kp: "0.05", ki: "0.000625", kd: "0.60" })!.text, /^control_parameters:\n {2}kp: 0\.05\n/);
  assert.equal(pasteOf("emerson_deltav_standard", { GAIN: "1" }), null);
});
