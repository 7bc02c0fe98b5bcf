import assert from "node:assert/strict";
import test from "node:test";
import { accessibilityViolations, browserTests, dropFile, overflow, tracesShown, WINDOWS } from "../../harness.mjs";

import { stepTest } from "../../step_record.mjs";

const tests = browserTests();
const { withPage, post } = tests;

/** Structure, example, and plots with their traces. */
const EXAMPLES = [
  ["cascade", "Furnace with fuel flow", { "Set-point step": 6, "Load at the valve": 6, "Load on the outer plant": 6, "Sensitivity |S| of each loop": 4 }],
  ["feedforward", "Heat exchanger with feed flow", { "Step of the disturbance": 8, "Sensitivity |S| of each loop": 1 }],
  ["level", "Boiler feed water tank", { "Largest step of the inflow": 2, "Sensitivity |S| of each loop": 1 }],
  ["interaction", "Wood and Berry's column", { "Set-point step 1": 8, "Load at the plant input 2": 8, "Sensitivity |S| of each loop": 6 }],
  ["predictor", "Long pipe", { "Set-point step": 4, "Load at the plant input": 4, "Sensitivity |S| of each loop": 2 }],
];

/** The request of the first example. */
const FURNACE = {
  inner: { plant: "2 e^(-s)/(4s+1)", tune: { controller: "PI", Ms: 1.4 } },
  outer: { plant: "1.5 e^(-8s)/(30s+1)", tune: { controller: "PID", Ms: 1.4 } },
  limits: { Ms_valve: 1.6 },
};

/** Luyben's settings, which are judged faster than a design is found. */
const GIVEN = new URLSearchParams({
  "plant.0.0": "12.8 e^(-s)/(16.7s+1)",
  "plant.0.1": "-18.9 e^(-3s)/(21s+1)",
  "plant.1.0": "6.6 e^(-7s)/(10.9s+1)",
  "plant.1.1": "-19.4 e^(-3s)/(14.4s+1)",
  controllers: "given",
  "controllers.0": "Kp 0.375, Ti 8.29",
  "controllers.1": "Kp -0.075, Ti 23.6",
});
const addressOf = (id) => `#/structure/${id}${id === "interaction" ? `?${GIVEN}` : ""}`;

const verdict = (page) => page.locator(".structure-results .verdict h2");
/** The next answer of the service about a structure. */
const answered = (page, id, holds = () => true) =>
  page.waitForResponse((response) => response.url().endsWith(`/v1/${id}`) && holds(response.request().postDataJSON()));
const field = (page, name) => page.getByLabel(name, { exact: true });
const three = (value) => String(Number(value.toPrecision(3)));
const figure = (page, label) => page.locator(".structure-tables tr").filter({ has: page.getByRole("rowheader", { name: label, exact: true }) });

test("each example is one click away, and what is shown is what the service answers", async () => {
  await withPage("#/structure", {}, async (page) => {
    await verdict(page).waitFor();
    for (const [id, title, plots] of [...EXAMPLES.slice(1), EXAMPLES[0]]) {
      const asked = answered(page, id);
      await page.getByRole("link", { name: title, exact: true }).click();
      const answer = await (await asked).json();
      await page.locator(`.structure-results .verdict h2[data-code="${answer.verdict[0].code}"]`).waitFor();
      assert.equal(await page.locator(".structure-results .verdict [data-code]").count(), answer.verdict.length, id);
      for (const [plot, count] of Object.entries(plots)) await tracesShown(page, plot, count);
      assert.equal(await page.getByRole("tab", { selected: true }).innerText(), id[0].toUpperCase() + id.slice(1));
      assert.match(page.url(), new RegExp(`#/structure/${id}\\?`));
      assert.equal(await page.title(), "Structure · Tunewright");
      assert.deepEqual(await accessibilityViolations(page), [], id);
    }
    const answer = await post("v1/cascade", FURNACE);
    const row = await figure(page, "IAE after a load at the valve (s)").innerText();
    assert.ok(row.includes(three(answer.performance.inner_load.IAE)) && row.includes(three(answer.single.performance.inner_load.IAE)), row);
    const typing = await page.getByRole("region", { name: "Settings to type" }).innerText();
    for (const value of [answer.outer.controller.Kp, answer.inner.controller.Ti]) assert.ok(typing.includes(String(Number(value.toPrecision(5)))), typing);
    // The designed settings stand in their blocks too.
    assert.match(await page.getByRole("group", { name: "C1, outer" }).innerText(), /Kp 0\.935/);
  });
});

