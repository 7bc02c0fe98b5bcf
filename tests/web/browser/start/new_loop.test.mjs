// A new loop's request contains the choices for it, and nothing of an example, of an earlier loop or of another card.
import assert from "node:assert/strict";
import test from "node:test";
import { browserTests, dropFile } from "../../harness.mjs";
import { disturbedTest, stepTest } from "../../step_record.mjs";

const tests = browserTests();
const { withPage, post } = tests;

const start = (page) => page.getByRole("navigation", { name: "Screens" }).getByRole("link", { name: "Start" }).click();
const press = (page, name) => page.getByRole("button", { name, exact: true }).click();

/** An earlier loop that uses every part of the form. */
const EARLIER = {
  name: "TIC-EARLIER",
  units: { time: "min", u: "bar", y: "K" },
  record: { csv: disturbedTest, u0: 0, from: 0, to: 240 },
  identify: { model: "fopdt" },
  uncertainty: "identified",
  tune: [{ method: "lambda", lambda: 9 }],
  baseline: { form: "ideal", Kp: 0.5, Ti: 10 },
  implement: { product: "siemens_pid_compact", y_span: [0, 200], u_span: [0, 100] },
  evaluate: { setpoint_step: 7, actuator: { min: -3, max: 4 } },
};

/** Each way to a tuning job, from any state of the page, up to the button that posts it. */
const FLOWS = {
  async "an example of a model in the form"(page) {
    await page.evaluate(() => (location.hash = "#/examples/uncertain-heater"));
    await page.waitForFunction(() => [...document.querySelectorAll("input")].some((input) => input.value === "TIC-102"));
    await press(page, "Tune this model");
  },
  async "an example of a record in the form"(page) {
    await page.evaluate(() => (location.hash = "#/examples/tclab-step"));
    await page.waitForFunction(() => document.querySelector("form.card textarea")?.value.includes("Time,Q1,T1"));
    await press(page, "Tune at once");
  },
  async "a model in one line"(page) {
    await start(page);
    await page.getByLabel("Model in one line").fill("2 e^(-3s)/(10s+1)");
    await press(page, "Tune this model");
  },
  async "a record that is dropped"(page) {
    await start(page);
    await dropFile(page, ".drop", "step.csv", stepTest);
    await press(page, "Use and tune");
  },
  async "a record that is pasted"(page) {
    await start(page);
    const text = page.locator("form.card textarea").first();
    await text.fill(stepTest);
    await text.blur();
    await page.getByRole("button", { name: "Tune at once" }).click();
  },
  async equations(page) {
    await start(page);
    const form = page.getByRole("form", { name: "Equations" });
    await form.getByLabel("Fill from an example").selectOption({ index: 1 });
    await press(page, "Tune these equations");
  },
  async "a relay test"(page) {
    await page.getByRole("navigation", { name: "Screens" }).getByRole("link", { name: "Relay test" }).click();
    await page.getByRole("button", { name: "Simulate", exact: true }).waitFor(); // the screen is loaded when it is first opened
    const line = page.getByLabel("Model in one line");
    // The screen keeps its plant.
    if ((await line.inputValue()) !== "2 e^(-2s)/(10s+1)") {
      const read = page.waitForResponse((response) => response.url().endsWith("/v1/plants/parse"));
      await line.fill("2 e^(-2s)/(10s+1)");
      await line.blur();
      await read;
    }
    const simulated = page.waitForResponse((response) => response.url().endsWith("/v1/experiments/relay"));
    await press(page, "Simulate");
    await simulated;
    await press(page, "Identify this record");
    await press(page, "Use and tune");
  },
  async "a job of the history"(page, job) {
    await page.evaluate((id) => (location.hash = `#/jobs/${id}/edit`), job);
    await page.waitForFunction(() => [...document.querySelectorAll("input")].some((input) => input.value === "TIC-EARLIER"));
    await press(page, "Tune at once");
  },
  async "an operating range"(page) {
    await page.getByRole("navigation", { name: "Screens" }).getByRole("link", { name: "Range" }).click();
    await press(page, "Send as a job");
  },
};

/** A walk over all ordered pairs of different names, each once (Hierholzer). */
function everyPair(names) {
  const left = new Map(names.map((name) => [name, names.filter((other) => other !== name)]));
  const path = [names[0]];
  const walk = [];
  while (path.length > 0) {
    const next = left.get(path[path.length - 1]).pop();
    if (next) path.push(next);
    else walk.push(path.pop());
  }
  return walk.reverse();
}

