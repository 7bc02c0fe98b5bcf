import assert from "node:assert/strict";
import test from "node:test";
import { ahead } from "../../../web/src/live/ahead.ts";

const settle = (): Promise<void> => new Promise((resolve) => setImmediate(resolve));

function gated() {
  const asked: number[] = [];
  const open = new Map<number, { answer(): void; fail(): void }>();
  const state = { busy: false };
  const near = ahead<number, number>(
    (question) => {
      asked.push(question);
      return new Promise((resolve, reject) =>
        open.set(question, { answer: () => resolve(10 * question), fail: () => reject(new Error("429")) }),
      );
    },
    () => state.busy,
  );
  const answer = async (question: number): Promise<void> => {
    open.get(question)!.answer();
    await settle();
  };
  return { near, asked, state, answer, open };
}

test("the likeliest comes first, two at a time, and nothing is asked twice", async () => {
  const { near, asked, answer } = gated();
  near.keep(2, 20);
  near.towards([1, 2, 3, 4]);
  assert.deepEqual(asked, [1, 3]);
  await answer(1);
  assert.deepEqual(asked, [1, 3, 4]);
  near.towards([3, 1, 5]);
  await answer(4);
  assert.deepEqual(asked, [1, 3, 4, 5]);
  assert.deepEqual([near.known(1), near.known(2), near.known(3), near.known(4)], [10, 20, undefined, 40]);
});

test("what a hand really asks comes first; where it goes elsewhere, the rest is not asked any more", async () => {
  const { near, asked, state, answer } = gated();
  state.busy = true;
  near.towards([1, 2, 3]);
  assert.deepEqual(asked, []);
  near.towards([7, 8, 9]);
  state.busy = false;
  near.resume();
  assert.deepEqual(asked, [7, 8]);
  state.busy = true;
  await answer(7);
  assert.deepEqual(asked, [7, 8]);
  near.towards([]);
  state.busy = false;
  await answer(8);
  assert.deepEqual(asked, [7, 8]);
});

test("a refusal ends it until the hand moves again; another subject forgets all", async () => {
  const { near, asked, answer, open } = gated();
  near.towards([1, 2, 3]);
  open.get(1)!.fail();
  await settle();
  await answer(2);
  assert.deepEqual(asked, [1, 2]);
  near.towards([1]);
  near.drop();
  await answer(1);
  assert.deepEqual([near.known(1), near.known(2)], [undefined, undefined]);
});
