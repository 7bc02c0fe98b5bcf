import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import { contractTypes, figureUnits } from "../../../web/generate_contract.mjs";
import { accessibilityViolations, browserTests, root } from "../harness.mjs";

const tests = browserTests();
const { withPage } = tests;

test("the methods' page lists what the service lists, finds by words, and shows one with its options", async () => {
  await withPage("#/methods", {}, async (page) => {
    const { methods } = await (await fetch(`${tests.service.base}/v1/methods`)).json();
    await page.locator("article").first().waitFor();
    const text = await page.locator(".method-list").innerText();
    for (const method of methods) {
      assert.ok(text.includes(method.title), method.id);
      assert.ok(text.includes(method.source), `source of ${method.id}`);
    }
    await page.getByLabel("Find a method").fill("skogestad simc");
    const said = (method) => JSON.stringify({ ...method, options: null }).toLowerCase();
    const matching = methods.filter((method) => said(method).includes("simc") && said(method).includes("skogestad"));
    assert.ok(matching.length > 0 && matching.length < methods.length / 2);
    assert.deepEqual(
      await page.locator("article:visible h2 a").allInnerTexts(),
      matching.map((method) => method.title),
    );
    await page.locator("article:visible h2 a").first().click();
    await page.getByRole("heading", { level: 1, name: /SIMC/ }).waitFor();
    assert.match(await page.getByRole("region", { name: /^Options of/ }).innerText(), /tau_c/);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("the methods' formulas are mathematics, each equation whole; without MathML the text is shown", async () => {
  const { methods } = await (await fetch(`${tests.service.base}/v1/methods`)).json();
  await withPage("#/methods", { viewport: { width: 390, height: 844 } }, async (page) => {
    const formula = (id) => page.locator("article", { has: page.locator(`a[href$="/${id}"]`) }).locator(".method-formula");
    await formula("haalman").waitFor();
    assert.equal(await page.locator(".method-formula").count(), methods.length);
    assert.equal(await page.locator(".method-formula:has(math)").count(), methods.length);
    assert.equal(await page.locator(".method-formula pre").count(), 0);
    const line = formula("haalman").locator(".formula-line").first();
    const parts = await line.locator("math").evaluateAll((all) => all.map((math) => math.textContent));
    assert.deepEqual(parts, ["Kp=2\u2062T3\u2062K\u2062L,", "Ti=T"]);
    const [above, below] = await line.locator("mfrac > *").evaluateAll((all) => all.map((part) => part.getBoundingClientRect()));
    assert.ok(above.bottom <= below.top, "a fraction stands over its line");
    const inside = await page.locator(".method-formula").evaluateAll((all) =>
      all.filter((box) => box.getBoundingClientRect().right > document.documentElement.clientWidth).length);
    assert.equal(inside, 0, "what is wide scrolls in its box");
  });
  await withPage("#/", {}, async (page) => {
    const texts = methods.map(({ formula_mathml, ...method }) => method);
    await page.route("**/v1/methods", (route) => route.fulfill({ json: { methods: texts } }));
    await page.goto(`${tests.service.base}/#/methods/haalman`);
    await page.reload();
    const text = await page.locator(".method-formula pre").innerText();
    assert.equal(text, methods.find(({ id }) => id === "haalman").formula.replaceAll("; ", "\n"));
  });
});

test("the page's types and units are those of the service's own document", async () => {
  const document = await (await fetch(`${tests.service.base}/openapi.json`)).json();
  const kept = readFileSync(path.join(root, "web/src/api/contract.gen.ts"), "utf8");
  assert.equal(await contractTypes(document), kept, "make them anew: web/generate_contract.mjs says how");
  const units = readFileSync(path.join(root, "web/src/api/units.gen.ts"), "utf8");
  assert.equal(figureUnits(document), units, "make them anew: web/generate_contract.mjs says how");
  const { Standing, LoadPerformance } = document.components.schemas;
  delete Standing.properties.group;
  Standing.required = Standing.required.filter((name) => name !== "group");
  assert.notEqual(await contractTypes(document), kept, "another document has other types");
  LoadPerformance.properties.IAE["x-unit"] = "y";
  assert.notEqual(figureUnits(document), units, "another document has other units");
});
