// What else a record holds: a run of several, a further measured input, today's settings of its loop.
import assert from "node:assert/strict";
import test from "node:test";
import { accessibilityViolations, browserTests, dropFile } from "../../harness.mjs";
import { slider } from "../../design_page.mjs";
import { loopUnderPI } from "../../made_records.mjs";
import { candidatesShown, identified } from "../../step_record.mjs";

const tests = browserTests();
const { withPage, jobOf } = tests;

const ripple = (t) => 0.01 * Math.sin(37 * t);
const row = (...cells) => cells.map((cell) => (Number.isInteger(cell) ? String(cell) : cell.toFixed(4))).join(",");

/** A step of u by 5 at 20 s, from rest at y = 20. */
const stepRun = ({ K, T, L }, count) =>
  Array.from({ length: count }, (_, t) => {
    const since = t - 20 - L;
    return row(t, t >= 20 ? 5 : 0, 20 + (since > 0 ? 5 * K * (1 - Math.exp(-since / T)) : 0) + ripple(t));
  });

const FIRST = { K: 2, T: 30, L: 5 };
const SECOND = { K: 3, T: 12, L: 4 };
const idle = Array.from({ length: 60 }, (_, t) => row(t, 0, 20 + ripple(t)));
const threeRuns = ["t,u,y", ...stepRun(FIRST, 300), ...stepRun(SECOND, 200), ...idle].join("\n");

// Both inputs with a lag and a dead time of their own; each is constant between samples.
const HEATER = { K: 2, T: 30, L: 5 };
const AMBIENT = { K: 1.5, T: 25, L: 8 };
const ambientAt = (t) => (t < 150 ? 0 : t < 260 ? 4 : -2);
function twoInputs() {
  const lagged = ({ K, T, L }, input) => {
    let state = 0;
    return (t) => {
      const now = state;
      state += (K * input(t - L) - state) * (1 - Math.exp(-1 / T));
      return now;
    };
  };
  const [heated, warmed] = [lagged(HEATER, (t) => (t >= 20 ? 5 : 0)), lagged(AMBIENT, ambientAt)];
  return ["t,u,y,ambient", ...Array.from({ length: 400 }, (_, t) => row(t, t >= 20 ? 5 : 0, 20 + heated(t) + warmed(t) + ripple(t), 15 + ambientAt(t)))].join("\n");
}

function assertNear(plant, { K, T, L }, what) {
  assert.ok(Math.abs(plant.K / K - 1) < 0.005, `${what}: K ${plant.K} for ${K}`);
  assert.ok(Math.abs(plant.T / T - 1) < 0.01, `${what}: T ${plant.T} for ${T}`);
  assert.ok(Math.abs(plant.L - L) < 0.1, `${what}: L ${plant.L} for ${L}`);
}

const reading = (page) => page.getByText("How the record is read").click();
const optionsOf = (select) => select.locator("option").evaluateAll((list) => list.map((option) => option.value));
/** The request that a choice sends, and its answer. */
async function chosen(page, label, value) {
  const [response] = await Promise.all([
    page.waitForResponse((answer) => answer.url().endsWith("/v1/identify")),
    page.getByLabel(label, { exact: true }).selectOption(value),
  ]);
  return { asked: response.request().postDataJSON(), status: response.status(), answer: await response.json() };
}

test("of a file with several runs the first test is read, and each other one when it is chosen", async () => {
  await withPage(
    "",
    {},
    async (page) => {
      const first = identified(page);
      await dropFile(page, ".drop", "runs.csv", threeRuns);
      const answer = await first;
      assert.equal((await answer).request().postDataJSON().record.run, undefined);
      assertNear((await (await answer).json()).model.plant, FIRST, "read by itself");
      await candidatesShown(page);
      await reading(page);
      const run = page.getByLabel("Run of the file", { exact: true });
      await run.locator("option[value='3']").waitFor({ state: "attached" });
      assert.deepEqual(await optionsOf(run), ["", "1", "2", "3"]);
      const [to] = [page.getByRole("textbox", { name: "Use up to" })];
      assert.equal(await to.inputValue(), "299");

      // A part of the first run is not meaningful in the second.
      const part = identified(page);
      await to.fill("249");
      await to.press("Enter");
      assert.equal((await part).request().postDataJSON().record.to, 249);
      const second = await chosen(page, "Run of the file", "2");
      assert.deepEqual([second.asked.record.run, second.asked.record.from, second.asked.record.to], [2, undefined, undefined]);
      assertNear(second.answer.model.plant, SECOND, "the second");
      await page.waitForFunction(() => document.querySelectorAll(".part input[type=text]")[1].value === "199");

      // A run without a test is refused at its place, and the previous one can be chosen again.
      const third = await chosen(page, "Run of the file", "3");
      assert.deepEqual([third.status, third.asked.record.run], [422, 3]);
      assert.ok(third.answer.errors.every(({ pointer }) => pointer.startsWith("/record")), JSON.stringify(third.answer.errors));
      await page.locator(".summary:visible").waitFor();
      assert.equal(await page.getByRole("button", { name: "Use and tune" }).filter({ visible: true }).count(), 0);
      const again = await chosen(page, "Run of the file", "2");
      assertNear(again.answer.model.plant, SECOND, "the second again");
      await page.getByRole("button", { name: "Use and tune" }).click();
      await page.getByRole("heading", { name: "Model from the record" }).waitFor();
      const job = await jobOf(page);
      assert.equal(job.request.record.run, 2);
      assertNear(job.result.model.plant, SECOND, "tuned");
    },
    ["422"],
  );
});

