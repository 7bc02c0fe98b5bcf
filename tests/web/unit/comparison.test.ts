import assert from "node:assert/strict";
import test from "node:test";
import type { Entry, Method, Result } from "../../../web/src/api/types.ts";
import { defaultOverlay, entryNames } from "../../../web/src/charts/drawn.ts";
import { byAllMethods, withLambda } from "../../../web/src/form/tuning_request.ts";
import { csvText } from "../../../web/src/plot/export.ts";
import { spark } from "../../../web/src/plot/spark.ts";
import { linkOf } from "../../../web/src/form/link.ts";
import { formatRoute, parseRoute } from "../../../web/src/routes.ts";
import { keptWords } from "../../../web/src/views/link_menu.ts";
import { durationWords } from "../../../web/src/words/numbers.ts";
import { unitNames } from "../../../web/src/words/numbers.ts";
import {
  excessText,
  isCompared,
  comparisonColumns,
  comparisonNames,
  comparisonRows,
  comparisonTable,
  notesSummary,
  orderOf,
  sortRows,
  sortText,
} from "../../../web/src/words/comparison.ts";

const robustness = { stable: true, omega_Ms: 1, Mt: 1, omega_Mt: 1, Mks: 2, gain_margin: 3, gain_margin_low: 0 };
const make = (method: string, Ms: number | null, IAE: number | null, extra: Partial<Entry> = {}): Entry =>
  ({
    method,
    title: `${method} (PI)`,
    controller: { form: "ideal", Kp: 1, Ti: 10, Td: 0 },
    robustness: { ...robustness, stable: Ms !== null, Ms },
    performance: { load: { IAE }, setpoint: { IAE: 1 } },
    responses: { load: { t: [0, 1], y: [0, 1], u: [0, 1] } },
    ...extra,
  }) as Entry;

type Group = NonNullable<NonNullable<Entry["standing"]>["group"]>;
/** Like the service's ranking: `order` without a limit on Ms, `least`: the smallest such limit that it holds. */
const standing = (order: number, least: number | null, group: Group = "holds", why = ""): Partial<Entry> => {
  const settles = group === "holds" || group === "above_limit";
  return { standing: { group, order, least_limit: least, settles, within: true, Ms: least, excess_percent: 0, ...(why ? { why } : {}) } };
};
const result: Result = {
  controllers: [
    make("sharp", 2.5, 3, standing(1, 2.5, "above_limit", "Ms is 2.50, above 2.")),
    make("slow", 1.2, 40, standing(4, 1.2)),
    make("wild", null, null, {
      warnings: [{ code: "outside-validity", detail: "L/T is 9." }],
      ...standing(5, null, "unstable", "The loop is unstable."),
    }),
    make("refused", null, null, { error: { detail: "It needs an integrating plant." } }),
    make("best", 1.4, 8, standing(2, 1.4)),
    make("baseline", 1.3, 20, standing(3, 1.3)),
  ],
};
const methods = (rows: { entry: Entry }[]): string[] => rows.map((row) => row.entry.method);

test("what ranks under the reader's limit stands first, in the service's order, and the rest says why it does not", () => {
  const all: Result = {
    controllers: [
      make("sharp", 1.95, 5, standing(3, 1.95)),
      make("oscillates", 1.5, 1, standing(5, null, "not_settled", "It does not settle.")),
      make("beyond", 1.3, 2, standing(1, 2.4, "above_limit", "On the worst plant Ms is 2.4.")),
      make("missed", 1.5, 2, standing(2, null, "above_limit", "Ms is 1.5, above 1.4.")),
      make("robust", 1.4, 8, standing(4, 1.4)),
    ],
  };
  const rows = comparisonRows(all, 2);
  assert.deepEqual(methods(rows), ["sharp", "robust", "beyond", "missed", "oscillates"]);
  assert.deepEqual(
    rows.map((row) => row.why),
    ["", "", "Ms is above 2.00.", "Ms is 1.5, above 1.4.", "It does not settle."],
  );
  assert.deepEqual(methods(comparisonRows(all, null)), methods(rows), "as the answer itself ranks");
  assert.deepEqual(methods(comparisonRows(all, 1.4)), ["robust", "beyond", "missed", "sharp", "oscillates"]);
  assert.deepEqual(methods(comparisonRows(all, 1.399)).slice(0, 1), ["beyond"], "a limit is the service's to the last digit");
});

