// Every figure explains itself: its label, or the sign next to it, opens two sentences and a link to a document.
import assert from "node:assert/strict";
import test from "node:test";
import { openDesign, PLANT, slider } from "../../design_page.mjs";
import { accessibilityViolations, browserTests, overflow } from "../../harness.mjs";

const tests = browserTests();
const { withPage, post } = tests;

/** Opens each of these, one after another. */
async function openAll(page, buttons) {
  const links = new Set();
  for (const button of await buttons.all()) {
    await button.evaluate((element) => element.scrollIntoView({ block: "center" }));
    await button.click();
    const box = page.locator(".explanation");
    await box.waitFor();
    const text = await box.locator("p").first().innerText();
    assert.ok(text.split(/[.!?:]\s/).length >= 2, text);
    links.add(await box.getByRole("link", { name: "Read more" }).getAttribute("href"));
    await page.keyboard.press("Escape");
    await box.waitFor({ state: "detached" });
  }
  for (const link of links) {
    const [address, anchor = ""] = link.split("#");
    const page = await (await fetch(`${tests.service.base}/${address}`)).text();
    assert.ok(anchor === "" || page.includes(`id="${anchor}"`), link);
  }
}

test("each figure of Design has its explanation, with the keyboard too", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    await page.getByText("All figures", { exact: true }).click();
    const rows = page.locator(".figures-card tbody tr:not(.group)");
    assert.equal(await rows.locator("th .explain").count(), await rows.count());
    assert.ok((await rows.count()) > 30);
    assert.equal(await page.locator(".verdict dt .explain").count(), 3);
    await openAll(page, page.locator(".figures-card .explain, .verdict .explain"));
    const Ms = page.locator(".figures-card").getByRole("button", { name: "Ms", exact: true });
    await Ms.focus();
    await page.keyboard.press("Enter");
    await page.getByRole("dialog", { name: /^Ms/ }).waitFor();
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.keyboard.press("Escape");
    assert.ok(await Ms.evaluate((element) => element === document.activeElement), "the focus returns");
  });
});

test("each slider, each setting to enter and the longest sample time have their explanation", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const sliders = page.locator(".controls .slider");
    assert.equal(await sliders.locator(".explain").count(), await sliders.count());
    const rows = page.locator("table.typed tbody tr");
    assert.equal(await rows.locator("th .explain").count(), await rows.count());
    await openAll(page, page.locator(".controls .explain, table.typed .explain"));
    await page.getByText("All figures", { exact: true }).click();
    await page.getByRole("button", { name: /^Longest sample time/ }).click();
    await page.getByRole("dialog", { name: "Longest sample time" }).getByRole("img").waitFor();
    await page.keyboard.press("Escape");
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("the settings of a product are explained by what they do in its law", async () => {
  const product = { product: "emerson_deltav_standard", y_span: [0, 200], u_span: [0, 100] };
  const { id } = await post("v1/jobs", { plant: { type: "fopdt", K: 2, T: 10, L: 3 }, tune: [{ method: "robust" }], implement: product });
  await withPage(`#/jobs/${id}/design`, {}, async (page) => {
    await page.locator("table.typed").getByRole("button", { name: "RESET", exact: true }).click();
    await page.getByRole("dialog", { name: /^Ti, integral time/ }).waitFor();
  });
});

test("undo keeps the focus on the label of a figure", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    for (const part of [".figures-card", ".verdict"]) {
      await slider(page, "Robustness Ms").press("Shift+ArrowRight");
      await page.waitForURL(/[?&]Ms=/);
      const label = page.locator(part).getByRole("button", { name: /IAE/ }).first();
      const name = await label.innerText();
      await label.focus();
      await page.keyboard.press("Control+z");
      await page.waitForFunction(() => !/[?&]Ms=/.test(location.hash));
      const focused = await page.evaluate(() => [document.activeElement.textContent, document.activeElement.isConnected]);
      assert.deepEqual(focused, [name, true], part);
    }
  });
});

test("each column of Compare has its explanation", async () => {
  const { id } = await post("v1/jobs", { plant: { type: "fopdt", K: 1.25, T: 40, L: 8 }, tune: [{ method: "robust" }, { method: "simc" }] });
  await withPage(`#/jobs/${id}/compare`, {}, async (page) => {
    const heads = page.locator(".comparison-table thead th[data-column]:not(.pin)");
    await heads.first().waitFor();
    assert.equal(await heads.locator(".explain").count(), await heads.count());
    await openAll(page, heads.locator(".explain"));
    assert.equal(await overflow(page), 0);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});
