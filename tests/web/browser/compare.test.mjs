import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { accessibilityViolations, browserTests, overflow, tracesShown, WINDOWS, openMore } from "../harness.mjs";

const tests = browserTests();
const { withPage, jobOf } = tests;

const PLANT = "#/new/fopdt?K=1.25&T=40&L=8";
const table = (page) => page.getByRole("region", { name: "Comparison table" });

/** Compares all methods on the plant in the address, with today's settings as a row. */
async function compareAll(page) {
  await page.getByLabel("Kp", { exact: true }).fill("1.2");
  await page.getByLabel("Ti", { exact: true }).fill("40");
  await page.getByRole("button", { name: "Compare all methods", exact: true }).click();
  await table(page).waitFor();
}

/** Texts of a column's cells from top to bottom, without rows that have no answer. */
async function column(page, name) {
  const headings = await table(page).locator("thead th").allInnerTexts();
  const at = headings.findIndex((text) =>
    text
      .replace(/\s+/g, " ")
      .replace(/ [▲▼]$/, "")
      .startsWith(name),
  );
  assert.ok(at >= 0, `${name} is none of ${headings.join(" | ")}`);
  return table(page)
    .locator("tbody:not(.refused) tr")
    .evaluateAll((rows, index) => rows.map((row) => row.children[index].textContent.replace("−", "-")), at);
}

const asShown = (value) => Number(Number(value).toPrecision(3));
const sortButton = (page, name) => table(page).getByRole("button", { name, exact: true });
const rising = (list) => list.every((value, index) => index === 0 || value >= list[index - 1]);

