// `?` and Help: the keys of the present screen, and the documents.
import assert from "node:assert/strict";
import test from "node:test";
import { openDesign, PLANT, slider } from "../../design_page.mjs";
import { accessibilityViolations, browserTests, overflow, WINDOWS } from "../../harness.mjs";

const tests = browserTests();
const { withPage } = tests;

const help = (page) => page.getByRole("dialog", { name: "Keys and documents" });
const titles = (page) => help(page).getByRole("heading", { level: 3 }).allInnerTexts();

test("? lists the keys of the screen, and only those", async () => {
  await withPage(PLANT, {}, async (page) => {
    await page.waitForLoadState("networkidle");
    await page.locator("h1").first().focus();
    await page.keyboard.press("?");
    await help(page).waitFor();
    const onStart = await titles(page);
    assert.ok(onStart.includes("Everywhere") && !onStart.includes("Plots") && !onStart.includes("Sliders"), onStart.join());
    await page.keyboard.press("Escape");
    await help(page).waitFor({ state: "hidden" });
    await openDesign(page);
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("?");
    await help(page).waitFor();
    const onDesign = await titles(page);
    for (const title of ["Everywhere", "Design", "Sliders", "Plots", "Documents"])
      assert.ok(onDesign.includes(title), `${title} in ${onDesign.join()}`);
    await page.keyboard.press("Escape");
    await help(page).waitFor({ state: "hidden" });
    const back = await page.evaluate(() => document.activeElement.getAttribute("aria-label"));
    assert.equal(back, "Robustness Ms, slider", "the focus returns");
  });
});

test("? is a letter like any other in a text field and in a dialog", async () => {
  await withPage(PLANT, {}, async (page) => {
    const name = page.getByLabel("Loop name");
    await name.focus();
    await page.keyboard.type("why?");
    assert.equal(await name.inputValue(), "why?");
    assert.equal(await help(page).count(), 0);
    await page.keyboard.press("Control+k");
    await page.getByRole("dialog", { name: "Find" }).waitFor();
    await page.keyboard.type("?");
    assert.equal(await help(page).count(), 0);
  });
});

for (const [window, options] of WINDOWS)
  test(`axe finds nothing in the list of keys, which stays in its window: ${window}`, async () => {
    await withPage(PLANT, options, async (page) => {
      await openDesign(page);
      await page.getByRole("button", { name: "Help", exact: true }).click();
      await help(page).waitFor();
      assert.deepEqual(await accessibilityViolations(page), []);
      assert.equal(await overflow(page), 0);
      const box = await help(page).boundingBox();
      const { width, height } = page.viewportSize();
      assert.ok(box.x >= 0 && box.y >= 0 && box.x + box.width <= width && box.y + box.height <= height, JSON.stringify(box));
    });
  });