test("an answer of an older service keeps its own ranking", () => {
  const older = { settles: true, within: true, Ms: 1.4, excess_percent: 0 };
  const controllers = [
    make("a", 1.4, 8, { standing: older }),
    make("b", 3, 2, { standing: { ...older, why: "Ms is 3, above 2." } }),
    make("c", 1.4, 6, { standing: older }),
  ];
  const rows = comparisonRows({ controllers, ranking: [2, 0, 1] }, null);
  assert.deepEqual(rows.map(({ rank, why }) => [rank, why]), [[1, ""], [2, ""], [null, "Ms is 3, above 2."]]);
  assert.deepEqual(methods(rows), ["c", "a", "b"]);
});

test("what oscillates without settling is drawn at first only where nothing settles", () => {
  const calm = make("calm", 1.4, 8, standing(1, 1.4));
  const wild = make("wild", 1.4, 2, standing(2, null, "not_settled", "It does not settle."));
  assert.deepEqual(defaultOverlay({ controllers: [wild, calm, calm], ranking: [1, 2, 0] }), [1, 2]);
  assert.deepEqual(defaultOverlay({ controllers: [wild, calm], ranking: [1, 0] }), [1]);
  assert.deepEqual(defaultOverlay({ controllers: [wild], ranking: [0] }), [0]);
});

const columns = comparisonColumns(unitNames({ time: "min" }));

test("rows stand in the order of the service within the limit, then beyond it, then unstable, then without an answer", () => {
  const rows = comparisonRows(result, 2);
  assert.deepEqual(methods(rows), ["best", "baseline", "slow", "sharp", "wild", "refused"]);
  assert.deepEqual(
    rows.map((row) => row.rank),
    [1, null, 2, null, null, null],
  );
  assert.equal(rows[1]!.why, "Today's settings, for comparison.");
  assert.equal(rows[3]!.why, "Ms is above 2.00.");
  assert.equal(rows[4]!.why, "The loop is unstable.");
  // Another limit, another ranking.
  assert.deepEqual(
    comparisonRows(result, 3).map((row) => row.rank),
    [1, 2, null, 3, null, null],
  );
  assert.deepEqual(methods(comparisonRows(result, 1.25)), ["slow", "sharp", "best", "baseline", "wild", "refused"]);
});

test("sorting by a column keeps rows without a number last in both directions, and equal rows in their order", () => {
  const rows = comparisonRows(result, 2);
  assert.deepEqual(methods(sortRows(rows, orderOf("Ms"), columns)), [
    "slow",
    "baseline",
    "best",
    "sharp",
    "wild",
    "refused",
  ]);
  assert.deepEqual(methods(sortRows(rows, orderOf("-Ms"), columns)).slice(0, 4), ["sharp", "best", "baseline", "slow"]);
  assert.deepEqual(methods(sortRows(rows, orderOf("-Ms"), columns)).slice(4), ["wild", "refused"]);
  assert.deepEqual(methods(sortRows(rows, orderOf("Kp"), columns)), methods(rows));
  assert.deepEqual(methods(sortRows(rows, orderOf("method"), columns))[0], "best");
  assert.deepEqual(methods(sortRows(rows, orderOf("no_such"), columns)), methods(rows));
  for (const text of ["", "-rank", "Ms", "-excess"]) assert.equal(sortText(orderOf(text)), text);
});

test("figures have three digits; one that is missing says why", () => {
  const figure = (id: string, entry: Entry) => columns.find((column) => column.id === id)!.figure(entry);
  const entry = make("a", 1.23456, 12.3456, {
    optimum_at_Ms: { IAE: 10, excess_percent: 23.456 },
    controller: { form: "ideal", Kp: 0.000123456, Ti: null, Td: 2, filter: { type: "derivative", N: 10 } },
  });
  assert.equal(figure("Ms", entry).text, "1.23");
  assert.equal(figure("load_IAE", entry).text, "12.3");
  assert.equal(figure("excess", entry).text, "+23.5");
  assert.equal(figure("Kp", entry).text, "1.23e−4");
  assert.deepEqual(figure("Ti", entry), { value: null, text: "", why: "no integral action" });
  assert.equal(figure("Tf", entry).value, 0.2);
  const beyond = make("b", 4.5, 1, {
    optimum_at_Ms: { IAE: null, excess_percent: null, why_null: { excess_percent: "Ms is 4.5." } },
  });
  assert.deepEqual(figure("excess", beyond), { value: null, text: "", why: "Ms is 4.5." });
  assert.equal(figure("load_IAE", result.controllers[2]!).why, "The loop is unstable.");
  assert.equal(
    figure(
      "gain_margin",
      make("c", 1.2, 1, {
        robustness: {
          ...robustness,
          Ms: 1.2,
          gain_margin: null,
          why_null: { gain_margin: "It is infinite." },
        } as never,
      }),
    ).why,
    "It is infinite.",
  );
  assert.equal(columns.find((column) => column.id === "Ti")!.label, "Ti (min)");
  assert.deepEqual([0, -1.1e-5, 0.5, 290.4, -3].map(excessText), ["0", "0", "+0.500", "+290", "−3.00"]);
});