test("every method of the service is a row, ranked as the service ranks, with the figures it answers", async () => {
  await withPage(PLANT, {}, async (page) => {
    await compareAll(page);
    assert.match(page.url(), /#\/jobs\/[^/]+\/compare$/);
    const { request, result } = await jobOf(page);
    assert.deepEqual(request.tune, [{ method: "all" }]);
    const { methods } = await (await fetch(`${tests.service.base}/v1/methods`)).json();
    // On a linear plant the emulation of a nonlinear controller is not requested; a frontier is not a rule, and a formula
    // is the user's.
    for (const { id } of methods.filter((method) => !["all", "emulation", "frontier", "formula"].includes(method.id)))
      assert.ok(
        result.controllers.some((entry) => entry.method === id),
        `${id} has no row`,
      );
    const order = result.ranking.map((index) => result.controllers[index]);
    const links = table(page).locator("tbody:not(.refused) th a");
    const titles = await links.evaluateAll((list) =>
      list.map((link) => link.title.replace(": its settings and verdict", "")),
    );
    assert.deepEqual(
      titles,
      order.map((entry) => entry.title),
    );
    assert.ok((await links.allInnerTexts()).includes("Today's settings"));
    const held = order.filter((entry) => !entry.standing.why);
    assert.equal(held[0].title, "Robust optimum (PID)");
    const IAE = (await column(page, "IAE load")).map(Number);
    assert.deepEqual(
      IAE.slice(0, held.length),
      held.map((entry) => asShown(entry.performance.load.IAE)),
    );
    assert.ok(rising(held.map((entry) => entry.standing.excess_percent)));
    const excess = await column(page, "+% over");
    for (const [at, entry] of order.entries()) {
      const value = entry.optimum_at_Ms.excess_percent;
      if (value === null) assert.match(excess[at], /^–\d+$/);
      else if (Math.abs(value) >= 0.005) assert.equal(Number(excess[at]), asShown(value), entry.title);
    }
    const refused = result.controllers.filter((entry) => entry.error);
    const said = await table(page).locator(".refused tr").allInnerTexts();
    assert.equal(said.length, refused.length);
    for (const entry of refused)
      assert.ok(
        said.some((text) => text.includes(entry.error.detail)),
        entry.method,
      );
  });
});

test("a heading sorts by its column, and again the other way round; the address keeps it", async () => {
  await withPage(PLANT, {}, async (page) => {
    await compareAll(page);
    await sortButton(page, "Ms").focus();
    await page.keyboard.press("Enter");
    await table(page).locator("th[aria-sort=ascending][data-column=Ms]").waitFor();
    const numbers = (await column(page, "Ms")).map(Number).filter((value) => !Number.isNaN(value));
    assert.ok(numbers.length > 5 && rising(numbers), numbers.join());
    await page.keyboard.press("Enter");
    await table(page).locator("th[aria-sort=descending][data-column=Ms]").waitFor();
    assert.ok(
      rising(
        (await column(page, "Ms"))
          .map(Number)
          .filter((value) => !Number.isNaN(value))
          .reverse(),
      ),
    );
    assert.equal(await table(page).locator("th[aria-sort]").count(), 1);
    assert.ok(await sortButton(page, "Ms").evaluate((button) => button === document.activeElement));
    assert.match(page.url(), /compare\?sort=-Ms/);
    await page.reload();
    await table(page).locator("th[aria-sort=descending][data-column=Ms]").waitFor();
  });
});

test("two rows are overlaid in every plot, four at most, by the keyboard alone", async () => {
  await withPage(PLANT, {}, async (page) => {
    await compareAll(page);
    await table(page).locator("tbody input:checked").first().uncheck();
    await table(page).locator("tbody input:checked").first().uncheck();
    const boxes = table(page).locator("tbody:not(.refused) input[type=checkbox]");
    for (const at of [0, 1]) {
      await boxes.nth(at).focus();
      await page.keyboard.press("Space");
      await page.waitForFunction(
        (count) => document.querySelectorAll(".comparison-table tr.drawn").length === count,
        at + 1,
      );
      assert.ok(await boxes.nth(at).evaluate((box) => box === document.activeElement), "the focus stays on its box");
    }
    for (const [title, traces] of [
      ["Set-point step", 4],
      ["Load step at the plant input", 4],
      ["Nyquist curve of L", 2],
      ["Sensitivities", 6],
    ])
      await tracesShown(page, title, traces);
    const names = await page.locator(".overlay-legend span").allInnerTexts();
    assert.equal(names.length, 2);
    for (const at of [2, 3]) await boxes.nth(at).check();
    await page.waitForFunction(() => document.querySelectorAll(".comparison-table tr.drawn").length === 4);
    assert.ok(await boxes.nth(4).isDisabled());
    await tracesShown(page, "Nyquist curve of L", 4);
    const rows = /rows=([\d.]+)/.exec(page.url())[1];
    assert.equal(rows.split(".").length, 4);
    // The same rows are on Design, and Back leads to the same table.
    await table(page).getByRole("link").first().click();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    await tracesShown(page, "Nyquist curve of L", 4);
    assert.ok((await page.locator(".legend-item").count()) <= 8);
    await page.getByRole("link", { name: "Comparison table" }).click();
    await page.waitForFunction(() => document.querySelectorAll(".comparison-table tr.drawn").length === 4);
  });
});

test("the limit on Ms ranks anew, unstable rows go on request, columns are chosen", async () => {
  await withPage(PLANT, {}, async (page) => {
    await compareAll(page);
    const { result } = await jobOf(page);
    const ranked = async () => (await column(page, "#")).filter((text) => text !== "").length;
    const within = (limit) =>
      result.controllers.filter(
        ({ method, standing }) =>
          method !== "baseline" && standing?.settles && standing.within && standing.Ms <= limit * 1.0001,
      ).length;
    assert.equal(await ranked(), within(2));
    const limit = page.getByLabel("ranked by excess over the optimum*, with Ms ≤");
    await limit.fill("1,45");
    await page.keyboard.press("Enter");
    assert.equal(await ranked(), within(1.45));
    assert.ok(within(1.45) < within(2));
    await limit.fill("0.5");
    await page.keyboard.press("Enter");
    await page.getByText("Ms is 0.5; it must be above 1.").waitFor();
    await page.getByText("Columns", { exact: true }).click();
    await page.getByRole("checkbox", { name: "Kp", exact: true }).uncheck();
    await page.getByRole("checkbox", { name: "Settling (s)", exact: true }).check();
    await page.keyboard.press("Escape");
    const settling = await column(page, "Settling");
    const best = result.controllers[result.ranking[0]];
    assert.ok(settling.includes(Number(best.performance.setpoint.settling_time).toPrecision(3)), settling.join());
    assert.equal(await sortButton(page, "Kp").count(), 0);
    await page.getByLabel("only those that settle").check();
    assert.equal(
      await table(page).locator("tbody tr").count(),
      result.controllers.filter((entry) => entry.standing?.settles).length,
    );
  });
});

test("the limit on Ms is the request's on every way in, and a typed one stays after Back and a reload", async () => {
  const response = await fetch(`${tests.service.base}/v1/jobs`, {
    method: "POST",
    headers: { "Content-Type": "application/json", Prefer: "wait=60" },
    body: JSON.stringify({
      plant: { type: "fopdt", K: 1, T: 10, L: 2 },
      tune: [{ method: "robust" }, { method: "simc" }, { method: "amigo" }],
      evaluate: { rank_limits: { Ms: 1.5 } },
    }),
  });
  const { id } = await response.json();
  await withPage(`#/jobs/${id}/design`, {}, async (page) => {
    const limit = page.getByLabel(/with Ms/);
    const table = page.locator(".comparison-table tbody a");
    const stands = async (value) => {
      await table.first().waitFor();
      assert.equal(await limit.inputValue(), value);
    };
    await page.getByRole("link", { name: "Comparison table" }).click();
    await stands("1.5");
    await page.reload();
    await stands("1.5");
    await limit.fill("1,7");
    await limit.press("Enter");
    await page.waitForURL(/compare\?Ms=1\.7$/);
    await table.first().click();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    await page.goBack();
    await stands("1.7");
    await page.reload();
    await stands("1.7");
    await page.getByRole("link", { name: "Settings and verdict" }).click();
    await page.getByRole("navigation", { name: "Screens" }).getByRole("link", { name: "Compare" }).click();
    await stands("1.7");
    assert.match(page.url(), /compare\?Ms=1\.7$/);
  });
});

test("the table is saved as CSV with all digits", async () => {
  await withPage(PLANT, {}, async (page) => {
    await compareAll(page);
    const { result } = await jobOf(page);
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Export CSV" }).click(),
    ]);
    const [header, ...rows] = readFileSync(await download.path(), "utf8")
      .trim()
      .split("\r\n");
    assert.match(header, /^rank,method,title,Kp,Ti \(s\)/);
    assert.equal(rows.length, result.controllers.length);
    const best = result.controllers[result.ranking[0]];
    assert.ok(rows[0].includes(String(best.controller.Kp)), rows[0]);
  });
});

