// A plant with only Ku and Pu: the settings of the rules in a table, and no figure of a loop.
import assert from "node:assert/strict";
import test from "node:test";
import { accessibilityViolations, browserTests, overflow, WINDOWS } from "../harness.mjs";
import { requestHandedOut } from "../shown_request.mjs";

const tests = browserTests();
const { withPage, jobOf, post } = tests;

const card = (page) => page.getByRole("form", { name: "Only Ku and Pu" });
const field = (page, name) => card(page).getByRole("textbox", { name });

async function fill(page, values) {
  const entered = card(page).locator("details");
  if (!(await entered.evaluate((details) => details.open))) await entered.locator("summary").click();
  for (const [name, value] of Object.entries(values)) await field(page, name).fill(value);
}

const press = (page) => card(page).getByRole("button", { name: "Settings by these rules" }).click();
const answered = (page) => page.getByRole("region", { name: "Verdict" }).locator("table tbody tr").first().waitFor();

/** Kp, Ti, Td and Tf of each rule in the table; NaN for a dash. */
const table = (page) =>
  page
    .getByRole("region", { name: "Verdict" })
    .locator("table tbody tr")
    .evaluateAll((rows) =>
      rows.map((row) => [
        row.querySelector("th").textContent,
        ...[...row.querySelectorAll("td")].map((cell) => Number(cell.textContent.replace("−", "-"))),
      ]),
    );

/** The rules as printed by their authors: Ziegler and Nichols 1942, Tyreus and Luyben 1992. */
const printed = (Ku, Pu) => ({
  "Ziegler-Nichols, ultimate gain (PI)": [0.45 * Ku, Pu / 1.2, 0],
  "Ziegler-Nichols, ultimate gain (PID)": [0.6 * Ku, Pu / 2, Pu / 8],
  "Ziegler-Nichols, ultimate gain (PID, no overshoot)": [0.2 * Ku, Pu / 2, Pu / 3],
  "Tyreus-Luyben (PI)": [Ku / 3.2, 2.2 * Pu, 0],
  "Tyreus-Luyben (PID)": [Ku / 2.2, 2.2 * Pu, Pu / 6.3],
});

function assertRules(shown, Ku, Pu) {
  for (const [rule, settings] of Object.entries(printed(Ku, Pu))) {
    const row = shown.find(([name]) => name === rule);
    assert.ok(row, rule);
    for (const [at, value] of settings.entries())
      assert.ok(Math.abs(row[at + 1] - value) <= 1e-4 * Math.abs(value), `${rule}: ${row[at + 1]} for ${value}`);
  }
}

test("Ku and Pu alone give the printed rules' settings in the table, and nothing of a loop", async () => {
  await withPage("", {}, async (page) => {
    await fill(page, { Ku: "4", Pu: "30" });
    await press(page);
    await answered(page);
    const job = await jobOf(page);
    assert.deepEqual(job.request, { ultimate: { Ku: 4, Pu: 30 } });
    const shown = await table(page);
    assertRules(shown, 4, 30);
    assert.equal(shown.length, job.result.controllers.length);
    assert.equal(job.result.verdict[0].code, "robustness-unknown");
    assert.equal(job.result.verdict[0].level, "warning");
    for (const [at, { controller, verdict, robustness, error }] of job.result.controllers.entries()) {
      if (!controller) {
        assert.equal(shown[at].length, 2, "one cell, which says why");
        assert.ok((await page.getByRole("row", { name: error.detail }).count()) > 0);
        continue;
      }
      assert.equal(robustness, undefined);
      assert.equal(verdict[0].code, "robustness-unknown");
      const Tf = controller.filter?.Tf;
      if (Tf === undefined) assert.ok(Number.isNaN(shown[at][4]), `Tf ${shown[at][4]}`);
      else assert.equal(shown[at][4], Number(Tf.toPrecision(5)));
    }
    // No slider, no plot, no form of settings: these need a loop.
    for (const gone of [".controls", "section.plot", ".settings", ".figures-card"])
      assert.equal(await page.locator(gone).filter({ visible: true }).count(), 0, gone);
    // The address alone restores it, and the request that is handed out gives the same.
    await page.reload();
    await answered(page);
    assert.deepEqual(await table(page), shown);
    const request = await requestHandedOut(page);
    assert.deepEqual(request, job.request);
    const again = await post("v1/jobs", request);
    assert.deepEqual(again.result.controllers.map(({ controller }) => controller), job.result.controllers.map(({ controller }) => controller));
  });
});

