// The answer first: the settings to enter stand above the plots, in the user's product, with today's values, and other
// values can be typed in their place.
import assert from "node:assert/strict";
import test from "node:test";
import { openDesign, PLANT, setting, shows, slider } from "../design_page.mjs";
import { accessibilityViolations, browserTests, overflow } from "../harness.mjs";
import { germanTrend, heaterLog } from "../made_records.mjs";
import { chooseProduct, person } from "../person.mjs";
import { assertRequestIsShown, designOnScreen, requestHandedOut, watchCalls } from "../shown_request.mjs";

const tests = browserTests();
const { withPage, post } = tests;

const DELTAV = { product: "emerson_deltav_standard", y_span: [0, 200], u_span: [0, 100], sample_time: 0.5 };
const LOOP = {
  name: "TIC-101",
  units: { time: "s", u: "%", y: "degC" },
  plant: { type: "fopdt", K: 2, T: 10, L: 3 },
  tune: [{ method: "robust" }, { method: "simc" }],
  implement: DELTAV,
  baseline: { ...DELTAV, settings: { GAIN: 1, RESET: 10, RATE: 0 } },
};

async function openLoop(page, request = LOOP) {
  const { id, result } = await post("v1/jobs", request);
  await page.goto(`${tests.service.base}/#/jobs/${id}/design`);
  await page.locator("table.typed tbody tr").first().waitFor();
  return { id, entry: result.controllers[result.proposed ?? 0] };
}

/** Gives the chosen product its ranges: y from 0 to 200, u from 0 to 100. */
async function giveRanges(page) {
  for (const [group, ends] of [["Measurement range", ["0", "200"]], ["Output range", ["0", "100"]]])
    for (const [index, end] of ["from", "to"].entries()) {
      const field = page.getByRole("group", { name: new RegExp(`^${group}`) }).getByRole("textbox", { name: end });
      await field.fill(ends[index]);
      await field.press("Tab");
    }
}

/** Label, today's value, new value and unit of each row. */
const rowsOf = (page) =>
  page.locator("table.typed tbody tr").evaluateAll((rows) =>
    rows.map((row) => ["th", ".today", ".value", ".unit"].map((cell) => row.querySelector(cell)?.textContent ?? "")),
  );

for (const [window, options] of [
  ["1440 x 900", {}],
  ["1280 x 720", { width: 1280, height: 720 }],
  ["a phone", { width: 390, height: 844 }],
  ["dark 1280 x 720", { width: 1280, height: 720, scheme: "dark" }],
])
  test(`the settings to enter stand whole on the first screen, above the plots: ${window}`, async () => {
    await withPage("", options, async (page) => {
      const { entry } = await openLoop(page);
      await page.getByRole("heading", { name: "Type into Emerson DeltaV PID, FORM Standard" }).waitFor();
      const rows = await rowsOf(page);
      assert.deepEqual(rows.slice(0, 3), [
        ["GAIN", "1", entry.as_entered.as_typed.GAIN, entry.as_entered.units.GAIN ?? ""],
        ["RESET", "10", entry.as_entered.as_typed.RESET, "s"],
        ["RATE", "0", entry.as_entered.as_typed.RATE, "s"],
      ]);
      assert.ok(rows.some(([label, , value]) => label === "STRUCTURE" && value !== ""), "the block needs its structure");
      const table = await page.locator("table.typed").boundingBox();
      const plot = await page.locator(".main-column section.plot").first().boundingBox();
      assert.ok(table.y + table.height <= (options.height ?? 900), `the rows end at ${table.y + table.height}`);
      assert.ok(table.y + table.height <= plot.y, "the plots follow");
      const facts = await page.locator(".verdict .facts dt").allInnerTexts();
      assert.equal(facts.length, 3, facts.join());
      assert.equal(await overflow(page), 0);
      assert.deepEqual(await accessibilityViolations(page), []);
    });
  });