test("a slider is dragged: the design follows, the address holds the question, nothing moves", async () => {
  await withPage("#/structure/level", {}, async (page) => {
    await verdict(page).waitFor();
    await page.evaluate(() => {
      globalThis.shifts = 0;
      new PerformanceObserver((list) => list.getEntries().forEach((entry) => (globalThis.shifts += entry.value))).observe({ type: "layout-shift" });
    });
    const range = page.getByLabel("Allowed deviation of the level, slider");
    const { x, y, width, height } = await range.boundingBox();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    const held = answered(page, "level");
    for (let step = 1; step <= 10; step += 1) await page.mouse.move(x + width * (0.5 + 0.02 * step), y + height / 2);
    assert.ok((await held).request().postDataJSON().allowed > 1.8);
    await page.mouse.up();
    const allowed = Number(await field(page, "Allowed deviation of the level (m)").inputValue());
    assert.ok(allowed > 1.8);
    await page.waitForURL((url) => url.hash.includes(`allowed=${allowed}`));
    await page.getByText(`reached ${allowed.toPrecision(3)}`).waitFor();
    assert.ok((await page.evaluate(() => globalThis.shifts)) < 0.005);
    const before = await verdict(page).innerText();
    const url = page.url();
    await page.goto("about:blank");
    await page.goto(url);
    await verdict(page).waitFor();
    assert.equal(await verdict(page).innerText(), before);
    assert.equal(page.url(), url);
    // By keys, and by typing.
    const keyed = answered(page, "level");
    await page.getByLabel("Allowed deviation of the level, slider").focus();
    await page.keyboard.press("Shift+ArrowLeft");
    assert.ok((await keyed).request().postDataJSON().allowed < allowed);
    const typed = answered(page, "level", (request) => request.allowed === 2.5);
    await field(page, "Allowed deviation of the level (m)").fill("2,5");
    await page.keyboard.press("Enter");
    await typed;
  });
});

test("an optional limit is emptied, and is then left out", async () => {
  await withPage("#/structure/feedforward", {}, async (page) => {
    await verdict(page).waitFor();
    const asked = answered(page, "feedforward");
    await field(page, "First move of u").fill("");
    await page.keyboard.press("Enter");
    assert.equal((await asked).request().postDataJSON().feedforward, undefined);
    const again = answered(page, "feedforward");
    await field(page, "First move of u").fill("4");
    await page.keyboard.press("Enter");
    assert.deepEqual((await again).request().postDataJSON().feedforward, { jump: 4 });
  });
});

