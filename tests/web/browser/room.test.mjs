// Long words and long units have room, a press is not lost, and the notice of an outage disappears after it.
import assert from "node:assert/strict";
import test from "node:test";
import { slider } from "../design_page.mjs";
import { browserTests, openMore, overflow } from "../harness.mjs";

const tests = browserTests();
const { withPage, post } = tests;

const LONG = "Temperaturregelung".repeat(6).slice(0, 100);

for (const [window, options] of [["desktop", {}], ["phone", { width: 400, height: 860 }]])
  test(`a word of a hundred letters in a name stays in its place: ${window}`, async () => {
    await withPage("", options, async (page) => {
      const request = {
        name: LONG,
        plant: { type: "fopdt", K: 1.25, T: 40, L: 8 },
        tune: [{ method: "robust" }, { method: "simc" }],
      };
      const { id } = await post("v1/jobs", request);
      for (const address of [`#/jobs/${id}/design`, `#/jobs/${id}/compare`, "#/jobs", "#/"]) {
        await page.goto(`${tests.service.base}/${address}`);
        await page.getByText(LONG).first().waitFor();
        await page.waitForLoadState("networkidle");
        assert.equal(await overflow(page), 0, address);
      }
      await page.goto(`${tests.service.base}/#/jobs/${id}/design`);
      const title = await page.getByRole("heading", { name: LONG }).boundingBox();
      const card = await page.locator(".card.title").boundingBox();
      assert.ok(title.x + title.width <= card.x + card.width + 1, "the heading stays in its card");
    });
  });

test("the first press on Tune counts, however long a unit was typed before", async () => {
  await withPage("#/new/fopdt?K=1.25&T=40&L=8", { height: 2600 }, async (page) => {
    await page.waitForLoadState("networkidle");
    const unit = page.getByLabel("Unit of y");
    await unit.fill("cubic metres per hour, at 0 degC");
    const button = page.getByRole("button", { name: "Tune this model" });
    const box = await button.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height - 4);
    await page.mouse.down();
    await page.waitForTimeout(100);
    await page.mouse.up();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
  });
});

test("an outage that is over is no longer reported on Start", async () => {
  await withPage(
    "#/new/fopdt?K=1.25&T=40&L=8",
    {},
    async (page) => {
      const { id } = await post("v1/jobs", { name: "TIC-9", plant: { type: "fopdt", K: 1, T: 4, L: 2 } });
      await page.waitForLoadState("networkidle");
      const said = page.getByText("Not connected to the service.");
      await page.route("**/{v1/jobs,healthz}*", (route) => route.abort());
      await page.getByRole("button", { name: "Tune this model" }).click();
      await said.waitFor();
      await page.unrouteAll();
      await said.waitFor({ state: "hidden" });
      await page.route("**/{v1/jobs/*,healthz}", (route) => route.abort());
      await page.evaluate((job) => (location.hash = `#/jobs/${job}/edit`), id);
      await said.waitFor();
      await page.unrouteAll();
      await said.waitFor({ state: "hidden" });
      await page.waitForFunction(() => [...document.querySelectorAll("input")].some((input) => input.value === "TIC-9"));
    },
    ["Failed to load resource"],
  );
});

for (const [what, address] of [["a typed line", ""], ["fields of an address", "#/new/fopdt?K=2.5&T=40&L=8"]]) {
  test(`Start that opens during an outage reads its lists and its model when it is over: ${what}`, async () => {
    await withPage(
      address,
      {},
      async (page) => {
        const said = page.getByText("Not connected to the service.");
        let lost = true;
        await page.route(/\/(v1\/|healthz)/, (route) => (lost ? route.abort() : route.continue()));
        await page.reload();
        await said.waitFor();
        if (address === "") {
          await page.getByLabel("Model in one line").fill("3 e^(-2s)/(10s+1)");
          await page.getByLabel("Model in one line").blur();
        }
        lost = false;
        await said.waitFor({ state: "hidden" });
        await page.locator(".formula math").first().waitFor();
        await page.getByText("could not be read; the default method is used").waitFor({ state: "hidden" });
        assert.equal(await page.getByLabel("K", { exact: true }).inputValue(), address === "" ? "3" : "2.5");
      },
      ["Failed to load resource"],
    );
  });
}

test("a product's law is seen whole on a desktop", async () => {
  await withPage("#/new/fopdt?K=1.25&T=40&L=8", {}, async (page) => {
    await page.getByRole("button", { name: "Tune this model" }).click();
    await slider(page, "Robustness Ms").waitFor();
    await openMore(page);
    for (const words of ["deltav standard", "deltav series"]) {
      await page.getByRole("combobox", { name: "Maker and product" }).fill(words);
      await page.getByRole("listbox", { name: "Maker and product" }).getByRole("option").first().waitFor();
      await page.keyboard.press("Enter");
      const law = page.locator(".law-formulas");
      await law.waitFor();
      await page.getByRole("heading", { name: /^How Emerson DeltaV/ }).waitFor();
      const [inside, outside] = await law.evaluate((element) => [element.scrollWidth, element.clientWidth]);
      assert.ok(inside <= outside, `${words}: ${inside} px in ${outside} px`);
    }
  });
});
