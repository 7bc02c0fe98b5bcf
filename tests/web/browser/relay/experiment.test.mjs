// A test that the user's controller runs by itself, as a program from the page.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { accessibilityViolations, browserTests, overflow, WINDOWS } from "../../harness.mjs";

const { withPage } = browserTests();
const ADDRESS = "#/relay/fopdt?K=1&T=10&L=2";

/** The program of a question that `holds`: opening the card asks for one too. */
const answered = (page, holds) =>
  page.waitForResponse((response) => response.url().endsWith("/v1/experiments/code") && response.status() === 200 && holds(response.request().postDataJSON()));

async function openCard(page) {
  await page.getByText("Recommended test").waitFor();
  const card = page.getByRole("region", { name: "Let your controller run the test: a program" });
  await card.getByText("Let your controller run the test: a program").click();
  return card;
}

test("the planned step and sample time are proposed, and the program is the service's own", async () => {
  await withPage(ADDRESS, {}, async (page) => {
    const card = await openCard(page);
    const asked = answered(page, (sent) => sent.y_max === 90);
    await card.getByLabel(/^Largest y/).fill("90");
    await card.getByLabel(/^Largest y/).blur();
    const response = await asked;
    const sent = response.request().postDataJSON();
    assert.deepEqual([sent.experiment, sent.language, sent.action], ["relay", "st", "find"]);
    assert.ok(sent.u_step > 0 && sent.sample_time > 0, JSON.stringify(sent));
    assert.match(await response.text(), /FUNCTION_BLOCK TunewrightRelay/);
    await card.getByText("FUNCTION_BLOCK TunewrightRelay").waitFor();
    await card.getByRole("tab", { name: "Arduino" }).click();
    const save = card.getByRole("button", { name: "Download tunewright_relay.ino" });
    await save.waitFor();
    const saved = page.waitForEvent("download");
    await save.click();
    assert.match(readFileSync(await (await saved).path(), "utf8"), /y_max = 90\.0;[\s\S]*void loop\(\)/);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("a bump, and what is wrong stands at its field", async () => {
  await withPage(ADDRESS, {}, async (page) => {
    const card = await openCard(page);
    await card.getByLabel("Test", { exact: true }).selectOption("bump");
    await card.getByText("FUNCTION_BLOCK TunewrightBump").waitFor();
    await card.getByLabel(/^Least u/).fill("5");
    await card.getByLabel(/^Largest u/).fill("3");
    await card.getByLabel(/^Largest u/).blur();
    await card.getByText(/ is 3 and .* must be > /).waitFor();
  }, ["422"]);
});

for (const [window, options] of WINDOWS)
  test(`the card fits: ${window}`, async () => {
    await withPage(ADDRESS, options, async (page) => {
      await openCard(page);
      await page.getByText("FUNCTION_BLOCK TunewrightRelay").waitFor();
      assert.equal(await overflow(page), 0);
    });
  });
