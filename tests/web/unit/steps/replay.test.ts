import assert from "node:assert/strict";
import test from "node:test";
import type { Entry, Result } from "../../../../web/src/api/types.ts";
import { drawnEntries } from "../../../../web/src/charts/drawn.ts";
import { replayFrame, withReplays } from "../../../../web/src/charts/replay.ts";

const units = { time: "min", u: "%", y: "°C" };
const figures = { IAE: 40, largest_error: 5, travel: 30, reversals: 4 };
const recorded = { from: 100, to: 103, figures, t: [100, 101, 102, 103], r: [50, 50, 55, 55], y: [50, 50, 51, 54], u: [30, 30, 42, 40] };
const better = { figures, IAE_ratio: 0.71, IAE_ratio_low: 0.66, IAE_ratio_high: 0.78, travel_ratio: 1.4, y: [50, 50, 52, 55], u: [30, 30, 45, 39] };
const wide = { refused: { code: "wide-band" as const, text: "The plants that fit the record differ too much." } };
const traces = { t: [0, 1], y: [0, 1], u: [2, 1] };
const entry = (method: string, extra: Partial<Entry> = {}): Entry =>
  ({ method, options: {}, responses: { setpoint: traces, load: traces }, ...extra }) as Entry;
const framed = (result: Result, chosen: number[]) => replayFrame(result, drawnEntries(result, chosen), units);

test("the record and the replays are drawn over the recorded time, the set point with corners", () => {
  const result: Result = {
    replay: recorded,
    controllers: [entry("robust", { replay: better }), entry("simc", { replay: wide }), entry("baseline", { replay: { ...better, y: recorded.y } })],
  };
  const frame = framed(result, [0, 1, 2])!;
  const [y, u] = frame.panes.map((pane) => pane.traces);
  assert.deepEqual(y!.map(({ name }) => name), ["recorded", "robust", "today", "set point"]);
  assert.deepEqual(u!.map(({ name }) => name), ["recorded", "robust", "today"]);
  assert.deepEqual([y![1]!.x, y![1]!.y, u![1]!.y], [recorded.t, better.y, better.u]);
  assert.deepEqual([y![0]!.look, y![1]!.look, y![2]!.look], ["data", 1, 2]);
  assert.deepEqual(y![3]!.x, [100, 101, 102, 102, 103]);
  assert.deepEqual(y![3]!.y, [50, 50, 50, 55, 55]);
  assert.equal(frame.x.label, "time (min)");
  assert.match(frame.description, /^robust: 0\.710 times .*between 0\.660 and 0\.780\. today: /);
});

test("without a replay there is no frame", () => {
  const refused = { refused: { code: "manual" as const, text: "The record shows no controller in automatic." } };
  const one = [entry("robust", { replay: better })];
  assert.equal(framed({ controllers: one }, [0]), null);
  assert.equal(framed({ replay: refused, controllers: [entry("robust")] }, [0]), null);
  assert.equal(framed({ replay: recorded, controllers: [entry("robust", { replay: wide })] }, [0]), null);
  assert.equal(framed({ replay: recorded, controllers: [entry("robust")] }, [0]), null);
  assert.notEqual(framed({ replay: recorded, controllers: one }, [0]), null);
});

test("after a slider has moved, entries whose controller is that of the job keep its replay, and a changed one has none", () => {
  const of = (Kp: number): Entry["controller"] => ({ form: "ideal", Kp, Ti: 10 }) as Entry["controller"];
  const job: Result = {
    replay: recorded,
    controllers: [entry("robust", { controller: of(1), replay: better }), entry("baseline", { controller: of(0.5), replay: wide })],
  };
  const answer: Result = { controllers: [entry("robust", { controller: of(1.1) }), entry("baseline", { controller: of(0.5) })] };
  const drawn = withReplays(job, drawnEntries(answer, [0, 1]));
  assert.deepEqual(drawn.map((item) => item.entry.replay), [undefined, wide]);
  assert.deepEqual(withReplays(job, drawnEntries(job, [0, 1])).map((item) => item.entry.replay), [better, wide]);
});