test("every subject leads to its comparison: Design, an example, a recorded test", async () => {
  await withPage(PLANT, {}, async (page) => {
    await page.getByRole("button", { name: "Tune this model" }).click();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    await page.getByRole("button", { name: "Compare all methods", exact: true }).click();
    await table(page).waitFor();
    assert.deepEqual((await jobOf(page)).request.plant, { type: "fopdt", K: 1.25, T: 40, L: 8 });
    await page.goto(`${tests.service.base}/#/`);
    const example = page.getByRole("button", { name: /^Compare all methods: / }).first();
    await example.click();
    await table(page).waitFor();
    assert.deepEqual((await jobOf(page)).request.tune, [{ method: "all" }]);
    await page.goto(`${tests.service.base}/#/`);
    const rows = Array.from(
      { length: 300 },
      (_, t) => `${t},${t >= 20 ? 1 : 0},${t > 25 ? 2 - 2 * Math.exp((25 - t) / 30) : 0}`,
    );
    await page.getByLabel("or paste it").fill(["t,u,y", ...rows].join("\n"));
    await page.getByRole("button", { name: "Compare all methods on this record" }).click();
    await table(page).waitFor();
    assert.ok((await jobOf(page)).result.model);
  });
});

const tradeoff = (page) => page.getByRole("region", { name: "Set point against load", exact: true });
const tradeoffCell = async (page, label, at) =>
  Number(
    (
      await tradeoff(page)
        .locator("table.figures tr")
        .filter({ has: page.locator("th", { hasText: label }) })
        .first()
        .locator("td")
        .nth(at)
        .innerText()
    ).replace("−", "-"),
  );

