// The user's own step on Design: proposed from a record, changed, refused, kept; as the service answers it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import { slider } from "../design_page.mjs";
import { accessibilityViolations, browserTests, overflow, root, tracesShown, WINDOWS } from "../harness.mjs";
import { designAnswered, designOnScreen, requestHandedOut, watchCalls } from "../shown_request.mjs";

const tests = browserTests();
const { withPage, post, jobOf } = tests;

const csv = readFileSync(path.join(root, "tests/data/records/tclab-step.csv"), "utf8");
const RECORD = {
  name: "TIC-101",
  units: { time: "s", u: "%", y: "degC" },
  record: { csv, columns: { t: "Time", u: "Q1", y: "T1" } },
  tune: [{ method: "robust" }],
  baseline: { form: "ideal", Kp: 2, Ti: 150 },
};
const MODEL = { ...RECORD, record: undefined, plant: { type: "fopdt", K: 2, T: 10, L: 3 } };
const PLOT = "Own step: r, y and u";

const card = (page) => page.getByRole("region", { name: "Your own step", exact: true });
const field = (page, label) => card(page).getByRole("textbox", { name: label });
const figures = (page) => card(page).getByRole("region", { name: "Figures of your own step" });
const cells = (page, row) =>
  figures(page)
    .getByRole("row", { name: row })
    .getByRole("cell")
    .allInnerTexts();
const open = (page) => card(page).getByText("Your own step", { exact: true }).click();
/** The entries of the call that the card makes. */
const asked = (page) => page.waitForResponse((response) => response.url().endsWith("v1/evaluate") && response.status() === 200).then((answer) => answer.json());
/** Types a text and leaves the field; returns the entries answered. */
async function change(page, label, text) {
  const answer = asked(page);
  await field(page, label).fill(text);
  await field(page, label).press("Tab");
  return (await answer).controllers;
}
const three = (value) => String(Number(value.toPrecision(3)));
const shown = (text) => String(Number(text.replace("−", "-")));

async function openJob(page, request) {
  const { id } = await post("v1/jobs", request);
  await page.goto(`${tests.service.base}/#/jobs/${id}/design`);
  await slider(page, "Robustness Ms").waitFor();
  return id;
}

test("a record shows its own step without typing, with today's settings next to the new ones", async () => {
  await withPage("", {}, async (page) => {
    const answer = asked(page);
    await openJob(page, RECORD);
    const { controllers } = await answer;
    await tracesShown(page, PLOT, 2 * 3 + 1);
    const { y0, u0 } = (await jobOf(page)).result.model.data_quality;
    assert.ok(Math.abs(Number(await field(page, "y at rest (°C)").inputValue()) - y0) < 0.01);
    assert.equal(Number(await field(page, "u at rest (%)").inputValue()), u0);
    assert.equal(await field(page, "Highest u (%)").inputValue(), "100");
    const columns = await figures(page).getByRole("columnheader").allInnerTexts();
    const settling = await cells(page, /^Settling/);
    assert.equal(columns.length, controllers.length);
    assert.deepEqual(settling.map(shown), controllers.map(({ own_step }) => three(own_step.setpoint.settling_time)));
    assert.equal((await cells(page, /^Time at the upper limit \(s\)/)).length, controllers.length);
    assert.ok(!page.url().includes("step."), "nothing was changed");
    assert.equal((await requestHandedOut(page)).evaluate?.own_step, undefined);
  });
});

test("a changed step is in the address, the request and the verdict, and after Back and a reload", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    await openJob(page, MODEL);
    await open(page);
    await tracesShown(page, PLOT, 2 * 2 + 1);
    await change(page, "New set point (°C)", "60");
    await change(page, "Highest u (%)", "40");
    const controllers = await change(page, "Size of the load (%)", "-5");
    await page.waitForURL(/step\.target=60.*step\.load\.size=-5/);
    const peaks = controllers.map(({ own_step }) => three(own_step.load.peak));
    await page.waitForFunction(() => [...document.querySelectorAll(".own-step tbody")].length === 3);
    assert.deepEqual((await cells(page, /^Peak/)).map(shown), peaks);
    await settled();
    const request = await requestHandedOut(page);
    const { result } = await post("v1/jobs", request);
    const said = (await designOnScreen(page)).verdict;
    assert.deepEqual([...said].sort(), [...designAnswered(result.controllers[0]).verdict].sort());
    assert.deepEqual(request.evaluate.own_step, { y: 0, u: 0, target: 60, u_max: 40, load: { size: -5, at: "input", shape: "step" } });
    await page.evaluate(() => (location.hash = "#/jobs"));
    await page.getByRole("heading", { name: "Jobs", level: 1 }).waitFor();
    await page.goBack();
    await slider(page, "Robustness Ms").waitFor();
    assert.equal(await field(page, "Size of the load (%)").inputValue(), "-5");
    await page.reload();
    await slider(page, "Robustness Ms").waitFor();
    await tracesShown(page, PLOT, 2 * 2 + 1);
    assert.equal(await field(page, "Size of the load (%)").inputValue(), "-5");
    assert.deepEqual((await cells(page, /^Peak/)).map(shown), peaks);
    await card(page).getByRole("button", { name: "Reset the step" }).click();
    await page.waitForFunction(() => !location.hash.includes("step."));
    await page.waitForFunction((label) => label.value === "1", await field(page, "New set point (°C)").elementHandle());
  });
});