test("a given controller begins with the designed settings; faults stand at their fields, and the answer before is marked", async () => {
  await withPage(
    "#/structure/cascade",
    {},
    async (page) => {
      await verdict(page).waitFor();
      const { outer } = await post("v1/cascade", FURNACE);
      const five = (value) => Number(value.toPrecision(5));
      const { Kp, Ti, Td, filter } = outer.controller;
      const given = answered(page, "cascade");
      await field(page, "Outer controller").selectOption("given");
      assert.equal(await field(page, "Settings of the outer controller").inputValue(), `Kp ${five(Kp)}, Ti ${five(Ti)}, Td ${five(Td)}, Tf ${five(filter.Tf)}`);
      assert.equal((await given).request().postDataJSON().outer.controller.Kp, five(Kp));
      await field(page, "Settings of the outer controller").fill("Kp 5, Ti 10");
      await page.keyboard.press("Tab");
      await page.locator('.verdict.bad h2[data-code="unstable"]').waitFor();
      await field(page, "Settings of the outer controller").fill("Kx 5");
      await page.keyboard.press("Tab");
      await page.getByText('"Kx" is not one of Kp').waitFor();
      await page.getByText("These results belong to the last answered request").waitFor();
      await field(page, "Settings of the outer controller").fill("Kp 1, Ti 20");
      await page.keyboard.press("Tab");
      await page.getByText("These results belong").waitFor({ state: "hidden" });
      await field(page, "Inner plant, from the valve to y2").fill("2 e^(-s)/(4s+1");
      await page.keyboard.press("Tab");
      await page.locator('input[aria-invalid="true"]').waitFor();
      assert.equal(await field(page, "Inner plant, from the valve to y2").getAttribute("aria-invalid"), "true");
      await field(page, "Inner plant, from the valve to y2").fill("2 e^(-s)/(4s+1)");
      await page.keyboard.press("Tab");
      await page.getByText("These results belong").waitFor({ state: "hidden" });
      // Today's settings are judged next to them.
      await page.getByText("Today's settings").click();
      await field(page, "Inner controller today").fill("Kp 0.3, Ti 4");
      await field(page, "Outer controller today").fill("Kp 0.5, Ti 30");
      const today = answered(page, "cascade", ({ baseline }) => baseline?.outer);
      await page.keyboard.press("Tab");
      const { baseline } = await (await today).json();
      await page.getByRole("columnheader", { name: "today" }).waitFor();
      assert.ok((await figure(page, "Ms, outer loop").innerText()).includes(three(baseline.robustness.Ms_outer)));
    },
    ["422"],
  );
});

test("structures keep what was typed; Back returns; a late answer of another structure is not shown", async () => {
  await withPage("#/structure/predictor", {}, async (page) => {
    await verdict(page).waitFor();
    await field(page, "Ms").fill("1.5");
    await page.keyboard.press("Enter");
    await page.waitForURL(/Ms=1\.5/);
    let go;
    const gate = new Promise((open) => (go = open));
    await page.route("**/v1/interaction", async (route) => {
      await gate;
      await route.continue().catch(() => undefined);
    });
    await page.getByRole("tab", { name: "Interaction" }).click();
    await page.getByText("Designing...").waitFor();
    await page.getByRole("tab", { name: "Level" }).click();
    await page.locator('.verdict h2[data-code="level-above-room"]').waitFor();
    go();
    await page.getByRole("tab", { name: "Predictor" }).click();
    await page.waitForURL(/predictor\?.*Ms=1\.5/);
    assert.equal(await field(page, "Ms").inputValue(), "1.5");
    await page.goBack();
    await page.getByRole("tab", { name: "Level", selected: true }).waitFor();
  });
});

test("a design that takes long can be cancelled, and a change does not wait for it", async () => {
  await withPage("#/structure/interaction", {}, async (page) => {
    await verdict(page).waitFor();
    let letGo;
    const gate = new Promise((open) => (letGo = open));
    await page.route("**/v1/interaction", async (route) => {
      if (route.request().postDataJSON().limit.mu !== 1.7) await gate;
      await route.continue().catch(() => undefined);
    });
    const set = async (mu) => {
      await field(page, "Peak mu of all loops").fill(mu);
      await page.keyboard.press("Enter");
    };
    const cancel = page.getByRole("button", { name: "Cancel", exact: true });
    await set("1.6");
    await cancel.click();
    await cancel.waitFor({ state: "hidden" });
    await page.getByText("These results belong to the last answered request").waitFor();
    await set("1.5");
    await cancel.waitFor();
    await page.waitForTimeout(1100);
    await set("1.7");
    await page.getByText("reached 1.70").waitFor();
    await cancel.waitFor({ state: "hidden" });
    letGo();
  });
});

