// Design shows one request: a slider changes one member of it, the kept design is the displayed one, and verdicts and
// the replay of a record belong to it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import { openDesign, PLANT, setting, shows, slider } from "../design_page.mjs";
import { browserTests, dropFile, root, tracesShown } from "../harness.mjs";
import { assertRequestIsShown, designAnswered, designOnScreen, watchCalls } from "../shown_request.mjs";
import { loopTest, stepTest } from "../step_record.mjs";

const { withPage, jobOf, post } = browserTests();
const heater = readFileSync(path.join(root, "tests/data/records/tclab-step.csv"), "utf8");

async function tuneRecord(page, name, text) {
  await dropFile(page, ".drop", name, text);
  await page.getByRole("button", { name: "Use and tune" }).click();
  await slider(page, "Robustness Ms").waitFor();
}

test("a slider on a design for a record's region designs for the region", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    await tuneRecord(page, "heater.csv", heater);
    const Kp = await setting(page, "Kp");
    assert.ok(Math.abs(Kp / 4.05 - 1) < 0.01, `Kp ${Kp}`);
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("ArrowRight");
    await page.waitForURL(/Ms=1\.41/);
    await settled();
    const modified = await setting(page, "Kp");
    assert.ok(modified > Kp && modified < 1.05 * Kp, `Kp ${Kp} becomes ${modified}`);
    const { request } = await assertRequestIsShown(page, post, "one step");
    assert.equal(request.tune[0].Ms, 1.41);
    assert.ok(request.record, "the request is that of the record");
  });
});

test("a gain by hand on a record's design is judged on the record's region", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    await tuneRecord(page, "heater.csv", heater);
    const Kp = page.locator(".controls").getByRole("textbox", { name: "Kp" });
    await Kp.fill("11");
    await Kp.press("Enter");
    await page.waitForURL(/Kp=11/);
    await settled();
    const { verdict } = await designOnScreen(page);
    assert.match(verdict[0], /on the worst plant|unstable/i);
    await assertRequestIsShown(page, post, "by hand");
  });
});

test("the model of a record is sent while a slider moves, not the record", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    await tuneRecord(page, "heater.csv", heater);
    await settled();
    const bodies = [];
    page.on("request", (request) => {
      if (request.url().endsWith("/v1/design")) bodies.push(request.postDataJSON());
    });
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("ArrowRight");
    await page.waitForURL(/Ms=1\.41/);
    await settled();
    assert.ok(bodies.length > 0);
    for (const body of bodies) assert.deepEqual([body.record, typeof body.model.covariance], [undefined, "object"]);
  });
});

test("a design that takes long says that it follows, and follows when it is let go", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    // Like a job whose design took a second.
    await page.route("**/v1/jobs/*", async (route) => {
      const response = await route.fetch();
      if (response.status() !== 200) return route.fulfill({ response });
      const job = await response.json();
      for (const entry of job.result?.controllers ?? []) entry.compute_ms = 1000;
      await route.fulfill({ response, json: job });
    });
    await page.goto(new URL(PLANT, page.url()).href);
    await openDesign(page);
    await settled();
    const Kp = await setting(page, "Kp");
    const range = slider(page, "Robustness Ms");
    const asked = [];
    page.on("request", (request) => request.url().endsWith("/v1/design") && asked.push(request));
    await range.evaluate((input) => {
      input.value = String(Number(input.value) + 20);
      input.dispatchEvent(new Event("input", { bubbles: true }));
    });
    await page.getByText("Follows when you release the slider: this design takes about 1.0 s.").waitFor();
    assert.deepEqual([asked.length, await setting(page, "Kp")], [0, Kp]);
    await page.getByText("The figures below follow when you release the slider.").waitFor();
    await range.evaluate((input) => input.dispatchEvent(new Event("change", { bubbles: true })));
    await page.waitForURL(/Ms=1\.6/);
    await settled();
    await page.getByText(/Follows when you release the slider/).waitFor({ state: "hidden" });
    assert.ok((await setting(page, "Kp")) > Kp);
    await assertRequestIsShown(page, post, "let go");
  });
});