test("a run that is chosen on Start is the one that is tuned, and another file knows nothing of it", async () => {
  await withPage("", {}, async (page) => {
    await page.getByText("Columns, kind of test, model").click();
    const run = page.getByLabel("Run of the file", { exact: true });
    assert.equal(await run.isVisible(), false);
    const text = page.getByLabel("or paste it");
    await text.fill(threeRuns);
    await text.blur();
    await run.waitFor();
    await run.locator("option[value='2']").waitFor({ state: "attached" });
    const looked = page.waitForResponse((response) => response.url().endsWith("/v1/records/preview"));
    await run.selectOption("2");
    assert.equal((await looked).request().postDataJSON().run, 2);
    await page.getByRole("button", { name: "Tune at once" }).click();
    await page.getByRole("heading", { name: "Model from the record" }).waitFor();
    const job = await jobOf(page);
    assert.equal(job.request.record.run, 2);
    assertNear(job.result.model.plant, SECOND, "tuned");

    // The request of a job restores its run, even before the preview of the file.
    await page.getByRole("link", { name: "Change the request" }).click();
    await page.getByRole("heading", { name: "What do you have?" }).waitFor();
    await page.waitForFunction(() => [...document.querySelectorAll("select")].some((select) => select.value === "2"));
    const single = identified(page);
    await dropFile(page, ".drop", "single.csv", ["t,u,y", ...stepRun(FIRST, 300)].join("\n"));
    const asked = (await single).request().postDataJSON();
    assert.equal(asked.record.run, undefined);
  });
});

test("a further measured input is identified together with u, and named with what it does", async () => {
  await withPage(
    "",
    {},
    async (page) => {
      // Without this input no model follows y.
      const alone = page.waitForResponse((response) => response.url().endsWith("/v1/identify"));
      await dropFile(page, ".drop", "room.csv", twoInputs());
      assert.equal((await alone).status(), 422);
      assert.equal((await (await alone).json()).type, "not-identifiable");
      const input = page.getByLabel("Measured disturbance", { exact: true });
      if (!(await input.isVisible())) await reading(page);
      await input.locator("option[value='ambient']").waitFor({ state: "attached" });
      const { asked, answer } = await chosen(page, "Measured disturbance", "ambient");
      assert.deepEqual(asked.record.columns, { d: ["ambient"] });
      assertNear(answer.model.plant, HEATER, "u");
      const [{ name, plant, share }] = answer.model.disturbances;
      assert.equal(name, "ambient");
      assertNear(plant, AMBIENT, "ambient");
      await candidatesShown(page);
      const found = page.getByRole("region", { name: "Was the test good enough?" });
      await found.getByText("Details of the record").click();
      const text = await found.locator("dt", { hasText: "ambient" }).locator("+ dd").innerText();
      const figures = [...text.matchAll(/(\d+(?:\.\d+)?)/g)].map(([figure]) => Number(figure));
      const four = (value) => Number(value.toPrecision(4));
      assert.deepEqual(figures, [plant.K, plant.T, plant.L].map(four).concat(Number((100 * share).toPrecision(2))));

      await page.getByRole("button", { name: "Use and tune" }).click();
      await page.getByRole("heading", { name: "Model from the record" }).waitFor();
      const job = await jobOf(page);
      assert.deepEqual(job.request.record.columns, { d: ["ambient"] });
      assertNear(job.result.model.plant, HEATER, "tuned");
    },
    ["422"],
  );
});

test("a request with two further inputs keeps both through the form, which shows the first", async () => {
  await withPage("", {}, async (page) => {
    const csv = twoInputs()
      .split("\n")
      .map((line, at) => (at === 0 ? `${line},door` : `${line},${at > 200 && at < 320 ? 1 : 0}`))
      .join("\n");
    const { id } = await tests.post("v1/jobs", {
      record: { csv, columns: { d: ["ambient", "door"] } },
      tune: [{ method: "simc" }],
    });
    await page.goto(new URL(`#/jobs/${id}/edit`, page.url()).href);
    await page.getByText("Columns, kind of test, model").waitFor();
    await page.waitForFunction(() => [...document.querySelectorAll("select")].some((select) => select.value === "ambient"));
    const posted = page.waitForRequest((request) => request.method() === "POST" && request.url().endsWith("/v1/jobs"));
    await page.getByRole("button", { name: "Tune at once" }).click();
    assert.deepEqual((await posted).postDataJSON().record.columns, { d: ["ambient", "door"] });
    await page.getByRole("heading", { name: "Model from the record" }).waitFor();
    const { result } = await jobOf(page);
    assertNear(result.model.plant, HEATER, "u");
    // The door has no effect: it is left out, and a note names it.
    assert.deepEqual(result.model.disturbances.map(({ name }) => name), ["ambient"]);
  });
});

