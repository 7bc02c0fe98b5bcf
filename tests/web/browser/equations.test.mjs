import assert from "node:assert/strict";
import test from "node:test";
import { accessibilityViolations, browserTests, overflow, tracesShown, WINDOWS } from "../harness.mjs";

const tests = browserTests();
const { withPage, jobOf } = tests;

const TANK = "#/new/nonlinear?x.h=1&dx.h=(q-k*sqrt(h))/A&p.A=2&p.k=0.5&input=q&nominal=0.5&output=h&L=0.2";
const form = (page) => page.getByRole("form", { name: "Equations" });
const field = (page, label) => form(page).getByLabel(label, { exact: true });
const operating = (page) => page.getByRole("region", { name: "Operating point" });
const designShown = (page) => page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
const tune = (page) => page.getByRole("button", { name: "Tune these equations" }).click();

test("equations are tuned as they were typed, and the page shows their operating point and linear model", async () => {
  await withPage(TANK, {}, async (page) => {
    assert.equal(await field(page, "dh/dt =").inputValue(), "(q-k*sqrt(h))/A");
    await field(page, "Value of h near the operating point").fill("0,9");
    await form(page).getByRole("button", { name: "Add a parameter" }).click();
    const added = form(page).getByRole("group", { name: "Parameter", exact: true });
    await added.getByLabel("Name of the parameter").fill("unused");
    await field(page, "Value of unused").fill("2*A");
    await tune(page);
    await designShown(page);
    const job = await jobOf(page);
    assert.deepEqual(job.request.plant, {
      type: "nonlinear",
      states: { h: 0.9 },
      parameters: { A: 2, k: 0.5, unused: "2*A" },
      equations: { h: "(q-k*sqrt(h))/A" },
      input: { name: "q", nominal: 0.5 },
      output: "h",
      L: 0.2,
    });
    const { operating_point } = job.result;
    assert.ok(Math.abs(operating_point.states.h - 1) < 1e-9);
    const row = operating(page).locator("tr").filter({ hasText: /^h/ });
    assert.deepEqual(await row.locator("td").allInnerTexts(), ["1.00000", "0.900000"]);
    // dh/dt = -k/(2 A sqrt(h)) h + q/A = -0.125 h + 0.5 q about h = 1.
    assert.match(
      await operating(page).locator("dl").innerText(),
      /Poles[^\n]*\s+−0\.125\s+Zeros[^\n]*\s+none\s+Gain\s+4\.000/,
    );
    await operating(page).getByRole("math").waitFor();
    // The request can be changed in the form in which it was entered.
    await page.getByRole("link", { name: "Change the request" }).click();
    assert.equal(await field(page, "Value of unused").inputValue(), "2*A");
    assert.equal(await field(page, "Dead time (s)").inputValue(), "0.2");
  });
});

test("rows come and go, the focus stays near, and the address keeps what is typed", async () => {
  await withPage(TANK, {}, async (page) => {
    await form(page).getByRole("button", { name: "Add a state" }).click();
    assert.equal(await page.evaluate(() => document.activeElement.closest(".row").className), "row state-row");
    await page.keyboard.type("T");
    await field(page, "Value of T near the operating point").fill("20");
    await field(page, "dT/dt =").fill("18 - T + q");
    await field(page, "dT/dt =").blur();
    await form(page).getByRole("button", { name: "Remove parameter A" }).click();
    assert.equal(await page.evaluate(() => document.activeElement.value), "k");
    await page.reload();
    assert.equal(await field(page, "dT/dt =").inputValue(), "18 - T + q");
    assert.equal(await form(page).getByLabel("Name of the parameter").count(), 1);
    assert.equal(await field(page, "Value of h near the operating point").inputValue(), "1");
  });
});

