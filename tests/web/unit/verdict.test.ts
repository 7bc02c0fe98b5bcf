import assert from "node:assert/strict";
import test from "node:test";
import type { Entry } from "../../../web/src/api/types.ts";
import { figureGroups } from "../../../web/src/words/figures.ts";
import type { FigureRow } from "../../../web/src/words/figures.ts";
import { formatNumber, formatSetting, unitNames } from "../../../web/src/words/numbers.ts";
import { verdictOf } from "../../../web/src/words/verdict.ts";
import { settingsOf, settingsText } from "../../../web/src/views/cards/settings_card.ts";

function entry(changes: Record<string, unknown> = {}, performance: Record<string, unknown> = {}): Entry {
  return {
    method: "robust",
    options: { Ms: 1.6, Mt: 1.6 },
    controller: {
      form: "ideal",
      Kp: 2.58,
      Ti: 16.1,
      Td: 3.43,
      b: 1,
      c: 0,
      action: "reverse",
      filter: { type: "measurement_second_order", Tf: 0.343 },
    },
    equivalents: { parallel: { Kp: 2.58, Ki: 0.16, Kd: 8.85 }, series: null },
    robustness: {
      stable: true,
      Ms: 1.6,
      omega_Ms: 0.213,
      Mt: 1.46,
      omega_Mt: 0.1,
      Mks: 20,
      gain_margin: 2.67,
      gain_margin_low: null,
      phase_margin_deg: 40,
      delay_margin: 8.7,
      gain_crossover: 0.1,
      phase_crossover: 0.3,
      why_null: { gain_margin_low: "It stays stable however small the gain." },
      ...changes,
    },
    performance: { setpoint: { TV: 7.9 }, load: { IAE: 8.44, ...performance } },
  };
}

const today: Entry = {
  ...entry({ Ms: 1.35 }, { IAE: 33 }),
  method: "baseline",
  performance: { setpoint: { TV: 2.1 }, load: { IAE: 33 } },
};

