import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import type { Entry } from "../../../web/src/api/types.ts";
import { factsOf } from "../../../web/src/words/facts.ts";
import { figureGroups } from "../../../web/src/words/figures.ts";
import type { FigureRow } from "../../../web/src/words/figures.ts";
import { comparisonColumns } from "../../../web/src/words/comparison.ts";
import { formatNumber, formatSetting, formatShare, product, quotient, unitNames, withMinus } from "../../../web/src/words/numbers.ts";
import { running } from "../../../web/src/words/running.ts";
import { settingsOf, settingsText } from "../../../web/src/words/settings.ts";
import type { Setting } from "../../../web/src/words/settings.ts";

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

test("the facts, the figures and the plots are those of the loop that runs", () => {
  const ideal = { ...entry({ Ms: 1.36 }, { IAE: 698 }), region: { stable_fraction: 1, worst_Ms: 1.363 } } as Entry;
  const implemented = {
    robustness: { ...ideal.robustness, Ms: 1.4 },
    performance: { setpoint: { overshoot_percent: 32.1 }, load: { IAE: 693 } },
    region: { stable_fraction: 1, worst_Ms: 1.402 },
  } as unknown as NonNullable<Entry["implemented"]>;
  const facts = factsOf({ ...ideal, implemented }, undefined, unitNames(undefined)).map(({ value }) => value);
  assert.deepEqual(facts, ["1.40", "693", "32.1"]);
  const shown = running({ ...ideal, implemented });
  assert.deepEqual([shown.robustness?.Ms, shown.performance?.load?.["IAE"], shown.region?.worst_Ms], [1.4, 693, 1.402]);
  assert.equal(shown.responses, undefined, "the ideal loop's responses are not drawn in place of unknown ones");
  assert.equal(running(ideal), ideal);
  const load = comparisonColumns(unitNames(undefined)).find(({ id }) => id === "load_IAE")!;
  assert.equal(load.figure({ ...ideal, implemented }).value, 693);
});

test("a controller that serves many plants has two more figures", () => {
  const on = (region: Entry["region"]): Entry => ({ ...entry(), region });
  const rows = figureGroups(unitNames(undefined), true).flatMap((group) => group.rows);
  const row = (label: string): FigureRow => rows.find((candidate) => candidate.label === label)!;
  assert.equal(row("Stable plants (%)").value(on({ stable_fraction: 0.5 })).text, "50");
  assert.equal(row("Worst Ms").value(on({ worst_Ms: 1.52 })).text, "1.52");
  assert.equal(
    row("Worst Ms").value(on({ why_null: { worst_Ms: "Some are unstable." } })).why,
    "Some are unstable.",
  );
  assert.equal(row("Worst Ms").value(entry()).text, "");
  assert.ok(
    !figureGroups(unitNames(undefined)).some((group) => group.rows.some((item) => item.label === "Worst Ms")),
  );
});

test("shares are never all for less than all, and sentences of the service get a true minus", () => {
  assert.equal(formatShare(0.9996), "99.9");
  assert.equal(formatShare(1), "100");
  assert.equal(withMinus("u falls to -1.2 (-3 %) in long-term use"), "u falls to −1.2 (−3 %) in long-term use");
});

test("figures and units are spelled as by the service", () => {
  const file = path.join(process.env["TUNEWRIGHT_ROOT"]!, "tests/data/texts/texts.json");
  const { figures, units } = JSON.parse(readFileSync(file, "utf8")) as {
    figures: { value: number; digits: number; text: string }[];
    units: { top: string; bottom: string; quotient: string; product: string }[];
  };
  assert.ok(figures.length > 0 && units.length > 0);
  for (const row of figures) assert.equal(formatNumber(row.value, row.digits), row.text.replaceAll("-", "−"));
  for (const row of units) {
    assert.equal(quotient(row.top, row.bottom), row.quotient);
    assert.equal(product(row.top, row.bottom), row.product);
  }
});

test("numbers have a dash where there is none", () => {
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

test("the limit on the overshoot stands next to it, on Design and in the table, where the verdict says that there is more", () => {
  const figures = figureGroups(unitNames(undefined)).flatMap((group) => group.rows);
  const columns = comparisonColumns(unitNames(undefined));
  const texts = (percent: number | null, limit?: number, who = "asked"): string[] => {
    const said = limit === undefined ? {} : { [`${who}_percent`]: limit };
    const made: Entry = {
      ...entry(),
      performance: { setpoint: { overshoot_percent: percent } },
      verdict: [{ code: "overshoot", level: "note", text: "", figures: { overshoot_percent: percent, ...said } }],
    };
    return [
      figures.find((row) => row.label === "Overshoot (%)")!.value(made).text,
      columns.find((column) => column.id === "overshoot")!.figure(made).text,
    ];
  };
  assert.deepEqual(texts(31.4, 5), ["31.4 (asked 5.00)", "31.4 (asked 5.00)"]);
  assert.deepEqual(texts(31.4, 0), ["31.4 (asked 0)", "31.4 (asked 0)"]);
  assert.deepEqual(texts(31.4, 5, "design"), ["31.4 (design 5.00)", "31.4 (design 5.00)"]);
  assert.deepEqual(texts(31.4), ["31.4", "31.4"]);
  assert.deepEqual(texts(null, 5), ["", ""]);
});

test("settings are given in each form that exists, else the reason", () => {
  const units = unitNames({ time: "s", u: "%", y: "degC" });
  const ideal = settingsOf(entry(), "ideal", units);
  assert.ok(Array.isArray(ideal));
  assert.equal(settingsText("ideal", ideal), "form: ideal\nKp = 2.58 %/°C\nTi = 16.1 s\nTd = 3.43 s\nTf = 0.343 s");
  const weighed = { ...entry(), controller: { ...entry().controller!, b: 0, setpoint_filter: { T: 4 } } };
  const lines = settingsText("ideal", settingsOf(weighed, "ideal", units) as Setting[]).split("\n");
  assert.deepEqual(lines.slice(-2), ["b = 0", "Set-point filter = 4 s"]);
  assert.match(String(settingsOf(entry(), "series", units)), /no series form/);
  assert.ok(Array.isArray(settingsOf(entry(), "parallel", units)));
});

