// The service's key: asked for once, kept for the tab.
import assert from "node:assert/strict";
import test from "node:test";
import { askForKeyWith, currentKey, otherKey } from "../../../web/src/api/key.ts";

function emptyStorage(): Map<string, string> {
  const kept = new Map<string, string>();
  Object.defineProperty(globalThis, "sessionStorage", {
    configurable: true,
    value: {
      getItem: (name: string) => kept.get(name) ?? null,
      setItem: (name: string, value: string) => kept.set(name, value),
    },
  });
  return kept;
}

test("calls that wait at the same time ask once, and the key is kept", async () => {
  emptyStorage();
  let asked = 0;
  askForKeyWith(() => {
    asked += 1;
    return Promise.resolve("tw_1");
  });
  assert.deepEqual(await Promise.all([otherKey(null), otherKey(null), otherKey(null)]), ["tw_1", "tw_1", "tw_1"]);
  assert.equal(asked, 1);
  assert.equal(currentKey(), "tw_1");
});

test("a key that has come meanwhile is tried before anybody is asked", async () => {
  emptyStorage().set("tunewright-key", "tw_new");
  askForKeyWith(() => Promise.reject(new Error("nobody is to be asked")));
  assert.equal(await otherKey("tw_old"), "tw_new");
});

test("a refused key is asked for again, as refused; none given leaves the old one", async () => {
  const kept = emptyStorage();
  kept.set("tunewright-key", "tw_old");
  const said: boolean[] = [];
  askForKeyWith((refused) => {
    said.push(refused);
    return Promise.resolve(null);
  });
  assert.equal(await otherKey("tw_old"), null);
  assert.deepEqual(said, [true]);
  assert.equal(currentKey(), "tw_old");
});