test("what the service refuses stands at the row it is about, and the text stays", async () => {
  await withPage(
    TANK,
    {},
    async (page) => {
      await field(page, "dh/dt =").fill("(q - k*sqrt(hh))/A");
      await field(page, "Value of k").fill("0.5*");
      await tune(page);
      const summary = page.getByRole("group", { name: "Problems to fix" });
      await summary.waitFor();
      assert.ok(await summary.evaluate((element) => element === document.activeElement));
      const value = field(page, "Value of k");
      assert.equal(await value.getAttribute("aria-invalid"), "true");
      const [described] = (await value.getAttribute("aria-describedby")).split(" ");
      assert.match(await page.locator(`[id="${described}"]`).innerText(), /parameter k, character 5/);
      assert.equal(await value.inputValue(), "0.5*");
      await value.fill("0.5");
      await tune(page);
      const rate = field(page, "dh/dt =");
      await page.waitForFunction((input) => input.getAttribute("aria-invalid") === "true", await rate.elementHandle());
      assert.match(await form(page).locator(".state-row .error").last().innerText(), /hh/);
      assert.equal(await value.getAttribute("aria-invalid"), null);
      await summary.getByRole("link").click();
      assert.ok(await rate.evaluate((element) => element === document.activeElement));
    },
    ["422"],
  );
});

test("what is missing is said without asking the service", async () => {
  await withPage(TANK, {}, async (page) => {
    await field(page, "dh/dt =").fill("");
    await field(page, "Its value").fill("half");
    await tune(page);
    const summary = page.getByRole("group", { name: "Problems to fix" });
    await summary.getByRole("heading", { name: "2 problems to fix" }).waitFor();
    for (const label of ["dh/dt =", "Its value"])
      assert.equal(await field(page, label).getAttribute("aria-invalid"), "true", label);
    // The model card shows its own faults only.
    assert.equal(await page.getByLabel("K", { exact: true }).first().getAttribute("aria-invalid"), null);
  });
});

/** The reactor's temperature loop, tuned by emulation and by the robust optimum. */
async function tuneReactor(page) {
  const choice = form(page).getByLabel("Fill from an example");
  await choice.selectOption({ label: await choice.locator("option", { hasText: "temperature" }).innerText() });
  assert.equal(await field(page, "Name of the input").inputValue(), "Tj");
  await tune(page);
  await designShown(page);
  // Design opens with the entry that the answer proposes, which is the robust optimum.
  await page.getByRole("button", { name: "emulation", exact: true }).click();
  await emulationCard(page).waitFor();
}

const emulationCard = (page) => page.getByRole("region", { name: "Emulation of a nonlinear controller" });
const shown = (value) => Number(Number(value).toPrecision(5));
const typed = (text) => Number(text.split("\n")[0].replace("−", "-"));

test("a reactor tuned by emulation shows both levels and the responses on both plants", async () => {
  await withPage("", {}, async (page) => {
    await tuneReactor(page);
    const { result } = await jobOf(page);
    const { emulation, controller, linear } = result.controllers[0];
    const rows = emulationCard(page).locator("table.levels tbody tr");
    assert.equal(await rows.count(), emulation.level1.length + 2);
    for (const [index, level] of emulation.level1.entries()) {
      if (!level.controller) continue;
      const cells = await rows.nth(index).locator("td").allInnerTexts();
      assert.equal(typed(cells[0]), shown(level.controller.Kp), level.title);
    }
    const own = await emulationCard(page).locator("tr.own td").allInnerTexts();
    assert.equal(typed(own[0]), shown(controller.Kp));
    assert.equal(typed(own[1]), shown(controller.Ti));
    assert.equal(typed(own.at(-1)), Number(emulation.J.toPrecision(3)));
    const facts = await emulationCard(page).locator("dl").innerText();
    assert.match(facts, /Relative degree\s+1\b/);
    assert.match(facts, /before J grows by 5 %/);
    assert.ok((await emulationCard(page).innerText()).includes(emulation.fit.sentence));
    await tracesShown(page, "PID and nonlinear controller", 4);
    // Classical settings are added on request.
    await emulationCard(page).getByRole("checkbox", { disabled: false }).first().check();
    await tracesShown(page, "PID and nonlinear controller", 6);
    // Two controllers, each on the equations and on their linear model, in y and u.
    assert.ok(linear.responses.setpoint.t.length > 20);
    await tracesShown(page, "Set-point step", 8);
    await page.getByText("Responses are those of the equations").waitFor();
    assert.match(await operating(page).innerText(), /CA\s+0\.520330\s+0\.520000/);
    assert.deepEqual(await accessibilityViolations(page), []);
    // For another method there is no such card.
    await page.getByRole("button", { name: "robust", exact: true }).click();
    await emulationCard(page).waitFor({ state: "hidden" });
  });
});

