// A modified design is not lost: while it is being kept, behind another entry, and by a reload.
import assert from "node:assert/strict";
import test from "node:test";
import { designedBy, openDesign, PLANT, setting, shows, slider } from "../design_page.mjs";
import { browserTests } from "../harness.mjs";

const { withPage, jobOf } = browserTests();
const designAt = designedBy(jobOf);

/** A job from the API, with a minimal request. */
async function openJob(page, tune) {
  const request = { plant: { type: "fopdt", K: 1.25, T: 40, L: 8 }, tune };
  const { id } = await (await page.request.post(new URL("v1/jobs", page.url()).href, { data: request })).json();
  await page.goto(new URL(`#/jobs/${id}/design`, page.url()).href);
  await slider(page, "Robustness Ms").waitFor();
}

test("a slider that moves while a design is being kept goes on from it; the job is what was kept", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("Shift+ArrowRight");
    await page.waitForURL(/Ms=1\.5&/);
    const before = await jobOf(page);
    let answer;
    const held = new Promise((resolve) => (answer = resolve));
    await page.route("**/v1/jobs", async (route) => {
      await held;
      await route.continue();
    });
    await page.getByRole("button", { name: "Keep this design" }).click();
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("ArrowRight");
    await page.waitForURL(/Ms=1\.51/);
    answer();
    await page.waitForFunction((id) => !location.hash.includes(id), before.id);
    assert.equal((await jobOf(page)).request.tune[0].Ms, 1.5);
    await page.waitForURL(/Ms=1\.51/);
    await shows(page, "Kp", (await designAt(page, 1.51)).controller.Kp);
    await page.getByRole("button", { name: "Back to the proposal" }).click();
    await shows(page, "Kp", (await designAt(page, 1.5)).controller.Kp);
  });
});

test("another entry is looked at and the turned one is as it was left, its steps too", async () => {
  await withPage("", {}, async (page) => {
    await openJob(page, [{ method: "robust" }, { method: "simc" }]);
    const proposal = await setting(page, "Kp");
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("Shift+ArrowRight");
    await page.waitForURL(/Ms=1\.5/);
    const { controller } = await designAt(page, 1.5);
    await page.getByRole("button", { name: "simc", exact: true }).click();
    await page.getByRole("heading", { name: "Settings to enter: simc" }).waitFor();
    await page.waitForURL(/design\?entry=1$/);
    await page.getByRole("button", { name: "robust", exact: true }).click();
    await page.waitForURL(/entry=0&Ms=1\.5/);
    await shows(page, "Kp", controller.Kp);
    await page.getByRole("button", { name: "Undo" }).click();
    await shows(page, "Kp", proposal);
    await page.getByRole("button", { name: "Redo" }).click();
    await shows(page, "Kp", controller.Kp);
  });
});

test("an entry without a controller shows its reason, whatever was turned before", async () => {
  await withPage("", {}, async (page) => {
    await openJob(page, [{ method: "robust" }, { method: "robust", controller: "PI", Mks: 1e-6 }]);
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("Shift+ArrowRight");
    await page.waitForURL(/Ms=1\.5/);
    const { controller } = await designAt(page, 1.5);
    await shows(page, "Kp", controller.Kp);
    await page.locator(".legend").getByRole("button", { name: "robust controller PI", exact: true }).click();
    await page.getByText("No controller meets these limits.").first().waitFor();
    assert.equal(await page.getByRole("textbox", { name: "Kp" }).count(), 0);
  });
});

test("ticking Mt = Ms makes them equal, also where the request has no Ms of its own", async () => {
  await withPage("", {}, async (page) => {
    await openJob(page, [{ method: "robust" }]);
    const proposal = await setting(page, "Kp");
    const tie = page.getByLabel("Mt = Ms");
    const Mt = page.locator(".controls").getByRole("textbox", { name: "Robustness Mt" });
    await tie.uncheck();
    await Mt.fill("1.2");
    await Mt.press("Enter");
    await page.waitForURL(/Mt=1\.2/);
    await tie.check();
    await page.waitForURL(/Ms=1\.4&.*Mt=1\.4/);
    await shows(page, "Kp", proposal);
    await Mt.waitFor({ state: "hidden" });
    assert.ok(await tie.isChecked());
  });
});

test("a gain by hand on a modified design is the same after a reload, its set-point filter too", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const controls = page.locator(".controls");
    for (const [name, value, address] of [
      ["Robustness Ms", "1.7", /Ms=1\.7/],
      ["Set-point overshoot", "10", /overshoot=10/],
      ["Kp", "2", /Kp=2/],
    ]) {
      await controls.getByRole("textbox", { name }).fill(value);
      await controls.getByRole("textbox", { name }).press("Enter");
      await page.waitForURL(address);
    }
    await shows(page, "Kp", 2);
    const settings = () => page.locator(".settings tbody").innerText();
    const before = await settings();
    assert.match(before, /Set-point filter/);
    await page.reload();
    await shows(page, "Kp", 2);
    assert.equal(await settings(), before);
  });
});