/** Runs flows one after the other in one page; returns the posted requests, with cheap ones executed instead. */
async function posted(page, names, job) {
  const requests = [];
  await page.route("**/v1/jobs", async (route) => {
    const request = route.request().method() === "POST" ? route.request().postDataJSON() : null;
    // The frontier next to a design is requested automatically.
    if (!request || request.tune?.[0]?.method === "frontier") return route.continue();
    requests.push(request);
    await route.continue({ postData: JSON.stringify({ plant: { type: "fopdt", K: 3, T: 7, L: 2 }, tune: [{ method: "simc" }] }) });
  });
  for (const [index, name] of names.entries()) {
    await FLOWS[name](page, job);
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    assert.equal(requests.length, index + 1, name);
  }
  return requests;
}

test("every flow's request is the same after every other flow", { timeout: 900_000 }, async () => {
  const { id } = await post("v1/jobs", EARLIER);
  const alone = {};
  for (const name of Object.keys(FLOWS))
    await withPage("", {}, async (page) => {
      [alone[name]] = await posted(page, [name], id);
    });
  for (const [name, request] of Object.entries(alone)) {
    const own = name === "a job of the history";
    assert.equal(JSON.stringify(request).includes("TIC-EARLIER"), own, name);
  }
  const walk = everyPair(Object.keys(FLOWS));
  assert.equal(walk.length, Object.keys(FLOWS).length * (Object.keys(FLOWS).length - 1) + 1);
  await withPage("", {}, async (page) => {
    const requests = await posted(page, walk, id);
    requests.forEach((request, index) =>
      assert.deepEqual(request, alone[walk[index]], `${walk[index]} after ${walk[index - 1] ?? "nothing"}`),
    );
  });
});

test("what was typed for a loop stays when its record comes, and goes when it was tuned", async () => {
  await withPage("", {}, async (page) => {
    const form = page.getByRole("form", { name: "Equations" });
    await form.getByLabel("Fill from an example").selectOption({ index: 1 });
    await page.getByLabel("Loop name").fill("TIC-MINE");
    await page.getByLabel("Unit of u").fill("%");
    await page.getByLabel("Kp", { exact: true }).fill("1.5");
    const identified = page.waitForRequest((request) => request.url().endsWith("/v1/identify"));
    await dropFile(page, ".drop", "step.csv", stepTest);
    const asked = (await identified).postDataJSON();
    assert.deepEqual([asked.name, asked.units], ["TIC-MINE", { u: "%" }]);
    const job = page.waitForRequest((request) => request.url().endsWith("/v1/jobs") && request.method() === "POST");
    await press(page, "Use and tune");
    const request = (await job).postDataJSON();
    assert.deepEqual([request.name, request.units, request.baseline.Kp], ["TIC-MINE", { u: "%" }, 1.5]);
    assert.deepEqual(request.tune, [{ method: "robust", Ms: 1.4, Mt: 1.4 }]);
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    await start(page);
    const second = page.waitForRequest((again) => again.url().endsWith("/v1/identify"));
    await dropFile(page, ".drop", "other.csv", stepTest);
    const anew = (await second).postDataJSON();
    assert.deepEqual([anew.name, anew.units], [undefined, undefined]);
  });
});

/** The same test with times in milliseconds, without a stated unit. */
const milliseconds = ["time,u,y", ...stepTest.split("\n").slice(1).map((row) => row.replace(/^(\d+)/, (t) => String(1000 * Number(t))))].join("\n");
const slower = ["time,u,y", ...stepTest.split("\n").slice(1).map((row) => row.replace(/^(\d+)/, (t) => String(10_000 * Number(t))))].join("\n");

for (const [what, text, doubt] of [
  ["a plant slower than a day", slower, /The identified plant is slower than a day/],
  ["any other", milliseconds, /The unit of the record's times is not given/],
])
  test(`a unit of time that nobody named is not sent, and its doubt stands beside the result: ${what}`, async () => {
    await withPage("", {}, async (page) => {
      const asked = page.waitForRequest((request) => request.url().endsWith("/v1/identify"));
      await dropFile(page, ".drop", "trend.csv", text);
      assert.equal((await asked).postDataJSON().units, undefined);
      const side = page.locator(".identify .side");
      await side.getByText(doubt).first().waitFor();
      const job = page.waitForRequest((request) => request.url().endsWith("/v1/jobs") && request.method() === "POST");
      await press(page, "Use and tune");
      assert.equal((await job).postDataJSON().units, undefined);
      await page.locator(".verdict").getByText(doubt).waitFor();
      // The link leads to the choice of the unit, and disappears after it.
      await page.locator(".verdict").getByRole("link", { name: "Choose the unit" }).click();
      await press(page, "Choose the unit");
      await page.getByLabel("Times are in").selectOption("ms");
      await side.getByText(doubt).first().waitFor({ state: "hidden" });
      await press(page, "Use and tune");
      await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
      assert.equal(await page.getByText(doubt).count(), 0);
    });
  });