test("other scenarios are drawn on request, and settings by hand answer on the equations", async () => {
  await withPage("", {}, async (page) => {
    await tuneReactor(page);
    const plot = page.getByRole("img", { name: "PID and nonlinear controller" });
    const before = await plot.locator("path").first().getAttribute("d");
    await emulationCard(page).getByLabel("Scenario").selectOption("1");
    await page.waitForFunction(
      ([svg, path]) => svg.querySelector("path").getAttribute("d") !== path,
      [await plot.elementHandle(), before],
    );
    await emulationCard(page).getByText("Try other settings").click();
    const slider = emulationCard(page).getByRole("slider", { name: "Kp, slider" });
    const asked = page.waitForRequest((request) => request.url().endsWith("/v1/evaluate"));
    await slider.focus();
    await page.keyboard.press("Shift+ArrowRight");
    const sent = (await asked).postDataJSON();
    assert.equal(sent.plant.type, "nonlinear");
    assert.equal(sent.evaluate.setpoint_step, -10);
    await emulationCard(page).getByText("by hand", { exact: true }).waitFor();
    await tracesShown(page, "PID and nonlinear controller", 6);
    const sentence = await emulationCard(page)
      .getByText(/^J of this scenario/)
      .innerText();
    const [, tried, best] = /^J of this scenario ([\d.]+); of the optimum ([\d.]+)$/.exec(sentence).map(Number);
    assert.ok(tried > best && best > 0, sentence);
    await emulationCard(page).getByRole("button", { name: "Back to the optimum" }).click();
    await tracesShown(page, "PID and nonlinear controller", 4);
  });
});

test("the comparison takes a nonlinear plant's methods, with their curves together", async () => {
  await withPage("", {}, async (page) => {
    await tuneReactor(page);
    await page.getByRole("link", { name: "Comparison table" }).click();
    await page.getByRole("heading", { name: "Chosen rows, together" }).waitFor();
    assert.equal(await page.locator(".comparison tbody tr").count(), 2);
    await tracesShown(page, "Load step at the plant input", 8);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("all methods are compared on equations, the emulation among them", async () => {
  await withPage(TANK, {}, async (page) => {
    await page.getByRole("button", { name: "Compare all methods on these equations" }).click();
    await page.getByRole("heading", { name: "Chosen rows, together" }).waitFor();
    const { request, result } = await jobOf(page);
    assert.deepEqual(request.tune, [{ method: "all" }]);
    assert.ok(result.controllers.some((entry) => entry.emulation));
    const answers = result.controllers.filter((entry) => !entry.error).length;
    assert.equal(await page.locator(".comparison tbody:not(.refused) tr").count(), answers);
    await tracesShown(page, "Set-point step", 8);
  });
});

test("an example's methods come back from the form as they were, options and scenarios included", async () => {
  const { examples } = await (await fetch(`${tests.service.base}/v1/examples`)).json();
  const nonlinear = examples.filter((example) => example.request.plant?.type === "nonlinear");
  assert.ok(nonlinear.length >= 5);
  await withPage("", {}, async (page) => {
    for (const example of nonlinear) {
      await form(page).getByLabel("Fill from an example").selectOption(example.id);
      await tune(page);
      await designShown(page);
      const { request } = await jobOf(page);
      assert.deepEqual(request.tune, example.request.tune, example.id);
      assert.deepEqual(request.plant, example.request.plant, example.id);
      await page.getByRole("link", { name: "Start", exact: true }).click();
    }
  });
});

for (const [name, options] of WINDOWS) {
  test(`equations and their answer fit the window and have no accessibility violations: ${name}`, async () => {
    await withPage("", options, async (page) => {
      await form(page).getByText("Write equations").click();
      assert.ok((await overflow(page)) <= 0, "Start is wider than the window");
      assert.deepEqual(await accessibilityViolations(page), []);
      const small = await form(page)
        .locator("button:visible, input:visible, textarea:visible, select:visible")
        .evaluateAll((list) =>
          list.map((item) => item.getBoundingClientRect()).filter((box) => box.width < 24 || box.height < 24),
        );
      assert.deepEqual(small, [], "targets below 24 px");
      await tuneReactor(page);
      assert.ok((await overflow(page)) <= 0, "Design is wider than the window");
      assert.deepEqual(await accessibilityViolations(page), []);
    });
  });
}