test("every member of the request stays when one is turned: product, limits of u, set point, baseline, the other entries", async () => {
  const request = {
    units: { time: "min", u: "%", y: "degC" },
    plant: { type: "fopdt", K: 1.25, T: 40, L: 8, uncertainty: { K: [0.8, 1.2] } },
    tune: [{ method: "robust", Ms: 1.5, Mt: 1.5, setpoint: { overshoot: 2 } }, { method: "simc" }, { method: "lambda" }],
    baseline: { form: "ideal", Kp: 0.6, Ti: 50 },
    implement: { product: "siemens_pid_compact", y_span: [0, 200], u_span: [0, 100] },
    evaluate: { setpoint_step: 5, actuator: { min: -20, max: 30 } },
  };
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    const { id } = await post("v1/jobs", request);
    await page.goto(new URL(`#/jobs/${id}/design?entry=0`, page.url()).href);
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("Shift+ArrowRight");
    await page.waitForURL(/Ms=1\.6/);
    await settled();
    const shown = await assertRequestIsShown(page, post, "one step");
    const { tune, ...others } = shown.request;
    const { tune: before, ...same } = request;
    assert.deepEqual(others, same);
    assert.deepEqual(tune.slice(1), before.slice(1));
    assert.deepEqual([tune[0].Ms, tune[0].Mt, tune[0].setpoint.overshoot], [1.6, 1.6, 2]);
  });
});

for (const [what, open] of [
  ["a plant", (page) => page.goto(new URL(PLANT, page.url()).href).then(() => openDesign(page, true))],
  ["a record", (page) => tuneRecord(page, "heater.csv", heater)],
]) {
  test(`Keep keeps what is on the screen, to the digit, and Back leads to the design before: ${what}`, async () => {
    await withPage("", {}, async (page) => {
      const settled = watchCalls(page);
      await open(page);
      await settled();
      const first = { job: (await jobOf(page)).id, ...(await designOnScreen(page)) };
      for (const [name, value] of [["Robustness Ms", "1.55"], ["Set-point overshoot", "0"]]) {
        const field = page.locator(".controls").getByRole("textbox", { name });
        await field.fill(value);
        await field.press("Enter");
        await settled();
      }
      const modified = await designOnScreen(page);
      assert.notDeepEqual(modified.settings, first.settings);
      await page.getByRole("button", { name: "Keep this design" }).click();
      await page.waitForFunction((id) => !location.hash.includes(id), first.job);
      await settled();
      assert.deepEqual(await designOnScreen(page), modified);
      const kept = await jobOf(page);
      const entry = Number(/entry=(\d+)/.exec(page.url())[1]);
      assert.deepEqual(designAnswered(kept.result.controllers[entry]).settings, modified.settings);
      assert.equal(await page.getByText("The kept design differs from the one shown").count(), 0);
      await page.goBack();
      await page.waitForURL(new RegExp(first.job));
      await slider(page, "Robustness Ms").waitFor();
      await settled();
      assert.deepEqual((await designOnScreen(page)).settings, first.settings);
      await page.goForward();
      await page.waitForURL(new RegExp(kept.id));
      await slider(page, "Robustness Ms").waitFor();
      await settled();
      assert.deepEqual(await designOnScreen(page), modified);
    });
  });
}

test("a kept design that comes out otherwise says what differs", async () => {
  await withPage(PLANT, {}, async (page) => {
    const settled = watchCalls(page);
    await openDesign(page);
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("Shift+ArrowRight");
    await settled();
    await page.route("**/v1/jobs", async (route) => {
      if (route.request().method() !== "POST") return route.continue();
      const response = await route.fetch();
      const job = await response.json();
      job.result.controllers[0].controller.Kp = 2.5;
      await route.fulfill({ response, json: job });
    });
    await page.getByRole("button", { name: "Keep this design" }).click();
    await page.getByText(/The kept design differs from the one shown: Kp 2\.\d+ is now 2\.5; the service, version .*, recalculated it\./).waitFor();
  });
});

test("a job opens on the entry that its answer says to take", async () => {
  const request = {
    plant: { type: "fopdt", K: 1.25, T: 40, L: 8 },
    tune: [{ method: "ziegler_nichols_step" }, { method: "simc" }, { method: "robust", Ms: 1.4, Mt: 1.4 }],
  };
  await withPage("", {}, async (page) => {
    const { id, result } = await post("v1/jobs", request);
    const { entry } = result.verdict[0].figures;
    assert.ok(entry > 0, "the first is not the one to take");
    await page.goto(new URL(`#/jobs/${id}/design`, page.url()).href);
    await shows(page, "Kp", result.controllers[entry].controller.Kp);
    assert.deepEqual(await designOnScreen(page), designAnswered(result.controllers[entry]));
  });
});

