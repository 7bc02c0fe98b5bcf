// From a German system's trend of a loop in automatic to a change sheet to sign, with today's settings found in the
// record: what it costs a person who knows the way.
import assert from "node:assert/strict";
import test from "node:test";
import { browserTests } from "../../harness.mjs";
import { germanTrend } from "../../made_records.mjs";
import { chooseProduct, giveMeasurementRange, person } from "../../person.mjs";

const { withPage, jobOf } = browserTests();
const DELTAV = "Emerson DeltaV PID, FORM Standard";

test("from the German trend to a change sheet for DeltaV: at most three fields and five clicks", async (context) => {
  await withPage("", {}, async (page) => {
    await page.waitForLoadState("networkidle");
    const who = person(page);
    const began = performance.now();
    await chooseProduct(page, who, "deltav standard", DELTAV);
    await giveMeasurementRange(page, who, "0", "200");
    await who.file("trend.csv", germanTrend());
    await page.getByRole("button", { name: "Use and tune" }).waitFor({ timeout: 120_000 });
    const today = page.getByRole("region", { name: /^Today's settings/ });
    const offer = today.getByRole("checkbox", { name: "Use as today's settings" });
    await offer.waitFor();
    if (!(await offer.isChecked())) await who.click("checkbox", "Use as today's settings");
    await who.click("button", "Use and tune");
    await page.locator("table.typed tbody tr").first().waitFor({ timeout: 120_000 });
    const [sheet] = await Promise.all([page.context().waitForEvent("page"), who.click("link", "Change sheet")]);
    await sheet.waitForLoadState();
    context.diagnostic(`${JSON.stringify(who.counts)}, ${((performance.now() - began) / 1000).toFixed(1)} s of the page`);
    const text = await sheet.locator("body").innerText();
    for (const words of ["TIC101", DELTAV, "GAIN", "RESET", "°C"]) assert.ok(text.includes(words), `${words}: ${text}`);
    const { request, result } = await jobOf(page);
    assert.equal(request.baseline, "from-record");
    const { controller } = result.controllers.find(({ method }) => method === "baseline");
    assert.ok(Math.abs(controller.Kp / 0.8 - 1) < 0.1 && Math.abs(controller.Ti / 150 - 1) < 0.1, JSON.stringify(controller));
    assert.ok(who.counts.fields <= 3 && who.counts.clicks <= 5, JSON.stringify(who.counts));
  });
});