test("the table as a file has every column, all digits, remarks and reasons", () => {
  const table = comparisonTable(comparisonRows(result, 2), columns);
  assert.deepEqual(table[0]!.slice(0, 4), ["rank", "method", "title", "Kp"]);
  assert.equal(table.length, 7);
  assert.ok(table.every((row) => row.length === table[0]!.length));
  const at = table[0]!.indexOf("Ms");
  assert.deepEqual(
    table.slice(1).map((row) => row[at]),
    [1.4, 1.3, 1.2, 2.5, null, null],
  );
  assert.equal(table[6]!.at(-1), "It needs an integrating plant.");
  assert.match(csvText(table), /,"refused \(PI\)"|,refused \(PI\),/);
  assert.equal(notesSummary(result.controllers[2]!), "unstable, outside validity");
});

test("variants are distinguished by what their titles end with", () => {
  const named = (title: string): Entry => ({ method: "cohen_coon", title });
  assert.deepEqual(entryNames([named("Cohen-Coon (PI)"), named("Cohen-Coon (PID)"), { method: "simc" }]), [
    "cohen coon PI",
    "cohen coon PID",
    "simc",
  ]);
});

test("a row's name is its title with the variant; authors go where that leaves no two alike", () => {
  const titled = (title: string): Entry => ({ method: "x", title });
  assert.deepEqual(
    comparisonNames([titled("SIMC (Skogestad) (PI)"), titled("IMC (Liu and Gao)"), { method: "baseline" }]),
    ["SIMC (PI)", "IMC (Liu and Gao)", "Today's settings"],
  );
  assert.deepEqual(comparisonNames([titled("SIMC (A) (PI)"), titled("SIMC (B) (PI)"), titled("AMIGO"), titled("AMIGO")]), [
    "SIMC (A) (PI)",
    "SIMC (B) (PI)",
    "AMIGO",
    "AMIGO #2",
  ]);
});

test("at first the best is drawn with today's settings, or the two best", () => {
  assert.deepEqual(defaultOverlay({ ...result, ranking: [4, 5, 1, 0, 2] }), [4, 5]);
  assert.deepEqual(defaultOverlay({ controllers: result.controllers.slice(0, 5), ranking: [4, 1, 0, 2] }), [1, 4]);
});

test("the table's address keeps its order and its chosen rows", () => {
  for (const hash of [
    "#/jobs/a1/compare",
    "#/jobs/a1/compare?sort=-Ms&rows=0.12",
    "#/jobs/a1/compare?rows=3&Ms=1.5",
    "#/methods",
    "#/methods/cohen_coon",
  ])
    assert.equal(formatRoute(parseRoute(hash)), hash);
  assert.deepEqual(parseRoute("#/jobs/a1/compare?rows=x&Ms=1"), { screen: "compare", job: "a1", sort: "", rows: null });
});

test("one design of a comparison of all methods is tuned again alone", () => {
  const ran: Result = {
    controllers: [
      { method: "simc", options: { controller: "PI", tau_c: null } },
      { method: "rimc", options: { Ms: 1.6 } },
      { method: "baseline" },
    ],
  };
  const options = { properties: { lambda: {}, Ms: { "x-in-place-of": "lambda" } } };
  const methods = [{ id: "rimc", options }] as unknown as Method[];
  const request = byAllMethods({ plant: { type: "fopdt" }, tune: [{ method: "robust" }] });
  assert.deepEqual(request.tune, [{ method: "all" }]);
  assert.deepEqual(withLambda(request, ran, 1, 7, methods).tune, [
    { method: "rimc", lambda: 7, curve: true },
  ]);
});

test("a sparkline is one line in its box, whatever the data", () => {
  const scale = { x: [0, 10] as const, y: [0, 1] as const, level: 1 };
  for (const y of [[0, 1, 0.5], [null, 1, 1e30], [0, NaN, 1], []]) {
    const tree = spark({ name: "", look: 1, x: [0, 5, 10], y }, scale);
    const paths = (tree.children ?? []).map((child) => String((child as { attributes: { d: string } }).attributes.d));
    assert.equal(paths.length, 2);
    for (const path of paths) assert.doesNotMatch(path, /NaN|Infinity/);
  }
});