test("after a comparison of all methods a slider and a value by hand ask for one design, which can be kept", async () => {
  const plant = { type: "transfer_function", num: [1], den: [1, 4, 6, 4, 1] };
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    const { id, result } = await post("v1/jobs", { plant, tune: [{ method: "all" }] });
    assert.ok(result.controllers.length > 50, "more than a request may list");
    const drawn = () => page.locator(".legend .legend-item").allInnerTexts();
    const refused = [];
    page.on("response", (response) => response.status() === 422 && refused.push(response.url()));
    await page.goto(new URL(`#/jobs/${id}/design`, page.url()).href);
    await slider(page, "Robustness Ms").waitFor();
    const before = await drawn();
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("Shift+ArrowRight");
    await page.waitForURL(/Ms=/);
    await settled();
    assert.deepEqual(await drawn(), [...before, "proposal"], "the same rows, and the proposal from which one was moved");
    const { request } = await assertRequestIsShown(page, post, "one step");
    assert.equal(request.tune.length, 1);
    const Kp = page.locator(".controls").getByRole("textbox", { name: "Kp" });
    await Kp.fill("1");
    await Kp.press("Enter");
    await page.waitForURL(/Kp=1/);
    await settled();
    assert.deepEqual(await drawn(), [...before, "proposal"]);
    const modified = await designOnScreen(page);
    await page.getByRole("button", { name: "Keep these settings" }).click();
    await page.waitForFunction((first) => !location.hash.includes(first), id);
    await settled();
    assert.deepEqual((await designOnScreen(page)).settings, modified.settings);
    await page.getByRole("link", { name: "Change sheet" }).waitFor();
    assert.deepEqual(refused, []);
  });
});

const replayCard = (page) => page.getByRole("region", { name: "Replay of the record", exact: true });

test("the record of a loop is drawn again with the new settings, and its figures are those of the answer", async () => {
  await withPage("", {}, async (page) => {
    await tuneRecord(page, "loop.csv", loopTest());
    const { result } = await jobOf(page);
    const [entry] = result.controllers;
    assert.ok(!result.replay.refused && !entry.replay.refused, JSON.stringify([result.replay.refused, entry.replay?.refused]));
    // The record shows today's settings too: y and u of the record, of the entry and with today's settings, and the set point.
    assert.equal(result.controllers[1].method, "baseline");
    await tracesShown(page, "Record and replay", 7);
    const rows = await replayCard(page).locator("tbody tr").allInnerTexts();
    const shown = (value) => (value < 1000 ? value.toPrecision(3) : String(Number(value.toPrecision(3))));
    const { IAE_ratio, IAE_ratio_low, IAE_ratio_high, figures } = entry.replay;
    const cells = rows.map((row) => row.split("\t"));
    assert.equal(cells[0][2], `${shown(IAE_ratio)} (${shown(IAE_ratio_low)} to ${shown(IAE_ratio_high)})`);
    assert.ok(cells[1][1].startsWith(shown(result.replay.figures.IAE)) && cells[1][2] === shown(figures.IAE), rows[1]);
    const { replay: today } = result.controllers[1];
    assert.ok(today.IAE_ratio_low <= 1 && 1 <= today.IAE_ratio_high, "with today's settings the hour is the record");
    const finding = entry.verdict.find(({ code }) => code === "replay");
    assert.ok((await page.getByRole("region", { name: "Verdict" }).innerText()).includes(finding.text));
    // A changed design is not the one that was replayed; today's settings stay.
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("ArrowRight");
    await page.waitForURL(/Ms=1\.41/);
    await replayCard(page).getByText("are not replayed").waitFor();
    await tracesShown(page, "Record and replay", 5);
  });
});

test("a test by hand has no replay, and the page says why; a model has none to speak of", async () => {
  await withPage("", {}, async (page) => {
    await tuneRecord(page, "step.csv", stepTest);
    const { result } = await jobOf(page);
    assert.equal(result.replay.refused.code, "manual");
    assert.equal(await replayCard(page).locator("p").innerText(), result.replay.refused.text);
    await tracesShown(page, "Record and replay", 0);
  });
  await withPage("#/new/fopdt?K=2&T=10&L=3", {}, async (page) => {
    await openDesign(page);
    assert.equal(await replayCard(page).count(), 0);
  });
});