test("other values typed in the product's rows are shown with their verdict, marked, and asked for again", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    await openLoop(page);
    await page.getByRole("button", { name: "Type other values" }).click();
    const gain = page.getByRole("textbox", { name: "GAIN, new" });
    await gain.fill("1,3");
    await gain.press("Enter");
    await page.waitForURL(/Kp=0\.65&/);
    await settled();
    assert.equal(Number(await gain.inputValue()), 1.3);
    await page.getByText("robust, set by hand", { exact: true }).waitFor();
    const request = await requestHandedOut(page);
    assert.equal(request.controllers[0].settings.GAIN, 1.3);
    assert.deepEqual(request.implement, DELTAV);
    await page.getByRole("button", { name: "Type other values" }).click();
    await assertRequestIsShown(page, post, "typed");
    await page.getByRole("button", { name: "Type other values" }).click();

    await page.getByRole("textbox", { name: "RESET, new" }).fill("a while");
    await page.getByRole("textbox", { name: "RESET, new" }).press("Enter");
    await page.getByText(/^RESET "a while" is not a number/).waitFor();
    await page.getByRole("button", { name: "Type other values" }).click();
    await page.getByRole("button", { name: "Undo" }).click();
    await page.getByText("robust", { exact: true }).first().waitFor();
    await page.waitForURL(/design(\?entry=\d)?$/);
  });
});

/** Answers to these calls wait until `release`. */
async function hold(page, address) {
  let release;
  const released = new Promise((go) => (release = go));
  await page.route(address, async (route) => {
    await released;
    await route.continue();
  });
  return release;
}

test("a text that is being typed stays when the answer to the one before arrives", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    await openLoop(page);
    const release = await hold(page, "**/v1/controllers/*/controller");
    await page.getByRole("button", { name: "Type other values" }).click();
    const [gain, reset] = ["GAIN", "RESET"].map((name) => page.getByRole("textbox", { name: `${name}, new` }));
    await gain.fill("1.3");
    await gain.press("Tab");
    await reset.fill("7.5");
    release();
    await page.getByText("robust, set by hand", { exact: true }).waitFor();
    await settled();
    assert.equal(await reset.inputValue(), "7.5");
    await reset.press("Enter");
    await settled();
    const { settings } = (await requestHandedOut(page)).controllers[0];
    assert.deepEqual([settings.GAIN, settings.RESET], [1.3, 7.5]);
  });
});

test("an answer about settings that a slider replaces is not shown; the release asks for the new ones", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const release = await hold(page, "**/v1/evaluate");
    const asked = page.waitForRequest("**/v1/evaluate");
    await chooseProduct(page, person(page), "deltav standard", "Emerson DeltaV PID, FORM Standard");
    await giveRanges(page);
    await asked;
    const range = slider(page, "Robustness Ms");
    await range.scrollIntoViewIfNeeded();
    const box = await range.boundingBox();
    const designed = page.waitForResponse("**/v1/design");
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await designed;
    const answered = page.waitForResponse("**/v1/evaluate").catch(() => null);
    release();
    await Promise.race([answered, page.waitForTimeout(1000)]);
    assert.equal(await page.locator("table.typed:visible tbody tr").count(), 0);
    await page.mouse.up();
    await page.locator("table.typed tbody tr").first().waitFor();
    await page.getByText("robust, moved by the sliders", { exact: true }).waitFor();
  });
});

test("a product that could not be loaded is asked for again", async () => {
  await withPage(
    "",
    {},
    async (page) => {
      let lost = 2;
      await page.route("**/v1/controllers/emerson_deltav_standard", (route) => (lost-- > 0 ? route.abort() : route.continue()));
      const { id } = await post("v1/jobs", LOOP);
      await page.goto(`${tests.service.base}/#/jobs/${id}/design`);
      await page.getByRole("heading", { name: "Type into Emerson DeltaV PID, FORM Standard" }).waitFor();
      await page.locator("table.typed tr", { hasText: "GAIN" }).waitFor();
      assert.equal(await page.locator(".typed-card > .trouble:visible").count(), 0);
    },
    ["ERR_FAILED"],
  );
});

