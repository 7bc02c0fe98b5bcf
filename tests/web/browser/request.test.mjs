// A request that is changed on Start: the parts that are sent again, and the content of the form on return.
import assert from "node:assert/strict";
import test from "node:test";
import { browserTests } from "../harness.mjs";

const tests = browserTests();
const { withPage, jobOf } = tests;

const designShown = (page) => page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();

test("an emptied filter of today's settings is none, and what has no field is said and can be left out", async () => {
  const response = await fetch(`${tests.service.base}/v1/jobs`, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({
      plant: { type: "fopdt", K: 1.25, T: 40, L: 8 },
      tune: [{ method: "simc" }],
      evaluate: { load_step: 5, horizon: 77 },
      baseline: { form: "ideal", Kp: 1, Ti: 40, Td: 2, b: 0.3, filter: { type: "derivative", Tf: 5 } },
    }),
  });
  const { id } = await response.json();
  const tuned = async (page) => {
    await page.getByRole("button", { name: "Tune this model" }).click();
    await designShown(page);
    return (await jobOf(page)).request;
  };
  await withPage(`#/jobs/${id}/edit`, {}, async (page) => {
    const ofRequest = page.getByText("without a field here: evaluate.load_step 5, evaluate.horizon 77.");
    const ofToday = page.getByText("without a field here: b 0.3.");
    await ofRequest.waitFor();
    await ofToday.waitFor();
    await page.getByLabel("Tf", { exact: true }).fill("");
    const kept = await tuned(page);
    assert.deepEqual(kept.evaluate, { horizon: 77, load_step: 5 });
    assert.deepEqual(kept.baseline, { form: "ideal", Kp: 1, Ti: 40, Td: 2, b: 0.3 });
    await page.getByRole("navigation", { name: "Screens" }).getByRole("link", { name: "Start" }).click();
    await page.getByLabel("Model in one line").fill("3 e^(-1s)/(5s+1)");
    await page.getByRole("button", { name: "Leave it out of the request" }).click();
    await page.getByRole("button", { name: "Leave it out of today's settings" }).click();
    await ofRequest.waitFor({ state: "hidden" });
    await ofToday.waitFor({ state: "hidden" });
    const bare = await tuned(page);
    assert.equal(bare.evaluate, undefined);
    assert.deepEqual(bare.baseline, { form: "ideal", Kp: 1, Ti: 40, Td: 2 });
  });
});

test("Change the request keeps what was typed over it when one comes back, and begins anew by its link", async () => {
  await withPage("#/new/fopdt?K=1.25&T=40&L=8", {}, async (page) => {
    const [name, Kp] = [page.getByLabel("Loop name"), page.getByLabel("Kp", { exact: true })];
    const tune = async () => {
      await page.getByRole("button", { name: "Tune this model" }).click();
      await designShown(page);
    };
    await name.fill("TIC-1");
    await tune();
    const first = (await jobOf(page)).id;
    await page.getByRole("link", { name: "Change the request" }).click();
    await page.waitForURL(/edit$/);
    await name.fill("TIC-2");
    await Kp.fill("1.2");
    await page.getByLabel("Ti", { exact: true }).fill("40");
    await tune();
    await page.goBack();
    await page.getByRole("heading", { name: "What do you have?" }).waitFor();
    // A second load would come later than the screen.
    await page.waitForLoadState("networkidle");
    assert.deepEqual([await name.inputValue(), await Kp.inputValue()], ["TIC-2", "1.2"]);
    await page.goto(`${tests.service.base}/#/jobs/${first}/design`);
    await page.getByRole("link", { name: "Change the request" }).click();
    await page.waitForFunction(() => document.querySelector("input[placeholder='TIC-101']").value === "TIC-1");
    assert.equal(await Kp.inputValue(), "");
  });
});