test("a step that is kept is in the job, in its report, and in the design that a slider moves", async () => {
  await withPage("", {}, async (page) => {
    const before = await openJob(page, MODEL);
    await open(page);
    await change(page, "New set point (°C)", "60");
    assert.equal(await page.getByRole("link", { name: "Report" }).count(), 0, "the job's report has another request");
    await card(page).getByRole("button", { name: "Keep this step" }).click();
    await page.waitForFunction((id) => !location.hash.includes(id), before);
    await card(page).getByRole("button", { name: "Keep this step" }).waitFor({ state: "hidden" });
    const job = await jobOf(page);
    assert.deepEqual(job.request.evaluate.own_step, { y: 0, u: 0, target: 60 });
    assert.ok(!page.url().includes("step."));
    assert.equal(await field(page, "New set point (°C)").inputValue(), "60");
    const report = await (await fetch(`${tests.service.base}/v1/jobs/${job.id}/report.html`)).text();
    assert.match(report, /Your own step/);
    const answer = asked(page);
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("Shift+ArrowRight");
    await page.waitForURL(/Ms=1\.5/);
    const [faster] = (await answer).controllers;
    await page.waitForFunction(
      (text) => document.querySelector(".own-step table")?.textContent.includes(text),
      three(faster.own_step.travel),
    );
    await page.getByRole("button", { name: "Keep this design" }).click();
    await page.waitForFunction((id) => !location.hash.includes(id), job.id);
    assert.equal((await jobOf(page)).request.evaluate.own_step.target, 60);
  });
});

test("a fault is at its field, the last answer is marked, and a step that cannot be simulated says why", async () => {
  await withPage("", {}, async (page) => {
    await openJob(page, MODEL);
    await open(page);
    await tracesShown(page, PLOT, 2 * 2 + 1);
    await field(page, "New set point (°C)").fill("warm");
    await field(page, "New set point (°C)").press("Tab");
    await card(page).getByText("New set point \"warm\" is not a number.").waitFor();
    assert.equal(await field(page, "New set point (°C)").getAttribute("aria-invalid"), "true");
    await card(page).getByText("These results belong to the last answered request").waitFor();
    await change(page, "New set point (°C)", "2");
    await field(page, "Highest u (%)").fill("-3");
    await field(page, "Highest u (%)").press("Tab");
    await card(page).getByText(/u at rest.*outside its limits/).first().waitFor();
    await change(page, "Highest u (%)", "9");
    await card(page).getByText("These results belong").waitFor({ state: "hidden" });
    await openJob(page, { plant: { type: "nonlinear", states: { h: 1 }, parameters: { A: 2, k: 0.5 }, equations: { h: "(q-k*sqrt(h))/A" }, input: { name: "q", nominal: 0.5 }, output: "h", L: 0.2 }, tune: [{ method: "robust" }] });
    if (!(await card(page).locator("details").evaluate((element) => element.open))) await open(page);
    await card(page).getByText("The plant is given by equations").first().waitFor();
  }, ["422"]);
});

const LONG = "Nm³/h at 0 °C, 101 kPa";

for (const [window, options] of WINDOWS)
  test(`the card has room for long units and is accessible: ${window}`, async () => {
    await withPage("", options, async (page) => {
      await openJob(page, { ...MODEL, units: { time: "working hours (UTC)", u: LONG, y: LONG.replace("N", "m") } });
      await open(page);
      await field(page, /^Size of the load/).fill("3");
      await card(page).getByRole("combobox", { name: "Shape of the load" }).selectOption("pulse");
      await change(page, /^Duration of the load/, "20");
      await tracesShown(page, PLOT, 2 * 2 + 1);
      assert.equal(await overflow(page), 0);
      const inside = await card(page).evaluate((element) => {
        const right = element.getBoundingClientRect().right;
        return [...element.querySelectorAll("input, select, label, svg, .scroll")].filter((part) => part.getBoundingClientRect().right > right).length;
      });
      assert.equal(inside, 0, "parts beyond the card");
      assert.deepEqual(await accessibilityViolations(page), []);
    });
  });