test("values typed into a product are there as typed after a reload, and for another reader of the address", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    await openLoop(page, { ...LOOP, implement: undefined, baseline: undefined });
    await chooseProduct(page, person(page), "deltav standard", "Emerson DeltaV PID, FORM Standard");
    await giveRanges(page);
    await page.getByRole("button", { name: "Type other values" }).click();
    const gain = page.getByRole("textbox", { name: "GAIN, new" });
    await gain.fill("1.3");
    await gain.press("Enter");
    await page.waitForURL(/typed=/);
    await settled();
    const asTyped = async (there) => {
      await there.getByRole("heading", { name: "Type into Emerson DeltaV PID, FORM Standard" }).waitFor();
      await there.getByText("robust, set by hand", { exact: true }).waitFor();
      await there.waitForFunction(
        () => [...document.querySelectorAll("table.typed tr")].some((row) => /^GAIN/.test(row.textContent) && Number(row.querySelector(".value").textContent) === 1.3),
      );
      const request = await requestHandedOut(there);
      assert.deepEqual([request.controllers[0].settings.GAIN, request.implement.product], [1.3, "emerson_deltav_standard"]);
    };
    await page.reload();
    await asTyped(page);
    await withPage(new URL(page.url()).hash, {}, asTyped);
  });
});

test("settings that are typed are kept as a job: report, change sheet and code have them, from today's", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    const { id } = await openLoop(page);
    await page.getByRole("button", { name: "Type other values" }).click();
    for (const [name, text] of [["GAIN", "1.37"], ["RESET", "7.3"]]) {
      const field = page.getByRole("textbox", { name: `${name}, new` });
      await field.fill(text);
      await field.press("Enter");
      await settled();
    }
    await page.getByRole("button", { name: "Type other values" }).click();
    const before = await designOnScreen(page);
    await page.getByText(/Keep these settings to get their own\.$/).waitFor();
    await page.getByRole("button", { name: "Keep these settings" }).click();
    await page.waitForURL((address) => !address.hash.includes(id) && /entry=2$/.test(address.hash));
    await settled();
    const kept = await designOnScreen(page);
    assert.deepEqual([kept.settings, kept.verdict[0]], [before.settings, before.verdict[0]]);
    assert.deepEqual(await accessibilityViolations(page), []);
    const job = await tests.jobOf(page);
    assert.deepEqual(job.result.controllers.map(({ method }) => method), ["robust", "simc", "given", "baseline"]);
    assert.deepEqual([job.request.controllers[0].settings.GAIN, job.request.controllers[0].settings.RESET], [1.37, 7.3]);
    const textOf = async (name) => {
      const address = await page.getByRole("link", { name, exact: true }).getAttribute("href");
      return (await page.request.get(new URL(address, page.url()).href)).text();
    };
    for (const name of ["Report", "Change sheet"]) {
      const html = await textOf(name);
      for (const [entry, gain, reset] of [[2, "1.37", "7.3"], [3, "1", "10"]])
        for (const [setting, typed] of [["GAIN", gain], ["RESET", reset]])
          assert.match(html, new RegExp(`controllers/${entry}/as_entered/as_typed/${setting}">${typed}(\\.)?0*<`), `${name}: ${setting}`);
    }
    const code = await (await page.request.get(`${tests.service.base}/v1/jobs/${job.id}/controllers/2/code?language=python`)).text();
    assert.match(code, /\b0\.685\b/, "1.37 percent of 100 over 200");
    assert.match(code, /\b7\.3\b/);
    // Other values typed now replace them.
    await page.getByRole("button", { name: "Type other values" }).click();
    await page.getByRole("textbox", { name: "GAIN, new" }).fill("1.2");
    await page.getByRole("textbox", { name: "GAIN, new" }).press("Enter");
    await settled();
    const request = await requestHandedOut(page);
    assert.deepEqual(request.controllers.map(({ settings }) => settings.GAIN), [1.2]);
  });
});

