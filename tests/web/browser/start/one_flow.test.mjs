// What the user has, the controller and today's settings: one flow, in any order, with few clicks and fields.
import assert from "node:assert/strict";
import test from "node:test";
import { accessibilityViolations, browserTests, dropFile, overflow } from "../../harness.mjs";
import { loopUnderPI } from "../../made_records.mjs";
import { chooseProduct, giveMeasurementRange, person } from "../../person.mjs";

const tests = browserTests();
const { withPage, jobOf } = tests;

const DELTAV = "Emerson DeltaV PID, FORM Standard";
const press = (page, name) => page.getByRole("button", { name, exact: true }).click();
const today = (page) => page.getByRole("region", { name: /^Today's settings/ });
const offer = (page) => today(page).getByRole("checkbox", { name: "Use as today's settings" });

/** Drops the trend, and waits for Identify: on Start the offer is there before. */
async function dropped(page) {
  await dropFile(page, ".drop", "trend.csv", loopUnderPI());
  await page.getByRole("button", { name: "Use and tune" }).waitFor({ timeout: 120_000 });
  await offer(page).waitFor();
}

/** The steps of a process engineer; each leaves the page at rest. */
const STEPS = {
  async controller(page, who) {
    await chooseProduct(page, who, "deltav standard", DELTAV);
    await giveMeasurementRange(page, who, "0", "200");
  },
  async record(page, who) {
    await who.file("trend.csv", loopUnderPI());
    await page.getByRole("button", { name: "Use and tune" }).waitFor();
  },
  /** Taken by a click unless it was taken by itself. */
  async today(page, who) {
    await offer(page).waitFor();
    if (!(await offer(page).isChecked())) await who.click("checkbox", "Use as today's settings");
  },
  async tune(page, who) {
    await who.click("button", "Use and tune");
    await page.locator("table.typed tbody tr").first().waitFor({ timeout: 120_000 });
  },
  async redesign(page, who) {
    await who.click("button", "Design for this controller");
    await page.getByRole("button", { name: "Design for this controller" }).waitFor({ state: "hidden" });
  },
};

for (const order of [
  ["controller", "record", "today", "tune"],
  ["record", "controller", "today", "tune"],
  ["record", "today", "controller", "tune"],
  ["record", "today", "tune", "controller", "redesign"],
])
  test(`from a trend to a change sheet for DeltaV with today's settings: ${order.join(", ")}`, async () => {
    await withPage("", {}, async (page) => {
      await page.waitForLoadState("networkidle");
      const who = person(page);
      for (const step of order) await STEPS[step](page, who);
      await page.getByRole("heading", { name: `Type into ${DELTAV}` }).waitFor();
      await page.locator("table.typed tr", { hasText: "RESET" }).locator(".today", { hasText: /^(59|60)/ }).waitFor();
      const [sheet] = await Promise.all([page.context().waitForEvent("page"), who.click("link", "Change sheet")]);
      await sheet.waitForLoadState();
      const text = await sheet.locator("body").innerText();
      for (const words of ["FIC7", DELTAV, "GAIN", "RESET"]) assert.ok(text.includes(words), `${words}: ${text}`);
      const { request, result } = await jobOf(page);
      assert.equal(request.baseline, "from-record");
      assert.deepEqual(request.implement, { product: "emerson_deltav_standard", y_span: [0, 200], u_span: [0, 100] });
      const settings = result.controllers.find(({ method }) => method === "baseline").controller;
      assert.ok(Math.abs(settings.Kp / 0.8 - 1) < 0.02 && Math.abs(settings.Ti / 60 - 1) < 0.02, JSON.stringify(settings));
      assert.ok(who.counts.fields <= 3 && who.counts.clicks <= 5, JSON.stringify(who.counts));
    });
  });

test("a product chosen on Start is the form of today's settings, and what was typed before it stays", async () => {
  await withPage("", {}, async (page) => {
    await page.waitForLoadState("networkidle");
    const who = person(page);
    const form = today(page).getByLabel("Form", { exact: true });
    await chooseProduct(page, who, "deltav standard", DELTAV);
    await page.waitForFunction((name) => [...document.querySelectorAll("select")].some((item) => item.selectedOptions[0]?.text === name), DELTAV);
    await today(page).getByLabel("GAIN (%/%)", { exact: true }).fill("1,5");
    await today(page).getByLabel("RESET (s)", { exact: true }).fill("80");
    // Another product, and back.
    await chooseProduct(page, who, "foxboro", "Foxboro I/A Series PID block");
    await today(page).getByLabel("PBAND (%)", { exact: true }).waitFor();
    await chooseProduct(page, who, "deltav standard", DELTAV);
    await today(page).getByLabel("RESET (s)", { exact: true }).waitFor();
    assert.equal(await today(page).getByLabel("RESET (s)", { exact: true }).inputValue(), "80");
    await giveMeasurementRange(page, who, "0", "200");

    await dropped(page);
    assert.equal(await offer(page).isChecked(), false, "what is typed counts");
    assert.equal(await today(page).getByLabel("GAIN (%/%)", { exact: true }).inputValue(), "1,5");
    await press(page, "Use and tune");
    await page.locator("table.typed tbody tr").first().waitFor();
    const { request } = await jobOf(page);
    assert.deepEqual(request.baseline.settings, { GAIN: 1.5, RESET: 80 });
    assert.equal(await form.count(), 0);
  });
});

test("settings typed in a textbook form stay in it when a product is chosen; half a range survives a dropped file", async () => {
  await withPage("", {}, async (page) => {
    await page.waitForLoadState("networkidle");
    const who = person(page);
    await today(page).getByLabel("Kp", { exact: true }).fill("0.7");
    await today(page).getByLabel("Ti", { exact: true }).fill("90");
    await chooseProduct(page, who, "deltav standard", DELTAV);
    assert.equal(await today(page).getByLabel("Form", { exact: true }).inputValue(), "ideal");
    const range = page.getByRole("group", { name: /^Measurement range/ });
    await who.fill(range.getByRole("textbox", { name: "from" }), "0");
    await dropped(page);
    assert.equal(await range.getByRole("textbox", { name: "from" }).inputValue(), "0");
    await who.fill(range.getByRole("textbox", { name: "to" }), "200");
    await press(page, "Use and tune");
    await page.locator("table.typed tbody tr").first().waitFor();
    const { request } = await jobOf(page);
    assert.deepEqual(request.baseline, { form: "ideal", Kp: 0.7, Ti: 90 });
    assert.equal(request.implement.product, "emerson_deltav_standard");
  });
});

test("a range that was given in another unit is not taken along by a file that names its own", async () => {
  await withPage("", {}, async (page) => {
    await page.waitForLoadState("networkidle");
    const who = person(page);
    await page.getByLabel("Unit of y").fill("bar");
    await page.getByLabel("Unit of y").press("Tab");
    await chooseProduct(page, who, "deltav standard", DELTAV);
    await giveMeasurementRange(page, who, "0", "10");
    await press(page, "Tune this model");
    await page.getByRole("heading", { name: /^Type into/ }).waitFor();
    await page.getByRole("link", { name: "Start", exact: true }).click();
    await dropped(page);
    const range = page.getByRole("group", { name: "Measurement range (°C)" });
    assert.equal(await range.getByRole("textbox", { name: "to" }).inputValue(), "");
  });
});

for (const [window, options] of [
  ["1440 x 900", {}],
  ["1280 x 720, dark", { width: 1280, height: 720, scheme: "dark" }],
  ["a phone", { width: 390, height: 844 }],
])
  test(`the cards of the loop on Start and Identify: ${window}`, async () => {
    await withPage("", options, async (page) => {
      await page.waitForLoadState("networkidle");
      await chooseProduct(page, person(page), "deltav standard", DELTAV);
      assert.equal(await overflow(page), 0);
      assert.deepEqual(await accessibilityViolations(page), []);
      await dropped(page);
      assert.equal(await overflow(page), 0);
      assert.deepEqual(await accessibilityViolations(page), []);
    });
  });