test("three loops: the matrix has a plant for each pair, and the pairing is a choice", async () => {
  await withPage(
    "#/structure/interaction",
    {},
    async (page) => {
    await verdict(page).waitFor();
    assert.match(await page.locator(".structure-tables").innerText(), /Niederlinski index/);
    const crossed = answered(page, "interaction", ({ pairing }) => pairing?.[0] === 2);
    await field(page, "Pairing").selectOption("2 1");
    // Integral action cannot hold that pairing: the service says so at the pairing.
    assert.equal((await crossed).status(), 422);
    await page.locator('select[aria-invalid="true"]').waitFor();
    assert.equal(await field(page, "Pairing").getAttribute("aria-invalid"), "true");
    await field(page, "Loops").selectOption("3");
    assert.equal(await page.locator(".block.matrix input[type=text]").count(), 9);
    assert.equal(await field(page, "y1 from u1").inputValue(), "12.8 e^(-s)/(16.7s+1)");
    assert.equal(await page.locator('.block.matrix input[aria-invalid="true"]').count(), 5);
    },
    ["422"],
  );
});

test("a design that takes longer than a call may becomes a job, whose report needs no other", async () => {
  await withPage(
    "#/structure/level",
    {},
    async (page) => {
      await verdict(page).waitFor();
      await page.route("**/v1/predictor", (route) =>
        route.fulfill({ status: 504, contentType: "application/problem+json", body: JSON.stringify({ type: "timeout", status: 504, detail: "Stopped after 20 s." }) }),
      );
      let jobs = 0;
      page.on("request", (request) => (jobs += request.method() === "POST" && request.url().endsWith("/v1/jobs") ? 1 : 0));
      await page.getByRole("tab", { name: "Predictor" }).click();
      await page.locator('.verdict h2[data-code="pid-does-as-well"]').waitFor();
      const [report] = await Promise.all([page.waitForEvent("popup"), page.getByRole("button", { name: "Report", exact: true }).click()]);
      await report.getByRole("heading", { name: "Verdict" }).waitFor();
      assert.equal(jobs, 1);
    },
    ["504"],
  );
});

