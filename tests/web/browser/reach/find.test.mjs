// Ctrl+K: one search for screens, methods, controllers, jobs, documents and the actions of the screen.
import assert from "node:assert/strict";
import test from "node:test";
import { openDesign, PLANT } from "../../design_page.mjs";
import { accessibilityViolations, browserTests, overflow, WINDOWS } from "../../harness.mjs";

const tests = browserTests();
const { withPage, post } = tests;

const dialog = (page) => page.getByRole("dialog", { name: "Find" });
const options = (page) => dialog(page).getByRole("option");

async function find(page, words) {
  await page.keyboard.press("Control+k");
  await dialog(page).waitFor();
  await page.keyboard.type(words);
}

async function take(page, words, name) {
  await find(page, words);
  const option = options(page).filter({ hasText: name });
  await option.first().waitFor();
  assert.ok((await options(page).first().innerText()).match(name), `${name} is first for "${words}"`);
  await page.keyboard.press("Enter");
  await dialog(page).waitFor({ state: "hidden" });
}

test("methods, screens, jobs and documents are found by the keyboard alone", async () => {
  const { id } = await post("v1/jobs", { name: "TIC-4711 reactor jacket", plant: { type: "fopdt", K: 2, T: 30, L: 4 } });
  await withPage("", {}, async (page) => {
    await page.waitForLoadState("networkidle");
    await take(page, "skogestad", /SIMC/);
    await page.waitForURL(/#\/methods\/simc$/);
    await take(page, "range", /Range/);
    await page.waitForURL(/#\/range$/);
    await take(page, "4711 jacket", /TIC-4711 reactor jacket/);
    await page.waitForURL(new RegExp(`#/jobs/${id}/design`));
    await take(page, "glossary", /Glossary/);
    await page.waitForURL(/documents\/glossary\.html$/);
  });
});

test("every product is found by its name, and by the family that its users call it", async () => {
  await withPage(PLANT, {}, async (page) => {
    const { controllers } = await (await fetch(`${tests.service.base}/v1/controllers`)).json();
    assert.ok(controllers.length >= 61);
    await page.waitForLoadState("networkidle");
    await find(page, "");
    const field = dialog(page).getByRole("combobox");
    for (const { maker, name } of controllers) {
      await field.fill(name);
      const texts = await options(page).allInnerTexts();
      assert.ok(texts.some((text) => text.includes(name) && text.includes("controller")), `${maker} ${name}: ${texts.join(" | ")}`);
    }
    const families = new Set(controllers.flatMap((item) => item.families));
    assert.ok(families.size > 5);
    for (const family of families) {
      await field.fill(family);
      const count = await options(page).filter({ hasText: "controller" }).count();
      assert.ok(count > 0, family);
    }
  });
});

test("a name is found in each spelling, and a product first under its family, here and in the field of the controller", async () => {
  await withPage(PLANT, {}, async (page) => {
    await page.waitForLoadState("networkidle");
    const picker = page.getByRole("combobox", { name: "Maker and product" });
    const listed = page.getByRole("listbox", { name: "Maker and product" }).getByRole("option");
    const lists = [];
    for (const [words, first] of [["ControlLogix", /Rockwell/], ["Step 7", /FB41|CONT_C/], ["TIA", /PID_Compact/]]) {
      await find(page, words);
      assert.match(await options(page).filter({ hasText: "controller" }).first().innerText(), first, words);
      await page.keyboard.press("Escape");
      await dialog(page).waitFor({ state: "hidden" });
      await picker.fill(words);
      assert.match(await listed.first().innerText(), first, words);
      await picker.press("Escape");
    }
    for (const words of ["Haegglund", "Hagglund", "Hägglund"]) {
      await find(page, words);
      lists.push(await options(page).allInnerTexts());
      await page.keyboard.press("Escape");
      await dialog(page).waitFor({ state: "hidden" });
    }
    assert.ok(lists[0].length > 0);
    assert.deepEqual(lists[1], lists[0]);
    assert.deepEqual(lists[2], lists[0]);
  });
});

test("a controller becomes that of the design on the screen", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    await take(page, "controllogix pide", /PIDE/);
    const field = page.getByRole("combobox", { name: /Maker and product|Type into/ }).first();
    await page.waitForFunction((input) => /PIDE/.test(input.value), await field.elementHandle());
  });
});

test("actions of the screen are found, folded ones and those of menus too, and carried out", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    await find(page, "");
    const texts = await options(page).allInnerTexts();
    for (const name of ["Report", "Change sheet", "Request: Copy as curl", "Compare all methods", "Change the request"])
      assert.ok(texts.some((text) => text.startsWith(name)), `${name}: ${texts.join(" | ")}`);
    await page.keyboard.press("Escape");
    await dialog(page).waitFor({ state: "hidden" });
    await take(page, "compare all", /Compare all methods/);
    await page.waitForURL(/compare/);
    await page.getByRole("heading", { name: /tunings of this plant/ }).waitFor();
    await find(page, "csv");
    await options(page).filter({ hasText: /CSV/ }).first().waitFor();
  });
});

test("nothing is promised that is not there", async () => {
  await withPage("", {}, async (page) => {
    await page.waitForLoadState("networkidle");
    await find(page, "qqqq");
    await dialog(page).getByText('There is no entry "qqqq".').first().waitFor();
    await page.keyboard.press("Escape");
    await dialog(page).waitFor({ state: "hidden" });
  });
});

for (const [window, size] of WINDOWS)
  test(`axe finds nothing in the search, and names of 100 letters stay inside: ${window}`, async () => {
    const long = "Temperaturregelung".repeat(6).slice(0, 100);
    await post("v1/jobs", { name: long, plant: { type: "fopdt", K: 2, T: 30, L: 4 } });
    await withPage(PLANT, size, async (page) => {
      await page.waitForLoadState("networkidle");
      await page.getByRole("button", { name: "Find", exact: true }).click();
      await options(page).filter({ hasText: long }).first().waitFor();
      assert.deepEqual(await accessibilityViolations(page), []);
      assert.equal(await overflow(page), 0);
      const [inside, outside] = await dialog(page).getByRole("listbox").evaluate((list) => [list.scrollWidth, list.clientWidth]);
      assert.ok(inside <= outside, `${inside} px in ${outside} px`);
    });
  });
