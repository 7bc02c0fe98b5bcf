// What is typed on Start and Identify survives Back and a reload, each entry of the history with its own, and a link
// holds it.
import assert from "node:assert/strict";
import test from "node:test";
import { browserTests, dropFile, openPage } from "../../harness.mjs";
import { loopUnderPI } from "../../made_records.mjs";
import { chooseProduct, giveMeasurementRange, person } from "../../person.mjs";

const tests = browserTests();
const { withPage, jobOf } = tests;

const DELTAV = "Emerson DeltaV PID, FORM Standard";
/** As nobody but a person writes it. */
const LINE = "2e^(-3 s) / ((10s+1)*( 2s + 1))";
const today = (page) => page.getByRole("region", { name: /^Today's settings/ });
const press = (page, name) => page.getByRole("button", { name, exact: true }).click();
const start = (page) => page.getByRole("navigation", { name: "Screens" }).getByRole("link", { name: "Start" }).click();

const FIELDS = {
  line: (page) => page.getByLabel("Model in one line", { exact: true }),
  name: (page) => page.getByLabel("Loop name"),
  time: (page) => page.getByLabel("Time unit"),
  y: (page) => page.getByLabel("Unit of y"),
  controller: (page) => page.getByRole("combobox", { name: "Maker and product" }),
  to: (page) => page.getByRole("group", { name: /^Measurement range/ }).getByRole("textbox", { name: "to" }),
  gain: (page) => today(page).getByLabel("GAIN (%/%)", { exact: true }),
  reset: (page) => today(page).getByLabel("RESET (s)", { exact: true }),
  Ms: (page) => page.getByRole("textbox", { name: "Ms", exact: true }),
};

/** The texts of these fields, once the last of them is there. */
async function texts(page, names = Object.keys(FIELDS)) {
  for (const name of names) await FIELDS[name](page).waitFor();
  const all = await Promise.all(names.map(async (name) => [name, await FIELDS[name](page).inputValue()]));
  return Object.fromEntries(all);
}

const WANTED = { line: LINE, name: "TIC-101", time: "s", y: "bar", controller: DELTAV, to: "2,5", gain: "1,50", reset: "80", Ms: "1,60" };

/** Waits until the fields show these texts: a product and the methods come later than the page. */
async function shows(page, wanted, what) {
  const until = Date.now() + 20_000;
  for (;;) {
    const found = await texts(page, Object.keys(wanted));
    if (JSON.stringify(found) === JSON.stringify(wanted)) return;
    if (Date.now() > until) return assert.deepEqual(found, wanted, what);
    await page.waitForTimeout(100);
  }
}

async function describe(page) {
  await page.waitForLoadState("networkidle");
  const parsed = page.waitForResponse((response) => response.url().endsWith("/v1/plants/parse"));
  await FIELDS.line(page).fill(LINE);
  await FIELDS.line(page).press("Tab");
  await parsed;
  await page.locator("form.card .formula mfrac").first().waitFor();
  for (const name of ["name", "time", "y"]) await FIELDS[name](page).fill(WANTED[name]);
  await chooseProduct(page, person(page), "deltav standard", DELTAV);
  await giveMeasurementRange(page, person(page), "0", "2,5");
  const output = page.getByRole("group", { name: /^Output range/ });
  await output.getByLabel("from").fill("0");
  await output.getByLabel("to").fill("100");
  await FIELDS.gain(page).fill("1,50");
  await FIELDS.reset(page).fill("80");
  await FIELDS.Ms(page).fill("1,60");
  await FIELDS.Ms(page).press("Tab");
  await shows(page, WANTED, "as typed");
}

const REQUEST = {
  name: "TIC-101",
  units: { time: "s", y: "bar" },
  plant: { type: "sopdt", K: 2, T1: 10, T2: 2, L: 3 },
  implement: { product: "emerson_deltav_standard", y_span: [0, 2.5], u_span: [0, 100] },
  baseline: { product: "emerson_deltav_standard", settings: { GAIN: 1.5, RESET: 80 }, y_span: [0, 2.5], u_span: [0, 100] },
};

/** The request of the job on Design. */
async function request(page) {
  await page.locator("table.typed tbody tr").first().waitFor();
  return (await jobOf(page)).request;
}

test("name, units, controller, today's settings, options and the formula as typed survive a reload and Back, and a link holds them", async () => {
  await withPage("", {}, async (page) => {
    await describe(page);
    const link = page.url();
    assert.ok(link.length < 1000, link);
    await page.reload();
    await shows(page, WANTED, "after a reload");
    await press(page, "Tune this model");
    const asked = await request(page);
    for (const [name, value] of Object.entries(REQUEST)) assert.deepEqual(asked[name], value, name);
    assert.equal(asked.tune[0].Ms, 1.6);
    await page.goBack();
    await page.getByRole("heading", { name: "What do you have?" }).waitFor();
    await shows(page, WANTED, "after Back");

    // Somebody else, who has another controller.
    const other = await openPage(tests.browser);
    await other.page.addInitScript(() =>
      localStorage.setItem("tunewright-controller", JSON.stringify({ product: "klipper", name: "Klipper", needs: [] })),
    );
    await other.page.goto(link);
    await shows(other.page, WANTED, "by the link");
    await press(other.page, "Tune this model");
    assert.deepEqual(await request(other.page), asked);
    assert.deepEqual(await other.faults(), []);
    assert.equal(await other.page.evaluate(() => JSON.parse(localStorage.getItem("tunewright-controller")).product), "klipper");
    await other.close();
  });
});

test("each entry of the history has its own loop", async () => {
  await withPage("", {}, async (page) => {
    await describe(page);
    await press(page, "Tune this model");
    await request(page);
    await start(page);
    const parsed = page.waitForResponse((response) => response.url().endsWith("/v1/plants/parse"));
    await FIELDS.line(page).fill("K=3 T=20 L=1");
    await FIELDS.line(page).press("Tab");
    await parsed;
    const second = { line: "K=3 T=20 L=1", name: "FIC-7" };
    await FIELDS.name(page).fill("FIC-7");
    await press(page, "Tune this model");
    await request(page);
    await page.goBack();
    await shows(page, second, "the second loop");
    await page.goBack();
    await request(page);
    await page.goBack();
    await page.getByRole("heading", { name: "What do you have?" }).waitFor();
    await shows(page, WANTED, "the first loop");
    await page.reload();
    await shows(page, WANTED, "the first loop, after a reload");
  });
});

test("Identify keeps the record, the controller and the choice of today's settings over a reload", async () => {
  await withPage("", {}, async (page) => {
    await page.waitForLoadState("networkidle");
    await chooseProduct(page, person(page), "deltav standard", DELTAV);
    await giveMeasurementRange(page, person(page), "0", "200");
    await FIELDS.Ms(page).fill("1,50");
    await dropFile(page, ".drop", "trend.csv", loopUnderPI());
    const take = today(page).getByRole("checkbox", { name: "Use as today's settings" });
    await today(page).getByText(/^From the record: /).waitFor({ timeout: 120_000 });
    assert.equal(await take.isChecked(), true, "settings that are certain are taken");
    await take.setChecked(false);
    await page.reload();
    await take.waitFor();
    assert.equal(await take.isChecked(), false, "what was declined stays so");
    await shows(page, { controller: DELTAV, to: "200" }, "Identify after a reload");
    await take.setChecked(true);
    await page.reload();
    await take.waitFor();
    assert.equal(await take.isChecked(), true);
    await press(page, "Use and tune");
    const asked = await request(page);
    assert.deepEqual([asked.baseline, asked.name, asked.units], ["from-record", "FIC7", { u: "%", y: "degC" }]);
    assert.equal(asked.tune[0].Ms, 1.5);
    await page.goBack();
    await page.getByRole("heading", { name: "Identify: FIC7" }).waitFor();
    await shows(page, { controller: DELTAV, to: "200" }, "Identify after Back");
  });
});

test("an example that was changed is found changed after Back and a reload, a line with a fault as it was typed", async () => {
  await withPage("#/examples/compare-methods", {}, async (page) => {
    await page.waitForLoadState("networkidle");
    await today(page).getByLabel("Kp", { exact: true }).fill("0,77");
    await FIELDS.line(page).fill("K=2 T=10 L=3 parsecs");
    await FIELDS.line(page).press("Tab");
    await page.waitForLoadState("networkidle");
    await page.reload();
    await page.waitForLoadState("networkidle");
    assert.equal(await today(page).getByLabel("Kp", { exact: true }).inputValue(), "0,77");
    assert.equal(await FIELDS.line(page).inputValue(), "K=2 T=10 L=3 parsecs");
    await page.getByRole("link", { name: "Methods", exact: true }).click();
    await page.goBack();
    await page.getByRole("heading", { name: "What do you have?" }).waitFor();
    assert.equal(await today(page).getByLabel("Kp", { exact: true }).inputValue(), "0,77");
    assert.equal(await FIELDS.line(page).inputValue(), "K=2 T=10 L=3 parsecs");
  });
});

test("a file that is dropped while a range is being typed takes nothing of it", async () => {
  await withPage("", {}, async (page) => {
    await page.waitForLoadState("networkidle");
    await chooseProduct(page, person(page), "deltav standard", DELTAV);
    const range = page.getByRole("group", { name: /^Measurement range/ });
    await range.getByRole("textbox", { name: "from" }).fill("0");
    await range.getByRole("textbox", { name: "to" }).focus();
    await page.keyboard.type("2,5");
    await dropFile(page, ".drop", "loop.csv", loopUnderPI());
    await page.getByRole("button", { name: "Use and tune" }).waitFor({ timeout: 120_000 });
    assert.equal(await range.getByRole("textbox", { name: "from" }).inputValue(), "0");
    assert.match(await range.getByRole("textbox", { name: "to" }).inputValue(), /^2[,.]5$/);
    await page.getByRole("button", { name: "Use and tune" }).click();
    await page.locator("table.typed tbody tr").first().waitFor({ timeout: 120_000 });
    assert.deepEqual((await jobOf(page)).request.implement.y_span, [0, 2.5]);
  });
});