test("a link holds a request's model, units, controller, today's settings and options, and its length is bounded", () => {
  const request = {
    name: "TIC-101",
    units: { time: "min", y: "degC" },
    plant: { type: "fopdt", K: 1.25, T: 40, L: 8 },
    tune: [{ method: "robust", Ms: 1.6, Mt: 1.4 }, { method: "simc" }],
    baseline: { form: "parallel", Kp: 1.2, Ki: 0.03, Kd: null, b: 0.5, filter: { type: "derivative", Tf: 2 } },
    implement: { product: "emerson_deltav_standard", y_span: [0, 200] as [number, number], sample_time: 0.5, computation_delay: 0.1 },
    evaluate: { setpoint_step: 7 },
  };
  const link = linkOf(request)!;
  assert.deepEqual(link.values, {
    K: "1.25",
    T: "40",
    L: "8",
    "loop.name": "TIC-101",
    "loop.time": "min",
    "loop.y": "degC",
    controller: "emerson_deltav_standard",
    "controller.y": "0..200",
    "controller.sample_time": "0.5",
    "today.form": "parallel",
    "today.1": "1.2",
    "today.2": "0.03",
    "today.Tf": "2",
    "today.rest": '{"b":0.5}',
    how: "robust simc",
    "how.robust": '{"Ms":1.6,"Mt":1.4}',
    rest: '{"evaluate":{"setpoint_step":7},"implement":{"computation_delay":0.1}}',
  });
  const hash = formatRoute(link);
  assert.deepEqual(parseRoute(hash), link);
  assert.ok(hash.length < 700, hash);
  // What is too long for mail and chat loses options before today's settings, and the plant last.
  const long = parseRoute(formatRoute({ ...link, values: { ...link.values, rest: "x".repeat(5000) } }));
  assert.deepEqual(long, { ...link, values: Object.fromEntries(Object.entries(link.values).filter(([name]) => name !== "rest")) });
  const longer = parseRoute(formatRoute({ ...link, values: { ...link.values, "how.robust": "x".repeat(5000) } }));
  assert.ok(longer.screen === "new" && longer.values["today.1"] === "1.2" && longer.values["how"] === undefined);
  assert.equal(linkOf({ record: { csv: "t,u,y" }, tune: "all" }), null);
  const implement = { product: "p", y_span: [0, 200] as [number, number] };
  const baseline = { ...implement, settings: { GAIN: 1.5, ON: true } };
  const typed = linkOf({ plant: request.plant, baseline, implement })!;
  assert.deepEqual([typed.values["today.form"], typed.values["today.set.GAIN"], typed.values["today.set.ON"]], ["own", "1.5", "true"]);
});

test("a request that a link cannot hold has no link", () => {
  const { plant } = { plant: { type: "fopdt", K: 1, T: 2, L: 1 } };
  const implement = { product: "p", y_span: [0, 200] as [number, number] };
  const settings = { GAIN: 1.5 };
  for (const request of [
    { plant, tune: "all" as const },
    { plant, tune: [] },
    { plant, baseline: { product: "p", settings } },
    { plant, baseline: { product: "q", y_span: implement.y_span, settings }, implement },
    { plant, baseline: { product: "p", y_span: [0, 100] as [number, number], settings }, implement },
  ])
    assert.equal(linkOf(request), null, JSON.stringify(request));
  assert.notEqual(linkOf({ plant, tune: [{ method: "simc" }] }), null);
});

test("a link to a job says how long it works", () => {
  assert.deepEqual([604800, 86400, 129600, 90, 1].map(durationWords), ["7 days", "1 day", "36 hours", "90 seconds", "1 second"]);
  assert.match(keptWords("2026-03-02T08:00:00Z", 604800), /^The link works until .*9.*2026.*: the service keeps a job for 7 days after its end\.$/);
  assert.match(keptWords(null, 3600), /for 1 hour after its end/);
  assert.match(keptWords(null, 0), /without limit/);
  assert.doesNotMatch(keptWords("2026-03-02T08:00:00Z", undefined), /undefined|NaN|Invalid/);
});

test("rows without the optimum are not ranked by the excess over it", () => {
  const entry = (optimum_at_Ms?: Entry["optimum_at_Ms"]): Entry => ({ method: "robust", ...(optimum_at_Ms ? { optimum_at_Ms } : {}) });
  assert.equal(isCompared({ controllers: [entry(), entry({ excess_percent: null } as never)] }), false);
  assert.equal(isCompared({ controllers: [entry(), entry({ excess_percent: 0 } as never)] }), true);
});