test("the trade-off of any chosen rows is computed on request, with the rule's curves on this plant", async () => {
  await withPage(PLANT, {}, async (page) => {
    await compareAll(page);
    const answered = page.waitForResponse((response) => response.url().endsWith("/v1/evaluate"));
    await tradeoff(page).getByRole("button", { name: "Compute the trade-off" }).click();
    const { controllers } = await (await answered).json();
    await tradeoff(page).getByRole("heading", { name: "Figures by allowed degradation" }).waitFor();
    const today = controllers.at(-1).tradeoff.plant;
    const columns = await tradeoff(page).locator("thead").first().locator("th").allInnerTexts();
    const at = columns.indexOf("today");
    for (const [label, value] of [
      [/^J_r \(s\)/, today.J_r],
      [/^J_rd \(s\)/, today.J_rd],
      [/^Deg/, today.Deg],
      [/^Ms/, today.Ms],
    ])
      assert.equal(await tradeoffCell(page, label, at), asShown(value), String(label));
    const labels = await page.getByRole("img", { name: "Servo against regulation" }).locator("text").allTextContents();
    assert.ok(labels.includes("today") && labels.includes("best of both"), labels.join());
    const curves = page.getByRole("img", { name: "Degradation against Ms" }).locator("path[stroke-linejoin=round]");
    assert.equal(await curves.count(), 2);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("Design shows the trade-off of an entry that brings it", async () => {
  await withPage(PLANT, {}, async (page) => {
    await page.getByText(/^Compare with/).click();
    await page.getByRole("checkbox", { name: /arrieta_ms$/ }).check();
    await page.getByRole("button", { name: "Tune this model" }).click();
    await page.getByRole("button", { name: "arrieta ms", exact: true }).click();
    await openMore(page);
    await tradeoff(page).getByRole("heading", { name: "Degradation against Ms" }).waitFor();
    const entry = (await jobOf(page)).result.controllers.find((candidate) => candidate.method === "arrieta_ms");
    assert.equal(await tradeoffCell(page, /^J_d \(s\)/, 0), asShown(entry.tradeoff.model.J_d));
    assert.ok(await tradeoff(page).getByRole("button", { name: "Compute the trade-off" }).isHidden());
    await page.getByRole("button", { name: "robust", exact: true }).click();
    await tradeoff(page).getByRole("button", { name: "Compute the trade-off" }).waitFor();
  });
});

test("a nonlinear PID is taken as today's settings, and shown in its own form with what its Ms belongs to", async () => {
  await withPage(PLANT, {}, async (page) => {
    const delta = page.getByLabel("delta_r", { exact: true });
    assert.ok(await delta.isHidden());
    await page.getByLabel("Form", { exact: true }).selectOption("npid");
    await page.getByLabel("Kp", { exact: true }).fill("1.2");
    await page.getByLabel("Ti", { exact: true }).fill("40");
    await delta.fill("0,5");
    await page.getByRole("button", { name: "Tune this model" }).click();
    await page.getByRole("button", { name: "today", exact: true }).click();
    await page.getByRole("heading", { name: "Settings to enter: today" }).waitFor();
    const { request, result } = await jobOf(page);
    assert.deepEqual(request.baseline, { form: "npid", Kp: 1.2, Ti: 40, delta_r: 0.5 });
    const settings = await page.locator(".settings tr").allInnerTexts();
    assert.deepEqual(
      settings.map((text) => text.split(/\s+/)[0]),
      ["Kp", "Ti", "Td", "delta_r"],
    );
    assert.match(settings[3], /^delta_r\t0\.5\t/);
    assert.equal(await page.locator(".settings .typed input").count(), 0);
    const verdict = await page.getByRole("region", { name: "Verdict" }).innerText();
    assert.match(verdict, /belong to the controller.s linear part/);
    const today = result.controllers.find((entry) => entry.method === "baseline");
    if (today.nonlinear) assert.ok(verdict.includes(today.nonlinear.statement));
    // The link returns to the form as entered.
    await page.getByRole("link", { name: "Change the request" }).click();
    await page.getByRole("button", { name: "Tune this model" }).waitFor();
    await page.waitForFunction(() => [...document.querySelectorAll("input")].some((input) => input.value === "0.5"));
    assert.equal(await delta.inputValue(), "0.5");
  });
});

for (const [name, options] of WINDOWS) {
  test(`the comparison on a ${name}: axe finds nothing, and nothing is wider than the window`, async () => {
    await withPage(PLANT, options, async (page) => {
      await compareAll(page);
      assert.deepEqual(await accessibilityViolations(page), []);
      assert.equal(await overflow(page), 0);
      await table(page).evaluate((region) => (region.scrollLeft = 400));
      const pinned = await table(page).locator("tbody th").first().boundingBox();
      const region = await table(page).boundingBox();
      assert.ok(pinned.x >= region.x && pinned.x < region.x + 80, "the method's column stays");
      await page.goto(`${tests.service.base}/#/methods`);
      await page.locator("article").first().waitFor();
      assert.deepEqual(await accessibilityViolations(page), []);
      assert.equal(await overflow(page), 0);
    });
  });
}

test("the table says how many rows are below its visible part, until it is scrolled to its end", async () => {
  await withPage(PLANT, {}, async (page) => {
    await compareAll(page);
    await page.getByText(/^\d+ more rows below: scroll the table\.$/).waitFor();
    await table(page).evaluate((region) => region.scrollTo(0, region.scrollHeight));
    await page.getByText(/more rows? below/).waitFor({ state: "hidden" });
  });
});
