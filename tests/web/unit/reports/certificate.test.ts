import assert from "node:assert/strict";
import test from "node:test";
import { designBody } from "../../../../web/src/api/live.ts";
import type { Certificate, Entry } from "../../../../web/src/api/types.ts";
import { withCertificate } from "../../../../web/src/form/tuning_request.ts";
import { costOfRow, questionOf } from "../../../../web/src/live/shown.ts";
import { certificateFacts, provedWords } from "../../../../web/src/proof/words.ts";

const certificate: Certificate = {
  upper: 1.5208784,
  lower: 1.5056696,
  gap: 0.01,
  asked_gap: 0.01,
  complete: true,
  root: { low: { k: -62.2, ki: 0.664 }, high: { k: 62.2, ki: 13.7 } },
  boxes: 60,
  problem: { plant: { num: [0.1], den: [1, 0.1], L: 1 }, structure: "pi", Tf: 0, Ms: 1.4, Mt: 1.4, upper: 1.52, design: [3, 0.7, 0] },
  seconds: 1.25,
};

test("a complete certificate says proved; one that was stopped says how far it came and what was asked for", () => {
  assert.equal(provedWords(certificate, "s"), "No PI within these limits has an IAE below 1.506 s: this one is within 1 % of the best possible (proved).");
  const stopped = provedWords({ ...certificate, complete: false, gap: 0.0319, problem: { ...certificate.problem, structure: "pid_tied" } }, "");
  assert.equal(stopped, "Proved so far: no PID with Tf = Td/10 within these limits has an IAE below 1.506: this one is within 3.2 % of the best possible. The search ended before the 1 % that were asked for.");
});

test("the box has the sides of its structure alone", () => {
  const labels = certificateFacts(certificate, "s").map(([label]) => label);
  assert.ok(labels.includes("Proved bound (s)") && labels.includes("ki of the controllers compared"));
  assert.ok(!labels.some((label) => label.startsWith("Td") || label.startsWith("kd")));
  const root = { low: { ...certificate.root.low, Td: 0 }, high: { ...certificate.root.high, Td: 4 } };
  assert.deepEqual(certificateFacts({ ...certificate, root }, "s").find(([label]) => label.startsWith("Td"))![1], "0 to 4.00");
});

const robust: Entry = { method: "robust", verdict: [], compute_ms: 1300, certificate } as unknown as Entry;
const request = { plant: "1/(s+1)^3", tune: [{ method: "simc" }, { method: "robust", Ms: 1.5, certify: { gap: 0.02 } }] };
const result = { controllers: [{ method: "simc", compute_ms: 1 } as unknown as Entry, robust] };

test("a proof is asked for the entry's own row", () => {
  assert.deepEqual(withCertificate(request, result, 1, 0.01).tune, [{ method: "simc" }, { method: "robust", Ms: 1.5, certify: { gap: 0.01 } }]);
});

test("what follows a slider asks for no proof, and its time is not that of the proof", () => {
  const from = { request, result, index: 1 };
  assert.deepEqual(designBody(request, result)["tune"], [{ method: "simc" }, { method: "robust", Ms: 1.5 }]);
  const moved = { method: "robust", Ms: 1.6, certify: { gap: 0.02 } };
  assert.deepEqual(questionOf(from, moved, true)["tune"], [{ method: "robust", Ms: 1.6 }]);
  assert.deepEqual((questionOf(from, moved, false)["tune"] as object[])[1], { method: "robust", Ms: 1.6 });
  assert.equal(costOfRow(from), 50);
});