for (const [form, name, typed, Kp, Ti, Td] of [
  ["Ideal form", "Ti", 30, (kp) => kp, () => 30, (_kp, _ti, td) => td],
  ["Series form", "Ti", 20, (kp, _ti, td) => kp * (1 + td / 20), (_kp, _ti, td) => 20 + td, (_kp, _ti, td) => (20 * td) / (20 + td)],
  ["Parallel form", "Ki", 0.05, (kp) => kp, (kp) => kp / 0.05, (kp, _ki, kd) => kd / kp],
])
  test(`a value typed in the ${form.toLowerCase()} makes the controller of that form`, async () => {
    await withPage(PLANT, {}, async (page) => {
      const settled = watchCalls(page);
      await openDesign(page);
      const picker = page.getByRole("combobox", { name: "Maker and product" });
      await picker.fill(form);
      await page.getByRole("option", { name: form }).click();
      const rows = await rowsOf(page);
      const before = rows.slice(0, 3).map(([, , value]) => Number(value));
      await page.getByRole("button", { name: "Type other values" }).click();
      const field = page.getByRole("textbox", { name: `${name}, new` });
      await field.fill(String(typed));
      await field.press("Enter");
      await page.waitForURL(/Ti=/);
      await settled();
      await page.getByRole("button", { name: "Type other values" }).click();
      await shows(page, name, typed);
      await picker.fill("Ideal form");
      await page.getByRole("option", { name: "Ideal form" }).click();
      for (const [label, wanted] of [["Kp", Kp(...before)], ["Ti", Ti(...before)], ["Td", Td(...before)]])
        assert.ok(Math.abs((await setting(page, label)) / wanted - 1) < 1e-3, `${label} is not ${wanted}`);
      await assertRequestIsShown(page, post, form);
    });
  });

test("the card is copied as a table, with today's values", async () => {
  await withPage("", {}, async (page) => {
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"], { origin: tests.service.base });
    await openLoop(page);
    const rows = await rowsOf(page);
    await page.getByRole("button", { name: "Copy as table" }).click();
    await page.getByRole("button", { name: "Copied" }).waitFor();
    const copied = await page.evaluate(() => navigator.clipboard.readText());
    assert.equal(copied, [["parameter", "today", "new", "unit"], ...rows].map((cells) => cells.join("\t")).join("\n"));
  });
});

for (const [window, options] of [["desktop", {}], ["1280 x 720", { width: 1280, height: 720 }], ["phone", { width: 390, height: 844 }]])
  test(`long names and units stay in the card: ${window}`, async () => {
    await withPage("", options, async (page) => {
      const unit = "Kilogrammprosekunde2";
      await openLoop(page, { ...LOOP, name: "Temperaturregelung".repeat(6).slice(0, 100), units: { time: "s", u: unit, y: unit }, implement: undefined, baseline: { form: "ideal", Kp: 0.3, Ti: 12 } });
      assert.equal(await overflow(page), 0);
      const card = await page.locator(".settings").boundingBox();
      for (const cell of await page.locator("table.typed td").all()) {
        const box = await cell.boundingBox();
        assert.ok(box.x + box.width <= card.x + card.width, await cell.innerText());
      }
    });
  });

test("from a German trend to the settings of a DeltaV: three fields, four clicks, with the file's units and tag", async () => {
  await withPage("", {}, async (page) => {
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"], { origin: tests.service.base });
    await page.waitForLoadState("networkidle");
    const who = person(page);
    await who.file("Trend.csv", germanTrend());
    await who.click("button", "Use and tune");
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    await page.getByRole("heading", { name: "TIC101", exact: true }).waitFor();
    await chooseProduct(page, who, "deltav standard", "Emerson DeltaV PID, FORM Standard");
    const range = page.getByRole("group", { name: "Measurement range (°C)" });
    await who.fill(range.getByRole("textbox", { name: "from" }), "0");
    await who.fill(range.getByRole("textbox", { name: "to" }), "200");
    await page.getByRole("heading", { name: "Type into Emerson DeltaV PID, FORM Standard" }).waitFor();
    await who.click("button", "Design for this controller");
    await page.getByRole("button", { name: "Design for this controller" }).waitFor({ state: "hidden" });
    await page.waitForFunction(() => !document.querySelector(".own-controller[aria-busy]"));
    await who.click("button", "Copy all with units");
    await page.getByRole("button", { name: "Copied" }).waitFor();
    const lines = (await page.evaluate(() => navigator.clipboard.readText())).split("\n");
    const { request, result } = await tests.jobOf(page);
    const { as_typed: typed } = result.controllers[0].as_entered;
    assert.equal(lines[1], `GAIN = ${typed.GAIN} %/%`);
    assert.ok(lines.includes(`STRUCTURE = ${typed.STRUCTURE}`), lines.join("; "));
    assert.deepEqual(request.units, { u: "%", y: "°C" });
    assert.equal(request.name, "TIC101");
    assert.deepEqual([request.implement.y_span, request.implement.u_span], [[0, 200], [0, 100]]);
    assert.deepEqual(who.counts, { clicks: 4, fields: 3 });
  }, ["422"]);
});