test("a static gain brings the rules that need one, name and units go with it, and Change the request leads back", async () => {
  await withPage("", {}, async (page) => {
    await fill(page, { Ku: "0,9", Pu: "30.5", "Static gain K": "2" });
    await page.getByLabel("Loop name").fill("TIC 7");
    await press(page);
    await answered(page);
    const { request, result } = await jobOf(page);
    assert.deepEqual(request, { name: "TIC 7", ultimate: { Ku: 0.9, Pu: 30.5, K: 2 } });
    const shown = await table(page);
    assertRules(shown, 0.9, 30.5);
    const amigo = result.controllers.find(({ method, options }) => method === "amigo_ultimate" && options.controller === "PI");
    // Advanced PID Control (2006), (7.24): with kappa = 1/(K Ku) a PI has 0.16 Ku and Pu/(1 + 4.5 kappa).
    const kappa = 1 / (2 * 0.9);
    assert.ok(Math.abs(amigo.controller.Kp / (0.16 * 0.9) - 1) < 1e-9);
    assert.ok(Math.abs(amigo.controller.Ti / (30.5 / (1 + 4.5 * kappa)) - 1) < 1e-9);
    assert.ok(shown.some(([name, Kp]) => name === amigo.title && Kp === Number(amigo.controller.Kp.toPrecision(5))));
    await page.getByRole("link", { name: "Change the request" }).click();
    await page.getByRole("heading", { name: "What do you have?" }).waitFor();
    assert.deepEqual(
      await Promise.all(["Ku", "Pu", "Static gain K"].map((name) => field(page, name).inputValue())),
      ["0.9", "30.5", "2"],
    );
    assert.ok(await card(page).locator("details").evaluate((details) => details.open));
    await fill(page, { Pu: "10", "Static gain K": "" });
    await press(page);
    await page.waitForFunction(() => [...document.querySelectorAll(".verdict table td")].some((cell) => cell.textContent === "22"));
    assert.deepEqual((await jobOf(page)).request, { name: "TIC 7", ultimate: { Ku: 0.9, Pu: 10 } });
    assertRules(await table(page), 0.9, 10);
  });
});

test("what is wrong with Ku, Pu or K stands at its field, before the service is asked and after", async () => {
  const statuses = ["422"];
  const work = async (page) => {
    const posted = [];
    page.on("request", (request) => request.method() === "POST" && request.url().endsWith("/v1/jobs") && posted.push(request));
    const invalid = async () =>
      (await Promise.all(["Ku", "Pu", "Static gain K"].map((name) => field(page, name).getAttribute("aria-invalid")))).map((value) => value === "true");
    await fill(page, { Ku: "four" });
    await press(page);
    await page.locator(".summary:visible").first().waitFor();
    assert.deepEqual([await invalid(), posted.length], [[true, true, false], 0]);
    for (const [values, wrong] of [
      [{ Ku: "0", Pu: "30" }, [true, false, false]],
      [{ Ku: "4", Pu: "-3", "Static gain K": "0" }, [false, true, true]],
    ]) {
      const before = posted.length;
      await fill(page, values);
      const [response] = await Promise.all([page.waitForResponse((answer) => answer.url().endsWith("/v1/jobs")), press(page)]);
      assert.equal(response.status(), 422);
      assert.equal(posted.length, before + 1);
      const pointers = (await response.json()).errors.map(({ pointer }) => pointer);
      assert.deepEqual(pointers, ["Ku", "Pu", "K"].filter((_, at) => wrong[at]).map((name) => `/ultimate/${name}`));
      await page.waitForFunction(
        (count) => document.querySelectorAll("[aria-invalid=true]").length === count,
        wrong.filter(Boolean).length,
      );
      assert.deepEqual(await invalid(), wrong);
    }
    await fill(page, { Ku: "4", Pu: "30", "Static gain K": "" });
    await press(page);
    await answered(page);
  };
  await withPage("", {}, work, statuses);
});

for (const [name, options] of WINDOWS) {
  test(`the table of rules fits and axe finds nothing: ${name}`, async () => {
    await withPage("", options, async (page) => {
      await fill(page, { Ku: "4", Pu: "30", "Static gain K": "2" });
      assert.equal(await overflow(page), 0);
      await press(page);
      await answered(page);
      assert.equal(await overflow(page), 0);
      assert.deepEqual(await accessibilityViolations(page), []);
    });
  });
}
