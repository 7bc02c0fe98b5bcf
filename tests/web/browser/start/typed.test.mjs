// A model in one line: its formula during typing, the fields that follow, and its faults.
import assert from "node:assert/strict";
import test from "node:test";
import { browserTests } from "../../harness.mjs";

const { withPage, jobOf } = browserTests();

const value = (page, label) => page.getByLabel(label, { exact: true }).inputValue();
const formula = (page) => page.locator("form.card .formula").first();

test("a line that is typed becomes a formula, fields and a job", async () => {
  await withPage("", {}, async (page) => {
    const line = page.getByLabel("Model in one line", { exact: true });
    await line.fill("");
    // Key by key: an incomplete text reports what is missing, and writes nothing to the console.
    await line.pressSequentially("2 e^(-3s)/((10s+1)(2s+1");
    await page.getByText("A bracket is not closed; it opens at position").waitFor();
    await line.pressSequentially("))");
    await formula(page).locator("mfrac").waitFor();
    assert.equal((await formula(page).locator("math").textContent()).trim(), "P(s)=2e−3s(10s+1)(2s+1)");
    assert.equal(await value(page, "Kind of process"), "sopdt");
    assert.deepEqual(
      [await value(page, "K"), await value(page, "T1 (s)"), await value(page, "T2 (s)"), await value(page, "L (s)")],
      ["2", "10", "2", "3"],
    );
    await page.getByRole("button", { name: "Tune this model" }).click();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    const job = await jobOf(page);
    assert.deepEqual(job.request.plant, { type: "sopdt", K: 2, T1: 10, T2: 2, L: 3 });
  });
});

test("fields write the line; what is wrong with a line stands at it", async () => {
  await withPage("", {}, async (page) => {
    const line = page.getByLabel("Model in one line", { exact: true });
    await page.getByLabel("T (s)", { exact: true }).fill("12,5");
    await page.waitForFunction(() =>
      [...document.querySelectorAll("input")].some((input) => input.value === "1.25 e^(-8 s)/(12.5 s + 1)"),
    );
    await line.fill("K=2 T=10 L=3 min");
    await page.getByText("L has a unit of time and T has none").waitFor();
    await page.getByRole("button", { name: "Tune this model" }).click();
    await page.getByRole("heading", { name: /^1 / }).waitFor();
    assert.equal(await line.getAttribute("aria-invalid"), "true");
    await line.fill("K=2 T=10 min L=3 min");
    await formula(page).locator("mfrac").waitFor();
    assert.equal(await value(page, "T (s)"), "600");
    assert.equal(await line.getAttribute("aria-invalid"), null);
  });
});
