import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import { accessibilityViolations, browserTests, dropFile, overflow, root, tracesShown, WINDOWS } from "../harness.mjs";
import { candidatesShown, disturbedTest, identified, rows, stepTest } from "../step_record.mjs";

const { withPage, jobOf } = browserTests();

const shown = (value, digits = 3) => Number(Number(value).toPrecision(digits));

test("a dropped record is identified at once, and Use and tune leads to its design", async () => {
  await withPage("", {}, async (page) => {
    const answered = identified(page);
    await dropFile(page, ".drop", "step.csv", stepTest);
    const { model } = await (await answered).json();
    await candidatesShown(page);
    assert.match(page.url(), /#\/identify$/);
    const options = page.getByRole("group", { name: "Which model to use" }).locator("label");
    assert.equal(await options.count(), model.candidates.length);
    const chosen = await options.filter({ has: page.locator(":checked") }).innerText();
    assert.match(chosen, /chosen by the service/);
    assert.match(chosen, new RegExp(`fit ${shown(model.fit_percent)}`));
    assert.match(chosen, /K 2\.000\d+ ± 0\.001\d+/);
    await page.getByText(model.choice_reason).waitFor();
    await tracesShown(page, "Record and model", 4);
    assert.match(await page.getByRole("region", { name: "Was the test good enough?" }).innerText(), /Good enough/);
    await page.getByText("u steps once, at 20 s, from 0 to 5.").waitFor();

    await page.getByRole("button", { name: "Use and tune" }).click();
    await page.getByRole("heading", { name: "Model from the record" }).waitFor();
    const { request, result } = await jobOf(page);
    assert.equal(request.record.csv, stepTest);
    assert.deepEqual(result.model.plant, model.plant);
    assert.ok(Math.abs(result.model.plant.K / 2 - 1) < 0.01);
    await tracesShown(page, "Recorded test and model", 3);
    await tracesShown(page, "Load step at the plant input", 2);
  });
});

test("a relay test shows its limit cycle, the plant's ultimate point, measured points and what warns of them", async () => {
  await withPage("", {}, async (page) => {
    // In the form of the service's answer, with arbitrary figures.
    const limit_cycle = {
      Pu: 14.391,
      Au: 0.22326,
      phi_u: -2.21885,
      periods: 9,
      shift: { sigma: 0.1, A: 0.17049, phi: -2.01 },
      fit_rms: 0.0031,
      describing_function: { Ku: 3.9, Pu: 14.391 },
    };
    await page.route("**/v1/identify", async (route) => {
      const reply = await route.fetch();
      const answer = await reply.json();
      answer.model.limit_cycle = limit_cycle;
      answer.model.ultimate_point = { Ku: 8.123, Pu: 7.654 };
      answer.model.frequency_points = [{ omega: 0.4366, re: -0.1347, im: 0.178, std: 0.0012 }];
      answer.model.warnings = [{ code: "phase-crossover-beyond-data", detail: "The loop crosses beyond the record." }];
      await route.fulfill({ response: reply, json: answer });
    });
    const relayTest = readFileSync(path.join(root, "tests/data/records/relay_ex3_unbiased.csv"), "utf8");
    await dropFile(page, ".drop", "relay.csv", relayTest);
    await candidatesShown(page);
    const cycle = page.getByRole("region", { name: "Limit cycle" });
    const cell = async (label) =>
      (await cycle.locator("tr").filter({ hasText: label }).first().locator("td").first().innerText()).replace(
        "−",
        "-",
      );
    assert.equal(Number(await cell("period of the oscillation")), 14.391);
    assert.equal(Number(await cell("Au")), 0.2233);
    assert.equal(Number(await cell("φu")), -2.219);
    assert.equal(Number(await cell("Periods")), 9);
    assert.equal(Number(await cell("ultimate gain, of the plant itself")), 8.123);
    assert.equal(Number(await cell("ultimate period, of the plant itself")), 7.654);
    assert.equal(Number(await cell("describing function")), 3.9);
    await cycle.getByText("1 measured point of G(jω)").click();
    assert.match(await cycle.getByRole("table").nth(1).innerText(), /0\.4366\s+−0\.1347\s+0\.1780\s+0\.0012/);
    const quality = await page.getByRole("region", { name: "Was the test good enough?" }).innerText();
    assert.match(quality, /Usable with care: 1 warning\.\s+The loop crosses beyond the record\./);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("limits on all that the record leaves possible are asked for by a check box, and the choice stays with the job", async () => {
  await withPage("", {}, async (page) => {
    await dropFile(page, ".drop", "step.csv", stepTest);
    await candidatesShown(page);
    await page.getByText(/^By robust; /).waitFor();
    const box = page.getByRole("checkbox", { name: "Always meet the limits for every model consistent with the record" });
    assert.ok(!(await box.isChecked()));
    await box.check();
    await page.getByRole("button", { name: "Use and tune" }).click();
    await page.getByRole("link", { name: "Look at the record" }).waitFor();
    assert.equal((await jobOf(page)).request.uncertainty, "identified");
    await page.getByRole("link", { name: "Look at the record" }).click();
    await candidatesShown(page);
    assert.ok(await box.isChecked());
    await box.uncheck();
    const sent = page.waitForRequest((request) => request.method() === "POST" && request.url().endsWith("/v1/jobs"));
    await page.getByRole("button", { name: "Use and tune" }).click();
    assert.equal((await sent).postDataJSON().uncertainty, undefined);
  });
});

test("another candidate is drawn with its own run and tuned as that model", async () => {
  await withPage("", {}, async (page) => {
    const answered = identified(page);
    await dropFile(page, ".drop", "step.csv", stepTest);
    const { model } = await (await answered).json();
    await candidatesShown(page);
    const residual = () =>
      page
        .locator("section.plot svg.canvas path")
        .evaluateAll((list) => list.map((item) => item.getAttribute("d")).join());
    const before = await residual();
    const other = model.candidates.findIndex((item) => item.plant.type === "sopdt");
    await page.getByRole("radio").nth(other).check();
    await page.waitForFunction(
      (old) =>
        [...document.querySelectorAll("section.plot svg.canvas path")].map((p) => p.getAttribute("d")).join() !== old,
      before,
    );
    await page.getByRole("button", { name: "Use and tune" }).click();
    await page.getByRole("heading", { name: "Model from the record" }).waitFor();
    const { request, result } = await jobOf(page);
    assert.equal(request.identify.model, "sopdt");
    assert.equal(result.model.plant.type, "sopdt");
    assert.ok(Math.abs(result.model.plant.K / model.candidates[other].plant.K - 1) < 1e-6);
  });
});

test("the part that counts is chosen by slider, by keys and by number, and identified again on release", async () => {
  await withPage("", {}, async (page) => {
    const first = identified(page);
    await dropFile(page, ".drop", "disturbed.csv", disturbedTest);
    const whole = (await (await first).json()).model;
    await candidatesShown(page);
    const slider = page.getByRole("slider", { name: "Use up to, slider" });
    assert.equal(await slider.getAttribute("aria-valuetext"), "Use up to 399 s");
    const second = identified(page);
    await page.getByLabel("Use up to (s)", { exact: true }).fill("240");
    await page.keyboard.press("Tab");
    const answer = await second;
    assert.equal(answer.request().postDataJSON().record.to, 240);
    const part = (await answer.json()).model;
    assert.ok(Math.abs(part.plant.K / 2 - 1) < 0.02, `K ${part.plant.K}`);
    assert.ok(part.fit_percent > 99 && whole.fit_percent < part.fit_percent);
    assert.equal(part.fit.t.at(-1), 240);
    // The rest of the record stays visible.
    assert.ok((await page.locator("section.plot svg.canvas rect[fill='var(--accent)']").count()) > 0);
    const third = identified(page);
    await slider.focus();
    await page.keyboard.press("Shift+ArrowLeft");
    const moved = (await third).request().postDataJSON().record;
    assert.ok(moved.to < 240 && moved.to > 190, `${moved.to}`);
    const fourth = identified(page);
    await page.getByRole("button", { name: "Use all of it" }).click();
    assert.equal((await fourth).request().postDataJSON().record.to, undefined);
    // The part is sent with the record to the tuner, and returns with the job.
    const fifth = identified(page);
    await page.getByLabel("Use up to (s)", { exact: true }).fill("230");
    await page.keyboard.press("Enter");
    await fifth;
    await page.getByRole("button", { name: "Use and tune" }).click();
    await page.getByRole("heading", { name: "Model from the record" }).waitFor();
    assert.equal((await jobOf(page)).request.record.to, 230);
    await page.getByRole("link", { name: "Look at the record" }).click();
    await candidatesShown(page);
    assert.equal(await page.getByLabel("Use up to (s)", { exact: true }).inputValue(), "230");
  });
});

test("an end of the part that cannot be read keeps its fault, and no model is made without it", async () => {
  await withPage("", {}, async (page) => {
    await dropFile(page, ".drop", "step.csv", disturbedTest);
    await candidatesShown(page);
    let asked = 0;
    page.on("request", (request) => (asked += request.url().endsWith("/v1/identify") ? 1 : 0));
    const [from, to] = ["Use from", "Use up to"].map((name) => page.getByRole("textbox", { name }));
    await from.fill("abc");
    await to.fill("249");
    await to.press("Tab");
    await page.getByText("1 problem to fix").waitFor();
    const error = page.locator(`#${await from.getAttribute("id")}-error`);
    assert.match(await error.innerText(), /^Use from "abc" is not a number\.[^"]*$/);
    assert.equal(await from.getAttribute("aria-invalid"), "true");
    assert.equal(asked, 0);
    const answered = identified(page);
    await from.fill("10");
    await from.press("Tab");
    const { record } = (await answered).request().postDataJSON();
    assert.deepEqual([record.from, record.to], [10, 249]);
    await error.waitFor({ state: "hidden" });
  });
});

test("at 200 % the formula of a third-order model is whole, and a longer one scrolls by the keyboard", async () => {
  const csv = readFileSync(path.join(root, "tests/data/records/tclab-step.csv"), "utf8");
  await withPage("", { width: 720, height: 450 }, async (page) => {
    await dropFile(page, ".drop", "tclab-step.csv", csv);
    await candidatesShown(page);
    const third = page.locator(".candidate").filter({ hasText: "Third order" }).first().locator(".formula");
    await third.locator("math").waitFor();
    assert.ok(await third.evaluate((box) => box.scrollWidth <= box.clientWidth));
    const formulas = page.locator(".candidate .formula");
    assert.ok(await formulas.evaluateAll((all) => all.every((formula) => formula.tabIndex === 0)));
    for (const folded of await page.getByText(/that fits? worse/).all()) await folded.click();
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("a record that cannot be read says why at its field, and is mended there", async () => {
  await withPage(
    "",
    {},
    async (page) => {
      const heater = readFileSync(path.join(root, "tests/data/records/tclab-step.csv"), "utf8").replace(
        /^.*\n/,
        "h,i,j,a,d,e,b\n",
      );
      const looked = page.waitForResponse((response) => response.url().endsWith("/v1/records/preview"));
      await dropFile(page, ".drop", "heater.csv", heater);
      const { problems } = await (await looked).json();
      const errors = problems.map(({ pointer, detail }) => ({ pointer: `/record/${pointer}`, detail }));
      assert.ok(errors.length > 0);
      const summary = page.getByRole("group", { name: "Problems to fix" });
      await summary.waitFor();
      for (const error of errors) {
        assert.ok((await summary.innerText()).includes(error.detail), error.detail);
        const labels = { t: "Time", u: "Controller output (u)", y: "Measurement (y)" };
        const input = page.getByLabel(labels[error.pointer.split("/").at(-1)], { exact: true });
        assert.equal(await input.getAttribute("aria-invalid"), "true");
        assert.equal(await page.locator(`#${await input.getAttribute("id")}-error`).innerText(), error.detail);
      }
      await page.getByLabel("Time", { exact: true }).selectOption("a");
      await page.getByLabel("Controller output (u)", { exact: true }).selectOption("b");
      await page.getByLabel("Measurement (y)", { exact: true }).selectOption("d");
      const answered = identified(page);
      await page.getByRole("button", { name: "Identify this test" }).click();
      assert.ok((await (await answered).json()).model.fit_percent > 97);
      await candidatesShown(page);
      assert.ok(await summary.isHidden());
    },
    ["422"],
  );
});

test("a record that no model explains is still drawn, and the part that one explains can be chosen", async () => {
  // Long after the step another influence moves y.
  const dragged = ["t,u,y", ...rows.map((row, t) => (t < 250 ? row : `${t},5,${30 + 0.1 * (t - 250)}`))].join("\n");
  await withPage(
    "",
    {},
    async (page) => {
      const refused = page.waitForResponse((response) => response.url().endsWith("/v1/identify"));
      await dropFile(page, ".drop", "dragged.csv", dragged);
      const { type, errors, record } = await (await refused).json();
      assert.equal(type, "not-identifiable");
      assert.equal(record.t.length, rows.length);
      const summary = page.getByRole("group", { name: "Problems to fix" });
      await summary.waitFor();
      assert.ok((await summary.innerText()).includes(errors[0].detail));
      await tracesShown(page, "Record", 2);
      assert.equal(await page.getByRole("button", { name: "Use and tune" }).count(), 0);
      const answered = identified(page);
      await page.getByLabel("Use up to (s)", { exact: true }).fill("245");
      await page.keyboard.press("Enter");
      assert.ok(Math.abs((await (await answered).json()).model.plant.K / 2 - 1) < 0.01);
      await candidatesShown(page);
      assert.ok(await summary.isHidden());
      await tracesShown(page, "Record and model", 4);
    },
    ["422"],
  );
});

test("a record in which nothing happens is refused in the service's words", async () => {
  await withPage(
    "",
    {},
    async (page) => {
      const refused = page.waitForResponse((response) => response.url().endsWith("/v1/identify"));
      await dropFile(page, ".drop", "flat.csv", ["t,u,y", ...rows.map((_, t) => `${t},5,20`)].join("\n"));
      const { detail, errors = [] } = await (await refused).json();
      const summary = page.getByRole("group", { name: "Problems to fix" });
      await summary.waitFor();
      // In the page's words, at the text that contains the column.
      const said = await summary.innerText();
      assert.ok(said.includes((errors[0]?.detail ?? detail).replace("u0", '"u before"')), said);
      assert.doesNotMatch(said, /\/record/);
      const text = page.getByRole("textbox", { name: "The record as text" });
      assert.equal(await text.getAttribute("aria-invalid"), "true");
    },
    ["422"],
  );
});

test("Identify without a record says where to get one", async () => {
  await withPage("#/identify", {}, async (page) => {
    await page.getByText("There is no recorded test here yet.").waitFor();
    await page.getByRole("link", { name: "Drop one on Start" }).click();
    await page.getByRole("heading", { name: "What do you have?" }).waitFor();
  });
});

for (const [name, options] of WINDOWS) {
  test(`Identify on a ${name}: axe finds nothing, and nothing is wider than the window`, async () => {
    await withPage("", options, async (page) => {
      await dropFile(page, ".drop", "step.csv", stepTest);
      await candidatesShown(page);
      for (const summary of ["How the record is read", "Details of the record"])
        await page.getByText(summary).click();
      assert.deepEqual(await accessibilityViolations(page), []);
      assert.equal(await overflow(page), 0);
    });
  });
}