test("from a heater's log to the lines of printer.cfg: three clicks", async () => {
  await withPage("", {}, async (page) => {
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"], { origin: tests.service.base });
    await page.waitForLoadState("networkidle");
    const who = person(page);
    await who.file("hotend.csv", heaterLog());
    await who.click("button", "Use and tune");
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    await chooseProduct(page, who, "klipper", "Klipper heater");
    await page.getByRole("heading", { name: /^Type into Klipper/ }).waitFor();
    await who.click("button", "Copy text: printer.cfg, in [extruder] or [heater_bed] instead of the lines of these names");
    await page.getByRole("button", { name: "Copied" }).waitFor();
    const rows = Object.fromEntries((await rowsOf(page)).map(([label, , value]) => [label, value]));
    assert.equal(
      await page.evaluate(() => navigator.clipboard.readText()),
      ["control: pid", ...["pid_Kp", "pid_Ki", "pid_Kd", "smooth_time"].map((name) => `${name}: ${rows[name]}`)].join("\n"),
    );
    const output = page.getByRole("group", { name: /^Output range/ });
    assert.deepEqual([await output.getByLabel("from").inputValue(), await output.getByLabel("to").inputValue()], ["0", "1"]);
    assert.deepEqual(who.counts, { clicks: 3, fields: 1 });
  });
});

test("values typed one after another without a pause, or pasted, are all kept, whenever the answers come", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    await openLoop(page);
    await settled();
    // Each answer comes while the next value is typed.
    await page.route("**/v1/design", async (route) => {
      await new Promise((resolve) => setTimeout(resolve, 150));
      await route.continue();
    });
    await page.getByRole("button", { name: "Type other values" }).click();
    const field = (name) => page.getByRole("textbox", { name: `${name}, new` });
    /** Past the copy button and the label of the next row. */
    const goOn = async (key, name) => {
      const reached = () => field(name).evaluate((input) => document.activeElement === input);
      for (let stops = 0; stops < 4 && !(await reached()); stops += 1) await page.keyboard.press(key);
      assert.ok(await reached(), name);
    };
    await field("GAIN").selectText();
    for (const [name, text] of [["GAIN", "1.1"], ["RESET", "75"], ["RATE", "2.5"]]) {
      await goOn("Tab", name);
      await page.keyboard.press("Control+a");
      await page.keyboard.type(text, { delay: 60 });
    }
    await page.keyboard.press("Tab");
    await settled();
    const shown = async () => [await field("GAIN").inputValue(), await field("RESET").inputValue(), await field("RATE").inputValue()].map(Number);
    assert.deepEqual(await shown(), [1.1, 75, 2.5]);
    const { settings } = (await requestHandedOut(page)).controllers[0];
    assert.deepEqual([settings.GAIN, settings.RESET, settings.RATE], [1.1, 75, 2.5]);
    // A pasted text is one event.
    await field("RATE").selectText();
    await page.keyboard.insertText("3");
    await goOn("Shift+Tab", "RESET");
    await page.keyboard.press("Control+a");
    await page.keyboard.insertText("60");
    await page.keyboard.press("Tab");
    await settled();
    assert.deepEqual(await shown(), [1.1, 60, 3]);
  });
});

test("a value that is typed while an answer is on its way is that of the kept design", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    const { id } = await openLoop(page);
    await settled();
    await page.getByRole("button", { name: "Type other values" }).click();
    const gain = page.getByRole("textbox", { name: "GAIN, new" });
    await gain.fill("1.2");
    await gain.press("Enter");
    await page.getByRole("button", { name: "Keep these settings" }).waitFor();
    await page.route("**/v1/design", async (route) => {
      await new Promise((resolve) => setTimeout(resolve, 300));
      await route.continue();
    });
    await gain.fill("1.05");
    await page.getByRole("button", { name: "Keep these settings" }).click();
    await page.waitForFunction((first) => !location.hash.includes(first), id);
    await settled();
    const { controllers } = (await tests.jobOf(page)).request;
    assert.equal(controllers[0].settings.GAIN, 1.05);
  });
});