test("a design that touches its limit says which, where, what it tolerates and what it saves", () => {
  const verdict = verdictOf(entry(), today, { units: { time: "s", y: "degC" } });
  assert.equal(verdict.level, "good");
  assert.equal(verdict.head, "Robust, limited by the margin you asked for.");
  const text = verdict.sentences.join(" ");
  assert.match(text, /Ms = 1\.60 at 0\.213 rad\/s\. Mt \(1\.46\) has room\./);
  assert.match(text, /The process gain may grow 2\.7-fold, or the dead time by 8\.7 s before the loop oscillates\./);
  assert.match(text, /costs 8\.44 °C s instead of 33\.0 with today's settings: 3\.9 times less/);
  assert.match(text, /The valve moves 3\.8 times as much/);
});

test("a gain that may not fall is said, as unstable plants have it", () => {
  const text = verdictOf(entry({ gain_margin_low: 0.4 }), undefined, {}).sentences.join(" ");
  assert.match(
    text,
    /The process gain may fall to 0\.40 of itself or grow 2\.7-fold, or the dead time may grow by 8\.7 s before/,
  );
});

test("levels follow Ms", () => {
  assert.equal(verdictOf(entry({ Ms: 1.85, Mt: 1.2 }), undefined, {}).level, "warn");
  assert.equal(verdictOf(entry({ Ms: 2.4 }), undefined, {}).level, "bad");
  assert.equal(verdictOf(entry({ Ms: 1.3, Mt: 1.1 }), undefined, {}).head, "Robust.");
});

test("unstable loops and failed methods are said to be so, in the service's words", () => {
  const unstable = verdictOf(
    { ...entry({ stable: false, Ms: null }), warnings: [{ code: "unstable", detail: "Lower Kp." }] },
    undefined,
    {},
  );
  assert.equal(unstable.level, "bad");
  assert.match(unstable.sentences.join(" "), /Lower Kp\./);
  const failed = verdictOf({ method: "lambda", error: { detail: "lambda needs a first-order plant." } }, undefined, {});
  assert.deepEqual(failed.sentences, ["lambda needs a first-order plant."]);
});

test("a long dead time is named as what rules the loop", () => {
  const text = verdictOf(entry(), undefined, { plant: { type: "fopdt", K: 1, T: 10, L: 32 } }).sentences.join(" ");
  assert.match(text, /Dead time is 3\.2 times the lag: nothing can act sooner than 32\.0 s/);
});

test("a controller that serves many plants says how it fares on all of them", () => {
  const on = (region: Entry["region"]): Entry => ({ ...entry(), region });
  const good = verdictOf(on({ stable_fraction: 1, worst_Ms: 1.52 }), undefined, {});
  assert.equal(good.level, "good");
  assert.match(good.sentences.join(" "), /It is stable on every plant that this one may be, with Ms 1\.52 at worst\./);
  const bad = verdictOf(
    on({ stable_fraction: 0.9996, worst_Ms: null, why_null: { worst_Ms: "Some are unstable." } }),
    undefined,
    {},
  );
  assert.deepEqual([bad.level, bad.head], ["bad", "Unstable on a part of what the plant may be."]);
  assert.match(bad.sentences.join(" "), /stable on 99\.9 % of the plants/);
  const rows = figureGroups(unitNames(undefined), true).flatMap((group) => group.rows);
  const row = (label: string): FigureRow => rows.find((candidate) => candidate.label === label)!;
  assert.equal(row("Stable plants (%)").value(on({ stable_fraction: 0.5 })).text, "50");
  assert.equal(row("Ms at worst").value(on({ worst_Ms: 1.52 })).text, "1.52");
  assert.equal(
    row("Ms at worst").value(on({ why_null: { worst_Ms: "Some are unstable." } })).why,
    "Some are unstable.",
  );
  assert.equal(row("Ms at worst").value(entry()).text, "");
  assert.ok(
    !figureGroups(unitNames(undefined)).some((group) => group.rows.some((item) => item.label === "Ms at worst")),
  );
});

test("no verdict ever says null, NaN or undefined", () => {
  for (const robustness of [{}, { Ms: null, Mt: null, gain_margin: null, delay_margin: null, omega_Ms: null }]) {
    for (const performance of [{}, { IAE: null }]) {
      const verdict = verdictOf(entry(robustness, performance), today, undefined);
      assert.doesNotMatch(JSON.stringify(verdict), /null|NaN|undefined/);
    }
  }
});

test("numbers have three digits, a true minus, and a dash where there is none", () => {
  assert.equal(formatNumber(1.4), "1.40");
  assert.equal(formatNumber(-0.012345), "−0.0123");
  assert.equal(formatNumber(1234.5), "1230");
  assert.equal(formatNumber(1.5e-6), "1.50e−6");
  assert.equal(formatNumber(123456), "1.23e5");
  assert.equal(formatNumber(0), "0");
  assert.equal(formatNumber(null), "–");
  assert.equal(formatNumber(NaN), "–");
  assert.equal(formatSetting(2.5), "2.5");
  assert.equal(formatSetting(16.123456), "16.123");
});

test("a figure that is null carries the service's reason", () => {
  const rows = figureGroups(unitNames(undefined)).flatMap((group) => group.rows);
  const low = rows.find((row) => row.label === "Gain margin, low")!.value(entry());
  assert.deepEqual(low, { text: "", why: "It stays stable however small the gain." });
  assert.equal(rows.find((row) => row.label === "Ms")!.value(entry()).text, "1.60");
  for (const row of rows) {
    const value = row.value(entry());
    assert.ok(value.text !== "" || value.why !== "", row.label);
  }
});

test("settings are given in each form that exists, else the reason", () => {
  const units = unitNames({ time: "s", u: "%", y: "degC" });
  const ideal = settingsOf(entry(), "ideal", units);
  assert.ok(Array.isArray(ideal));
  assert.equal(settingsText("ideal", ideal), "form: ideal\nKp = 2.58 %/°C\nTi = 16.1 s\nTd = 3.43 s\nTf = 0.343 s");
  assert.match(String(settingsOf(entry(), "series", units)), /no series form/);
  assert.ok(Array.isArray(settingsOf(entry(), "parallel", units)));
});

test("what runs is judged: the loop on the user's controller before the ideal one", () => {
  const built = (robustness: Record<string, unknown>): Entry =>
    ({
      ...entry({ Ms: 1.3, Mt: 1.2 }),
      implemented: { robustness, performance: { load: { IAE: 16.4 } }, difference: {} },
    }) as unknown as Entry;
  const reached = verdictOf(built({ stable: true, Ms: 1.6, Mt: 1.3 }), undefined, undefined);
  assert.equal(reached.head, "Robust, limited by the margin you asked for.");
  assert.match(reached.sentences[0]!, /as it is built Ms is 1\.60 and a load disturbance costs 16\.4; what follows is the ideal/);
  assert.equal(verdictOf(built({ stable: true, Ms: 2.4, Mt: 2 }), undefined, undefined).level, "bad");
  const unstable = verdictOf(built({ stable: false, Ms: null, Mt: null }), undefined, undefined);
  assert.deepEqual([unstable.level, unstable.head], ["bad", "Unstable on your controller as it is built."]);
  assert.match(unstable.sentences[0]!, /sample faster/);
});