/** The same record as a historian keeps it: u and y to whole units. */
const rounded = (csv) =>
  csv.replaceAll(/,(\d+)\.(\d)\d*/g, (_, whole, tenth) => `,${Number(whole) + (tenth >= "5" ? 1 : 0)}`);

const today = (page) => page.getByRole("region", { name: /^Today's settings/ });

/** Drops a record, waits for what Identify says about today's settings in it, and returns to Start. */
async function dropped(page, text, words) {
  await page.waitForLoadState("networkidle");
  await dropFile(page, ".drop", "trend.csv", text);
  const said = await today(page).getByText(words).innerText();
  await page.goBack();
  await page.getByRole("heading", { name: "What do you have?" }).waitFor();
  return said;
}

test("the settings that moved u in the record are today's, in the form and in a product", async () => {
  await withPage("", {}, async (page) => {
    const sent = [];
    page.on("request", (request) => request.url().endsWith("/v1/records/controller") && sent.push(request.url()));
    const found = await dropped(page, loopUnderPI(), /^From the record: Kp [0-9.]+/);
    const take = today(page).getByRole("checkbox", { name: "Use as today's settings" });
    assert.ok(await take.isChecked(), "settings that are certain are taken");
    assert.equal(await today(page).getByLabel("Form").isVisible(), false);
    const [, Kp, Ti] = /Kp ([0-9.]+)(?: ± [0-9.]+)?, Ti ([0-9.]+)/.exec(found).map(Number);
    assert.ok(Math.abs(Kp / 0.8 - 1) < 0.02 && Math.abs(Ti / 60 - 1) < 0.02, found);
    assert.equal(sent.length, 1);
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.getByRole("button", { name: "Tune at once" }).click();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    const { request } = await tests.jobOf(page);
    assert.equal(request.baseline, "from-record");
    const todays = async (name) =>
      Number((await page.locator("table.typed tbody tr").filter({ has: page.locator("th", { hasText: name }) }).locator("td").first().innerText()));
    assert.ok(Math.abs((await todays("Kp")) / 0.8 - 1) < 0.02, await page.locator("table.typed").innerText());
    assert.ok(Math.abs((await todays("Ti")) / 60 - 1) < 0.02, await page.locator("table.typed").innerText());

    const picker = page.getByRole("combobox", { name: "Maker and product" });
    await picker.fill("deltav standard");
    await page.getByRole("option", { name: "Emerson DeltaV PID, FORM Standard" }).click();
    for (const [end, value] of [["from", "0"], ["to", "200"]]) {
      const field = page.getByRole("group", { name: /^Measurement range/ }).getByRole("textbox", { name: end });
      await field.fill(value);
      await field.press("Tab");
    }
    const before = page.url();
    await page.getByRole("button", { name: "Design for this controller" }).click();
    await page.waitForURL((url) => url.href !== before);
    await page.locator("table.typed tr", { hasText: "GAIN" }).getByText(/^1\.(6|59|61)/).waitFor();
    const redesigned = await tests.jobOf(page);
    assert.deepEqual([redesigned.request.baseline, redesigned.request.implement.product], ["from-record", "emerson_deltav_standard"]);
    assert.ok(Math.abs((await todays("GAIN")) / 1.6 - 1) < 0.02, await page.locator("table.typed").innerText());
    assert.ok(Math.abs((await todays("RESET")) / 60 - 1) < 0.02, await page.locator("table.typed").innerText());

    const robustness = slider(page, "Robustness Ms");
    await robustness.focus();
    const [answered] = await Promise.all([
      page.waitForResponse((response) => response.url().endsWith("/v1/design")),
      robustness.press("ArrowRight"),
    ]);
    assert.equal(answered.status(), 200, await answered.text());
    assert.ok(answered.request().postDataJSON().baseline.Kp > 0, "what was found goes along with the model");
    assert.ok(Math.abs((await todays("GAIN")) / 1.6 - 1) < 0.02, await page.locator("table.typed").innerText());
  });
});

test("a record that leaves the settings open says why, and is tuned without them", async () => {
  await withPage("", {}, async (page) => {
    await dropped(page, rounded(loopUnderPI()), /^There are no settings from the record\. \S/);
    assert.equal(await today(page).getByRole("checkbox", { name: "Use as today's settings" }).isVisible(), false);
    assert.ok(await today(page).getByLabel("Form").isVisible());
    await page.getByRole("button", { name: "Tune at once" }).click();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    assert.equal((await tests.jobOf(page)).request.baseline, undefined);
  });
});
