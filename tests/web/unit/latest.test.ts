import assert from "node:assert/strict";
import test from "node:test";
import { latest, newest } from "../../../web/src/api/latest.ts";
import { bodyOf, decoded } from "../../../web/src/api/client.ts";

const settle = (): Promise<void> => new Promise((resolve) => setImmediate(resolve));

/** Calls whose answers arrive when the test releases them. */
function gated(underWay?: number) {
  const sent: number[] = [];
  const answers: number[] = [];
  const errors: string[] = [];
  const busy: boolean[] = [];
  const aborted: number[] = [];
  const open = new Map<number, { answer(): void; fail(sentence: string): void }>();
  const calls = latest<number, number>(
    (request, signal) => {
      sent.push(request);
      signal.addEventListener("abort", () => aborted.push(request));
      return new Promise((resolve, reject) =>
        open.set(request, {
          answer: () => resolve(10 * request),
          fail: (sentence) => reject(new Error(sentence)),
        }),
      );
    },
    {
      onBusy: (is) => busy.push(is),
      onAnswer: (answer) => answers.push(answer),
      onError: (error) => errors.push((error as Error).message),
    },
    underWay,
  );
  const answer = async (request: number): Promise<void> => {
    open.get(request)!.answer();
    await settle();
  };
  const fail = async (request: number, sentence: string): Promise<void> => {
    open.get(request)!.fail(sentence);
    await settle();
  };
  return { calls, sent, answers, errors, busy, aborted, answer, fail };
}

test("an answer is reported when it arrives although a newer request waits; what came between is never sent", async () => {
  const { calls, sent, answers, answer, busy } = gated(1);
  for (const request of [1, 2, 3, 4]) calls.send(request);
  assert.deepEqual(sent, [1]);
  await answer(1);
  assert.deepEqual([sent, answers], [[1, 4], [10]]);
  calls.send(5);
  await answer(4);
  assert.deepEqual([sent, answers], [[1, 4, 5], [10, 40]]);
  await answer(5);
  assert.deepEqual(answers, [10, 40, 50]);
  assert.deepEqual([busy[0], busy.at(-1)], [true, false]);
});

test("a few calls are under way at once, and one that is overtaken is not reported", async () => {
  const { calls, sent, answers, errors, answer, fail } = gated(3);
  for (const request of [1, 2, 3, 4, 5]) calls.send(request);
  assert.deepEqual(sent, [1, 2, 3]);
  await answer(2);
  assert.deepEqual([sent, answers], [[1, 2, 3, 5], [20]]);
  await answer(1);
  await answer(3);
  await answer(5);
  assert.deepEqual(answers, [20, 30, 50]);
  calls.send(6);
  calls.send(7);
  await answer(7);
  await fail(6, "too late to matter");
  assert.deepEqual([answers.at(-1), errors], [70, []]);
});

test("with delayed answers a drag of a second is drawn all the time", async () => {
  // 60 inputs a second, 60 ms to each answer; the clock is the test's own.
  const { calls, answers, answer, sent } = gated();
  const due: [number, number][] = [];
  for (let now = 0; now < 1000; now += 1) {
    if (now % 16 === 0) calls.send(now);
    for (const request of sent.slice(due.length)) due.push([now + 60, request]);
    for (const [at, request] of due) if (at === now) await answer(request);
  }
  assert.ok(answers.length >= 10, `${answers.length} answers in a second`);
  assert.deepEqual(answers, [...answers].sort((a, b) => a - b));
});

test("what is dropped is ended and not reported, a later request is", async () => {
  const { calls, answers, errors, aborted, answer, fail } = gated(2);
  calls.send(1);
  calls.send(2);
  calls.send(3);
  calls.drop();
  assert.deepEqual(aborted, [1, 2]);
  await answer(1);
  await fail(2, "ended");
  calls.send(4);
  await answer(4);
  assert.deepEqual([answers, errors], [[40], []]);
});

test("a refusal is reported, and the next answer after it", async () => {
  const { calls, answers, errors, answer, fail } = gated(1);
  calls.send(1);
  calls.send(2);
  await fail(1, "busy");
  await answer(2);
  assert.deepEqual([errors, answers], [["busy"], [20]]);
});

test("an answer at hand is reported at once, and what is on its way is older than it", async () => {
  const { calls, sent, answers, answer } = gated(1);
  for (const request of [1, 2]) calls.send(request);
  calls.give(30, 3);
  await answer(1);
  assert.deepEqual([sent, answers], [[1], [30]]);
  calls.send(4);
  await answer(4);
  assert.deepEqual(answers, [30, 40]);
});

test("of work that is begun again only the newest is, and each begins its own", () => {
  const begin = newest();
  const first = begin();
  assert.ok(first());
  const second = begin();
  assert.deepEqual([first(), second()], [false, true]);
  newest()();
  assert.ok(second(), "another kind of work");
});

test("a body with a record of megabytes is written in slices, as JSON.stringify writes it", async () => {
  const csv = `t,u,y\n"${"0,1,2\n".repeat(90_000)}\\ \u0001 😀`.padEnd(1_499_999, "x") + "😀".repeat(3);
  for (const body of [{ name: "a", record: { csv, columns: { t: "t" } }, tune: "all" }, { csv, dt: 1 }, { record: { csv: "t,u,y" } }, { units: {} }]) {
    const sent = await bodyOf(body);
    assert.equal(sent instanceof Blob, JSON.stringify(body).length > 1000);
    assert.deepEqual(JSON.parse(sent instanceof Blob ? await sent.text() : (sent as string)), body);
  }
  const bytes = new TextEncoder().encode(csv).buffer;
  assert.equal(await decoded(bytes, "utf-8"), csv);
});
