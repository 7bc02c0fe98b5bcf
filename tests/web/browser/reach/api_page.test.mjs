// The API as a page: every call of the description, its fields, and a form that sends it.
import assert from "node:assert/strict";
import test from "node:test";
import { openDesign, PLANT } from "../../design_page.mjs";
import { accessibilityViolations, browserTests, overflow, WINDOWS } from "../../harness.mjs";

const tests = browserTests();
const { withPage, jobOf } = tests;

const description = async () => (await fetch(`${tests.service.base}/openapi.json`)).json();

const state = (page, text) => page.locator(".answer-state").filter({ hasText: text }).waitFor();

test("/docs leads to the page under the same policy, and the head leads there too", async () => {
  const answer = await fetch(`${tests.service.base}/docs`);
  assert.equal(answer.status, 200);
  assert.match(answer.headers.get("Content-Type"), /text\/html/);
  const page = await fetch(`${tests.service.base}/`);
  assert.equal(answer.headers.get("Content-Security-Policy"), page.headers.get("Content-Security-Policy"));
  await withPage("docs", {}, async (page) => {
    await page.getByRole("heading", { level: 1, name: "API" }).waitFor();
    await page.waitForURL(/\/#\/docs$/);
    await page.getByRole("link", { name: "Start", exact: true }).click();
    await page.getByRole("link", { name: "API", exact: true }).click();
    await page.getByRole("heading", { level: 2, name: /POST \/v1\/jobs/ }).waitFor();
  });
});

test("every call of the description is in the list and can be opened", async () => {
  const { paths } = await description();
  const ids = Object.values(paths).flatMap((item) => Object.values(item).flatMap((part) => part.operationId ?? []));
  assert.ok(ids.length > 40);
  await withPage("#/docs", {}, async (page) => {
    await page.locator(".calls a").first().waitFor();
    const links = await page.locator(".calls a").evaluateAll((list) => list.map((link) => link.getAttribute("href")));
    assert.deepEqual(links.sort(), ids.map((id) => `#/docs/${id}`).sort());
    for (const id of ids) {
      await page.evaluate((to) => (location.hash = `#/docs/${to}`), id);
      await page.locator(`.calls a[href="#/docs/${id}"][aria-current]`).waitFor({ state: "attached" });
      await page.getByRole("button", { name: "Send" }).waitFor();
    }
  });
});

test("the request of the screen is filled in, survives a reload, and is answered", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const { request } = await jobOf(page);
    await page.locator(".request-menu > summary").click();
    await page.getByRole("button", { name: "Try on the API page" }).click();
    const field = page.getByLabel("Request", { exact: true });
    await field.waitFor();
    assert.deepEqual(JSON.parse(await field.inputValue()), request);
    await page.reload();
    await field.waitFor();
    assert.deepEqual(JSON.parse(await field.inputValue()), request);
    await page.getByRole("button", { name: "Send" }).click();
    await state(page, /^20[02] .*application\/json/);
    const answer = JSON.parse(await page.getByRole("region", { name: "Answer", exact: true }).innerText());
    assert.ok(answer.id && answer.status);
    await page.evaluate(() => (location.hash = "#/docs/getJob"));
    await page.getByLabel(/^id \(path/).fill(answer.id);
    await page.getByRole("button", { name: "Send" }).click();
    await state(page, /^200 /);
    assert.equal(JSON.parse(await page.getByRole("region", { name: "Answer", exact: true }).innerText()).id, answer.id);
  });
});

test("a refusal is shown as it comes", async () => {
  await withPage(
    "#/docs/design",
    {},
    async (page) => {
      await page.getByLabel("Request", { exact: true }).fill('{"plant": {"type": "fopdt", "K": 0, "T": 1, "L": 1}}');
      await page.getByRole("button", { name: "Send" }).click();
      await state(page, /^422 .*problem\+json/);
      assert.match(await page.getByRole("region", { name: "Answer", exact: true }).innerText(), /\/plant\/K/);
    },
    ["422"],
  );
});

test("fields are unfolded as deep as one wants, also where a schema contains itself", async () => {
  await withPage("#/docs/createJob", {}, async (page) => {
    const tree = page.locator(".fields-tree").first();
    await tree.waitFor();
    for (let depth = 0; depth < 6; depth += 1) {
      const fold = tree.locator("details:not([open]) > summary").first();
      if ((await fold.count()) === 0) break;
      await fold.click();
    }
    assert.ok((await tree.locator("details[open]").count()) >= 5);
  });
});

for (const [window, options] of WINDOWS)
  test(`the API's page has no fault and fits its window: ${window}`, async () => {
    await withPage("#/docs", options, async (page) => {
      for (const id of ["createJob", "getCode", "createBatch", "getPage"]) {
        await page.evaluate((to) => (location.hash = `#/docs/${to}`), id);
        await page.locator(`.calls a[href="#/docs/${id}"][aria-current]`).waitFor({ state: "attached" });
        await page.locator(".call details").evaluateAll((folds) => folds.forEach((fold) => (fold.open = true)));
        assert.deepEqual(await accessibilityViolations(page), [], id);
        assert.equal(await overflow(page), 0, id);
      }
    });
  });