test("the program runs call by call with limits, next to the design", async () => {
  await withPage("#/structure/cascade", {}, async (page) => {
    await verdict(page).waitFor();
    await page.getByText("Call by call, with limits").click();
    const form = page.getByRole("region", { name: "Limits" });
    for (const [name, text] of [["Sample time (s)", "1"], ["Largest u", "0.6"], ["Size: set-point step", "3"]]) {
      await form.getByLabel(name, { exact: true }).fill(text);
      await page.keyboard.press("Enter");
    }
    await page.getByRole("heading", { name: "Set-point step, size 3" }).waitFor();
    await tracesShown(page, "Set-point step, size 3", 4);
    await tracesShown(page, "Load at the valve", 10);
    const { sampled } = await post("v1/cascade", { ...FURNACE, sampled: { sample_time: 1, u_max: 0.6, steps: { setpoint: 3 } } });
    const table = page.locator(".structure-tables .card").filter({ has: page.getByRole("heading", { name: "Call by call, with limits" }) });
    assert.ok((await table.innerText()).includes(three(sampled.Ms.valve)));
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("the file of a test becomes a plant: dropped on its block, or chosen", async () => {
  await withPage(
    "#/structure/cascade",
    {},
    async (page) => {
      await verdict(page).waitFor();
      const outer = answered(page, "cascade", (request) => request.outer.plant !== FURNACE.outer.plant);
      await dropFile(page, ".block.P1 .plant-line", "tic.csv", stepTest);
      const [, K, L, T] = /^([\d.]+) e\^\(-([\d.]+) s\)\/\(([\d.]+) s \+ 1\)$/.exec((await outer).request().postDataJSON().outer.plant);
      assert.ok(Math.abs(K - 2) < 0.02 && Math.abs(L - 5) < 0.2 && Math.abs(T - 30) < 0.5, `${K} ${L} ${T}`);
      await page.getByText(/tic\.csv, fit 9\d|tic\.csv, fit 100/).waitFor();
      await page.getByText("These results belong").waitFor({ state: "hidden" });
      const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.getByRole("button", { name: "CSV of a test: Inner plant, from the valve to y2" }).click()]);
      await chooser.setFiles({ name: "fic.csv", mimeType: "text/csv", buffer: Buffer.from("not a test") });
      await page.locator(".block.P2 .formula .error").waitFor();
      assert.equal(await field(page, "Inner plant, from the valve to y2").inputValue(), FURNACE.inner.plant);
      assert.deepEqual(await accessibilityViolations(page), []);
    },
    ["422", "400"],
  );
});

test("a job opens with its answer and without another design, and a change makes it a question of its own", async () => {
  const plant = { type: "fopdt", K: 5.6, T: 40.2, L: 93.9 };
  const { id, result } = await post("v1/jobs", { structure: "predictor", name: "pipe", plant, Ms: 1.5 });
  await withPage("#/jobs", {}, async (page) => {
    let designs = 0;
    page.on("request", (request) => (designs += request.url().endsWith("/v1/predictor") ? 1 : 0));
    await page.getByRole("link", { name: "pipe", exact: true }).click();
    await page.waitForURL(new RegExp(`#/jobs/${id}/structure$`));
    await page.locator(`.verdict h2[data-code="${result.verdict[0].code}"]`).waitFor();
    assert.match(await field(page, "Plant, from u to y").inputValue(), /5\.6 e\^\(-93\.9 s\)\/\(40\.2 s \+ 1\)/);
    assert.ok((await figure(page, "Dead time may rise by (s)").innerText()).includes(three(result.robustness.dead_time_up)));
    assert.equal(designs, 0);
    await field(page, "Ms").fill("1.6");
    await page.keyboard.press("Enter");
    await page.waitForURL(/#\/structure\/predictor\?.*Ms=1\.6/);
  });
});

test("report and code of every structure: the question is posted once, as a job", async () => {
  for (const [id] of EXAMPLES)
    await withPage(addressOf(id), {}, async (page) => {
      await verdict(page).waitFor();
      let jobs = 0;
      page.on("request", (request) => (jobs += request.method() === "POST" && request.url().endsWith("/v1/jobs") ? 1 : 0));
      const [report] = await Promise.all([page.waitForEvent("popup"), page.getByRole("button", { name: "Report", exact: true }).click()]);
      await report.getByRole("heading", { name: "Verdict" }).waitFor();
      assert.match(report.url(), /\/v1\/jobs\/[^/]+\/report\.html/);
      await report.close();
      await page.getByRole("button", { name: "Code", exact: true }).click();
      const text = page.getByRole("region", { name: "Source text" });
      await text.getByText(/FUNCTION_BLOCK/).first().waitFor();
      for (const [language, word] of [["C", /#include/], ["Python", /def |class /]]) {
        await page.getByRole("tab", { name: language, exact: true }).click();
        await text.getByText(word).first().waitFor();
      }
      assert.equal(jobs, 1, id);
      assert.deepEqual(await accessibilityViolations(page), [], id);
    });
});

test("the settings of every controller are typed into the user's product", async () => {
  await withPage("#/structure/cascade", {}, async (page) => {
    await verdict(page).waitFor();
    const asked = answered(page, "cascade", ({ implement }) => implement);
    await page.getByRole("combobox", { name: "Maker and product" }).fill("simple-pid");
    await page.getByRole("listbox", { name: "Maker and product" }).getByRole("option").first().waitFor();
    await page.keyboard.press("Enter");
    const { settings } = await (await asked).json();
    assert.deepEqual(settings.map(({ loop }) => loop), ["inner", "outer"]);
    await page.getByRole("heading", { name: "inner loop" }).waitFor();
    const shown = await page.getByRole("region", { name: "My controller" }).innerText();
    for (const { typing } of settings) assert.ok(shown.includes(typing.as_typed.Ki), shown);
  });
});

for (const [name, options] of WINDOWS)
  test(`every structure fits the window and has no accessibility violations: ${name}`, async () => {
    await withPage("#/structure", options, async (page) => {
      for (const [id] of EXAMPLES) {
        await page.evaluate((hash) => (location.hash = hash), addressOf(id));
        await page.getByRole("tab", { name: new RegExp(id, "i"), selected: true }).waitFor();
        await verdict(page).waitFor();
        assert.ok((await overflow(page)) <= 0, `${id} is wider than the window`);
        assert.deepEqual(await accessibilityViolations(page), [], id);
      }
    });
  });
