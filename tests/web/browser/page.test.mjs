// Properties of the whole page: accessibility, widths, weight.
import assert from "node:assert/strict";
import test from "node:test";
import { accessibilityViolations, browserTests, overflow, openMore } from "../harness.mjs";

const tests = browserTests();
const { withPage } = tests;

const designShown = (page) => page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();

for (const scheme of ["light", "dark"]) {
  test(`axe finds nothing on Start and Design in the ${scheme} theme`, async () => {
    await withPage("#/new/fopdt?K=1.25&T=40&L=8", { scheme }, async (page) => {
      await page.getByText(/^Compare with/).click();
      await page.getByRole("checkbox", { name: / simc$/ }).check();
      await page.getByLabel("Kp", { exact: true }).fill("1.2");
      assert.deepEqual(await accessibilityViolations(page), []);
      await page.getByRole("button", { name: "Tune this model" }).click();
      await designShown(page);
      await openMore(page);
      for (const summary of ["All figures", "How it was computed"])
        await page.getByText(summary, { exact: true }).click();
      await page.getByRole("button", { name: "Table" }).first().click();
      assert.deepEqual(await accessibilityViolations(page), []);
    });
  });
}

for (const [name, width, height] of [
  ["desktop", 1440, 900],
  ["tablet", 834, 1194],
  ["phone", 390, 844],
]) {
  test(`nothing is wider than the window on a ${name}`, async () => {
    await withPage("", { width, height }, async (page) => {
      assert.equal(await overflow(page), 0);
      await page.getByRole("button", { name: "Tune this model" }).click();
      await designShown(page);
      assert.equal(await overflow(page), 0);
    });
  });
}

test("what the first visit loads, with all calls of Start, stays within 110 kB compressed", async () => {
  await withPage("#/jobs", {}, async (page) => {
    const network = await page.context().newCDPSession(page);
    await network.send("Network.enable");
    await network.send("Network.setCacheDisabled", { cacheDisabled: true });
    const names = new Map();
    let total = 0;
    network.on("Network.responseReceived", ({ requestId, response }) => names.set(requestId, response.url));
    network.on("Network.loadingFinished", ({ encodedDataLength }) => (total += encodedDataLength));
    await page.goto("about:blank");
    names.clear();
    total = 0;
    await page.goto(tests.service.base);
    await page.getByRole("button", { name: "Tune this model" }).waitFor();
    await page.waitForLoadState("networkidle");
    const loaded = [...names.values()];
    for (const part of [/index-.*js$/, /\.css$/, /methods$/, /examples$/, /controllers$/])
      assert.ok(loaded.some((name) => part.test(name)), `${part} is among what is loaded: ${loaded.join(", ")}`);
    assert.ok(total <= 110_000, `${total} bytes: ${loaded.join(", ")}`);
  });
});
