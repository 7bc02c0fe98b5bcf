// The user's own controller: chosen, typed, stored, evaluated as implemented, and as code.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { accessibilityViolations, browserTests, openMore, overflow, WINDOWS } from "../harness.mjs";

const tests = browserTests();
const { withPage, jobOf } = tests;

const designShown = async (page) => {
  await page.getByRole("heading", { name: /^(Settings to enter|Type into)/ }).waitFor();
  await openMore(page);
};
/** On Design the controller is chosen in the card of the settings. */
const picker = (page) => page.getByRole("region", { name: /^(Settings to enter|Type into|Nothing to type|My controller)/ });
const typed = (page) => page.getByRole("region", { name: /^Type into/ });
const settingsTyped = (page) => typed(page).locator("table.typed:visible tbody tr");
const found = (page) => page.getByRole("listbox", { name: "Maker and product" }).getByRole("option");
const search = (page) => page.getByRole("combobox", { name: "Maker and product" });

const post = async (path, body) => {
  const response = await fetch(`${tests.service.base}/v1/${path}`, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  });
  return { status: response.status, body: await response.json() };
};

/** Unfolds a part of the card of the settings. */
async function unfold(page, summary) {
  const part = picker(page).locator("details").filter({ has: page.locator("summary", { hasText: summary }) }).first();
  await part.waitFor();
  if (!(await part.evaluate((element) => element.open))) await part.locator("> summary").click();
}

async function giveSampleTime(page, value) {
  if ((await page.locator("details.facts").count()) > 0) await unfold(page, "Ranges and sample time");
  await picker(page).getByLabel("Sample time (s)").fill(String(value));
  await picker(page).getByLabel("Sample time (s)").press("Tab");
}

/** Searches for a product with these words and takes the first result. */
async function choose(page, words, title) {
  await search(page).fill(words);
  await found(page).first().waitFor();
  await page.keyboard.press("Enter");
  await page.waitForFunction((text) => document.querySelector("input[role=combobox]").value === text, title);
}

async function giveRange(page, name, low, high) {
  if ((await page.locator("details.facts").count()) > 0) await unfold(page, "Ranges and sample time");
  const range = picker(page).getByRole("group", { name });
  await range.getByLabel("from").fill(String(low));
  await range.getByLabel("to").fill(String(high));
  await range.getByLabel("to").press("Tab");
}

/** The rows of the list to type: label, value, unit. */
const rowsOf = (page) =>
  typed(page)
    .locator("table.typed tbody tr")
    .evaluateAll((rows) =>
      rows.map((row) => ["th", ".value", ".unit"].map((cell) => row.querySelector(cell).textContent)),
    );

async function tuneModel(page, address = "#/new/fopdt?K=1.25&T=40&L=8") {
  await page.goto(`${tests.service.base}/${address}`);
  await page.getByRole("button", { name: "Tune this model" }).click();
  await designShown(page);
}

/** Designs for the chosen controller, and returns the new job. */
async function designForMine(page, button = "Design for this controller") {
  const before = page.url();
  await page.getByRole("button", { name: button }).click();
  await page.waitForFunction((address) => location.href !== address, before);
  await page.waitForFunction(() => !document.querySelector(".own-controller[aria-busy]"));
  await page.getByRole("button", { name: button }).waitFor({ state: "hidden" });
  return jobOf(page);
}

/** A typed setting, converted to its value. */
const valueOf = (text) => (text === "true" || text === "false" ? text === "true" : text === "" || isNaN(text) ? text : Number(text));

const close = (a, b, what) => assert.ok(Math.abs(a - b) <= 1e-9 * Math.max(1, Math.abs(b)), `${what}: ${a} against ${b}`);

/** The textbook forms stand before the products. */
const TEXTBOOK_FORMS = ["Ideal form: Kp, Ti, Td", "Parallel form: Kp, Ki, Kd", "Series form: Kp, Ti, Td"];

const PRODUCTS = [
  { words: "deltav series", title: "Emerson DeltaV PID, FORM Series", id: "emerson_deltav_series", y: [0, 100], u: [0, 100] },
  { words: "mitsubishi", title: "Mitsubishi FX/FX3/FX5 PID (FNC 88)", id: "mitsubishi_fx_pid", y: [0, 100], u: [0, 100] },
  { words: "labview", title: "NI LabVIEW PID / LabWindows PID toolkit", id: "labview_pid" },
];

test("from a record to the settings of three products, each read back as the controller that it is, and to code", async () => {
  await withPage("#/examples/tclab-step", {}, async (page) => {
    await page.waitForLoadState("networkidle");
    await page.getByRole("button", { name: "Tune at once" }).click();
    await designShown(page);
    for (const { words, title, id, y, u } of PRODUCTS) {
      await choose(page, words, title);
      assert.equal(await picker(page).getByRole("group", { name: /^Measurement range/ }).isVisible(), Boolean(y), title);
      if (y) await giveRange(page, /^Measurement range/, ...y);
      if (u) await giveRange(page, /^Output range/, ...u);
      await giveSampleTime(page, 1);
      const job = await designForMine(page);
      const spans = { ...(y ? { y_span: y } : {}), ...(u ? { u_span: u } : {}) };
      assert.deepEqual(job.request.implement, { product: id, ...spans, sample_time: 1 });
      const [entry] = job.result.controllers;
      await page.waitForFunction((text) => document.querySelector(".typed-card h2")?.textContent === text, `Type into ${title}`);
      await page.waitForFunction(
        (text) => document.querySelector("table.typed .value")?.textContent === text,
        Object.values(entry.as_entered.as_typed)[0],
      );

      // The list shows the service's settings, under the product's own labels.
      const product = await (await fetch(`${tests.service.base}/v1/controllers/${id}`)).json();
      const rows = await rowsOf(page);
      assert.deepEqual(
        rows,
        product.parameters
          .filter(({ name }) => name in entry.as_entered.as_typed)
          .map(({ name, label }) => [label, entry.as_entered.as_typed[name], entry.as_entered.units[name] ?? ""]),
      );

      // The typed settings represent that controller.
      const settings = Object.fromEntries(
        Object.entries(entry.as_entered.as_typed).map(([name, text]) => [name, valueOf(text)]),
      );
      const back = await post(`controllers/${id}/controller`, { settings, ...spans, sample_time: 1 });
      assert.equal(back.status, 200, JSON.stringify(back.body));
      for (const name of ["Kp", "Ti", "Td"])
        close(back.body.controller[name], entry.as_entered.realised[name], `${title} ${name}`);
      close(back.body.controller.filter.Tf ?? 0, entry.as_entered.realised.filter.Tf ?? 0, `${title} Tf`);

      // The implemented loop is next to the ideal one.
      await unfold(page, "How it computes them");
      const built = await typed(page).locator("table.built tbody tr").first().locator("td").allInnerTexts();
      assert.equal(Number(built[0]), Number(entry.robustness.Ms.toPrecision(3)));
      assert.equal(Number(built[1]), Number(entry.implemented.robustness.Ms.toPrecision(3)));
      await page.getByRole("heading", { name: `How ${title} computes` }).waitFor();
      assert.ok((await page.locator(".law-formulas math mfrac").count()) > 0, `${title} has a formula`);
    }

    const job = await jobOf(page);
    await page.getByText("Controller as code: Structured Text, C, Python").click();
    const text = page.getByRole("region", { name: "Source text" });
    for (const [tab, language, sign, file] of [
      ["Structured Text", "st", "FUNCTION_BLOCK", ".st"],
      ["C", "c", "#include", ".h"],
      ["Python", "python", "class ", ".py"],
    ]) {
      await page.getByRole("tab", { selected: true }).focus();
      if (language !== "st") await page.keyboard.press("ArrowRight");
      await page.getByRole("tab", { name: tab, selected: true }).waitFor();
      await text.getByText(sign).first().waitFor();
      const address = `${tests.service.base}/v1/jobs/${job.id}/controllers/0/code?language=${language}&sample_time=1&u_min=0&u_max=100`;
      assert.equal(await text.textContent(), await (await fetch(address)).text(), language);
      const [download] = await Promise.all([
        page.waitForEvent("download"),
        page.getByRole("button", { name: /^Download/ }).click(),
      ]);
      assert.ok(download.suggestedFilename().endsWith(file), download.suggestedFilename());
      assert.equal(readFileSync(await download.path(), "utf8"), await text.textContent());
    }
  });
});

test("next to settings in seconds, the notes of a loop in minutes say their unit", async () => {
  await withPage("#/new/fopdt?K=1.25&T=40&L=8", {}, async (page) => {
    await page.getByLabel("Time unit").fill("min");
    await page.getByRole("button", { name: "Tune this model" }).click();
    await designShown(page);
    await search(page).fill("arduino");
    await found(page).first().waitFor();
    await page.keyboard.press("Enter");
    await giveRange(page, /^Output range/, 0, 100);
    await unfold(page, "How it computes them");
    await typed(page).getByText("Times in these notes are in min, the loop's unit of time.").waitFor();
    assert.ok((await rowsOf(page)).some(([, , unit]) => unit === "s"));
  });
});

test("a list is searched by maker, name and parameter, with the keyboard alone", async () => {
  await withPage("", {}, async (page) => {
    await tuneModel(page);
    await search(page).focus();
    const { controllers } = await (await fetch(`${tests.service.base}/v1/controllers`)).json();
    await page.keyboard.press("ArrowDown");
    assert.equal(await found(page).count(), controllers.length + TEXTBOOK_FORMS.length);
    assert.deepEqual((await found(page).allInnerTexts()).slice(0, 3), TEXTBOOK_FORMS);
    assert.equal(await search(page).getAttribute("aria-expanded"), "true");
    await page.keyboard.type("rockwell pide");
    assert.deepEqual(
      (await found(page).locator("span:first-child").allInnerTexts()).map((text) => text.slice(0, 13)),
      ["Rockwell Logi", "Rockwell Logi"],
    );
    const active = () => search(page).getAttribute("aria-activedescendant");
    const first = await active();
    await page.keyboard.press("ArrowDown");
    assert.notEqual(await active(), first);
    assert.equal(await page.locator(`#${await active()}`).getAttribute("aria-selected"), "true");
    await page.keyboard.press("ArrowDown");
    assert.equal(await active(), first, "after the last comes the first");
    await page.keyboard.press("Escape");
    assert.equal(await search(page).getAttribute("aria-expanded"), "false");
    assert.equal(await search(page).inputValue(), TEXTBOOK_FORMS[0], "nothing is chosen by leaving");
    await page.keyboard.type("PBAND");
    await found(page).filter({ hasText: /^Foxboro/ }).waitFor();
    await search(page).fill("no such maker");
    await page.getByText('There is no entry "no such maker".').first().waitFor();
    await page.keyboard.press("Tab");
    assert.equal(await typed(page).count(), 0, "the ideal form is still chosen");
  });
});

test("a name that is not in the list stays, and says what is chosen instead", async () => {
  await withPage("#/new/fopdt?K=2&T=10&L=3", {}, async (page) => {
    await choose(page, "klipper", "Klipper heater (control: pid)");
    await search(page).fill("DeltaW");
    await search(page).press("Tab");
    assert.equal(await search(page).inputValue(), "DeltaW");
    await page.getByText('There is no controller "DeltaW" in the list. Klipper heater (control: pid) is still chosen').first().waitFor();
    await page.getByRole("button", { name: "Tune this model" }).click();
    await page.getByText("1 problem to fix").waitFor();
    await search(page).focus();
    await search(page).press("Escape");
    assert.equal(await search(page).inputValue(), "Klipper heater (control: pid)");
    await search(page).fill("");
    await search(page).press("Tab");
    await page.getByRole("button", { name: "Tune this model" }).click();
    await designShown(page);
    await search(page).fill("DeltaW");
    await search(page).press("Tab");
    assert.equal(await search(page).inputValue(), "DeltaW");
    await page.getByText('There is no controller "DeltaW" in the list. Ideal form: Kp, Ti, Td is still chosen').waitFor();
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("only what a product needs is asked for; it is remembered and sent with later designs, until it is taken back", async () => {
  await withPage("", {}, async (page) => {
    await tuneModel(page);
    await choose(page, "deltav standard", "Emerson DeltaV PID, FORM Standard");
    await page.getByText("Give the range of the measurement and the range of the output:", { exact: false }).waitFor();
    assert.equal(await settingsTyped(page).count(), 0);
    await giveRange(page, /^Measurement range/, 200, 0);
    const end = picker(page).getByRole("group", { name: /^Measurement range/ }).getByLabel("to");
    assert.equal(await end.getAttribute("aria-invalid"), "true");
    await giveRange(page, /^Measurement range/, 0, 200);
    assert.equal(await end.getAttribute("aria-invalid"), null);
    await giveRange(page, /^Output range/, 0, 100);
    await settingsTyped(page).first().waitFor();
    // Before a design for it, the settings are those of the ideal design.
    const [entry] = (await jobOf(page)).result.controllers;
    const asked = await post("controllers/emerson_deltav_standard/settings", {
      controller: { ...entry.controller, action: undefined },
      y_span: [0, 200],
      u_span: [0, 100],
    });
    assert.equal((await rowsOf(page))[0][1], asked.body.as_typed.GAIN);
    await unfold(page, "How it computes them");
    assert.ok((await typed(page).innerText()).includes("exact position of ALPHA in the Standard form"), "what is not verified is named");

    await page.getByRole("link", { name: "Start" }).click();
    assert.equal(await search(page).inputValue(), "Emerson DeltaV PID, FORM Standard");
    await page.reload();
    await page.getByRole("button", { name: "Tune this model" }).click();
    await designShown(page);
    assert.deepEqual((await jobOf(page)).request.implement, {
      product: "emerson_deltav_standard",
      y_span: [0, 200],
      u_span: [0, 100],
    });
    await typed(page).waitFor();
    await choose(page, "ideal form", TEXTBOOK_FORMS[0]);
    assert.equal(await typed(page).count(), 0);
    assert.equal((await designForMine(page, "Design for an ideal controller")).request.implement, undefined);
    await page.getByRole("link", { name: "Start" }).click();
    assert.equal(await search(page).inputValue(), "");
  });
});

test("a controller whose range is missing is not designed for, and it is said; a range that cannot be is refused", async () => {
  await withPage("", {}, async (page) => {
    await choose(page, "klipper", "Klipper heater (control: pid)");
    await page.getByText("Until then designs are made for an ideal controller.", { exact: false }).waitFor();
    await giveRange(page, /^Output range/, 1, "one");
    await page.getByRole("button", { name: "Tune this model" }).click();
    const summary = page.getByRole("group", { name: "Problems to fix" });
    await summary.getByRole("link", { name: /^Output range, to "one" is not a number/ }).click();
    const end = picker(page).getByRole("group", { name: /^Output range/ }).getByLabel("to");
    assert.ok(await end.evaluate((element) => element === document.activeElement));
    await end.fill("");
    await page.getByRole("button", { name: "Tune this model" }).click();
    await designShown(page);
    assert.equal((await jobOf(page)).request.implement, undefined);
    assert.equal(await settingsTyped(page).count(), 0, "no settings under a product's name that are not its own");
    await giveRange(page, /^Output range/, 0, 1);
    await settingsTyped(page).first().waitFor();
  });
});

test("a loop that its sampling makes unstable is said to be so, in the verdict too", async () => {
  await withPage("", {}, async (page) => {
    await tuneModel(page);
    await choose(page, "labview", "NI LabVIEW PID / LabWindows PID toolkit");
    await giveSampleTime(page, 60);
    await typed(page).getByText("The implemented loop is unstable", { exact: false }).waitFor();
    // A design for that sample time holds its limits again.
    const job = await designForMine(page);
    const [entry] = job.result.controllers;
    assert.ok(entry.implemented.robustness.stable && entry.implemented.robustness.Ms <= 1.4 * (1 + 1e-4));
    await page.getByRole("region", { name: "Verdict" }).getByText("On your controller Ms is", { exact: false }).waitFor();
  });
});

test("one value is copied as it is typed, all of them with their units", async () => {
  await withPage("", {}, async (page) => {
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"], { origin: tests.service.base });
    await tuneModel(page);
    await choose(page, "labview", "NI LabVIEW PID / LabWindows PID toolkit");
    await typed(page).waitFor();
    const rows = await rowsOf(page);
    const clipboard = () => page.evaluate(() => navigator.clipboard.readText());
    await typed(page).getByRole("button", { name: "Copy Ti", exact: true }).click();
    assert.equal(await clipboard(), rows.find(([label]) => label === "Ti")[1]);
    await typed(page).getByRole("button", { name: "Copy all with units" }).click();
    await typed(page).getByRole("button", { name: "Copied" }).last().waitFor();
    const lines = rows.map(([label, value, unit]) => `${label} = ${value}${unit ? ` ${unit}` : ""}`);
    assert.equal(await clipboard(), ["NI LabVIEW PID / LabWindows PID toolkit: robust", ...lines].join("\n"));
  });
});

test("today's settings are typed as the product names them, on Design and on Start", async () => {
  await withPage("", {}, async (page) => {
    await tuneModel(page);
    await choose(page, "foxboro", "Foxboro I/A Series PID block");
    await giveRange(page, /^Measurement range/, 0, 200);
    await giveRange(page, /^Output range/, 0, 100);
    await page.getByText("Today's settings in this controller").click();
    await picker(page).getByLabel("PBAND (%)", { exact: true }).fill("150");
    await picker(page).getByLabel("INT (min)", { exact: true }).fill("1,2");
    await picker(page).getByRole("button", { name: "Compare the design with these" }).click();
    await page.getByRole("button", { name: "today", exact: true }).waitFor();
    const today = { PBAND: 150, INT: 1.2 };
    let job = await jobOf(page);
    assert.deepEqual(job.request.baseline, {
      product: "foxboro_pid",
      settings: today,
      y_span: [0, 200],
      u_span: [0, 100],
    });
    const twin = await post("controllers/foxboro_pid/controller", { settings: today, y_span: [0, 200], u_span: [0, 100] });
    assert.equal(job.result.controllers.at(-1).method, "baseline");
    close(job.result.controllers.at(-1).controller.Ti, twin.body.controller.Ti, "Ti of today's settings");
    assert.equal(await picker(page).getByLabel("PBAND (%)", { exact: true }).inputValue(), "150");

    // They are still in the form on return, and are sent again.
    await page.getByRole("link", { name: "Change the request" }).click();
    const form = page.getByRole("region", { name: /^Today's settings/ });
    await form.getByLabel("PBAND (%)", { exact: true }).waitFor();
    assert.equal(await form.getByLabel("INT (min)", { exact: true }).inputValue(), "1.2");
    await form.getByLabel("PBAND (%)", { exact: true }).fill("120");
    await page.getByRole("button", { name: "Tune this model" }).click();
    await designShown(page);
    job = await jobOf(page);
    assert.deepEqual(job.request.baseline.settings, { PBAND: 120, INT: 1.2 });
  });
});

test("settings that are tried by hand are followed by what to type", async () => {
  const { examples } = await (await fetch(`${tests.service.base}/v1/examples`)).json();
  const title = examples.find((example) => example.id === "cstr-temperature").title;
  await withPage("", {}, async (page) => {
    await page.getByRole("button", { name: /^Tune: / }).first().waitFor();
    await page.locator(".examples details summary").click();
    await page.getByRole("button", { name: `Tune: ${title}`, exact: true }).click();
    await designShown(page);
    await page.getByRole("button", { name: "emulation", exact: true }).click();
    await choose(page, "labview", "NI LabVIEW PID / LabWindows PID toolkit");
    await typed(page).waitFor();
    const before = await rowsOf(page);
    await page.getByText("Try other settings").click();
    const slider = page.getByRole("slider", { name: "Kp, slider" });
    const answers = [];
    page.on("response", (response) => {
      if (response.url().endsWith("/v1/controllers/labview_pid/settings")) answers.push(response);
    });
    await slider.focus();
    for (let press = 0; press < 6; press += 1) await page.keyboard.press("Shift+ArrowRight");
    await typed(page).getByText("the manual controller", { exact: true }).waitFor();
    const kp = await page.locator(".by-hand").getByLabel("Kp", { exact: false }).first().inputValue();
    await page.waitForFunction(
      (value) => Math.abs(Number(document.querySelector("table.typed .value").textContent) / Number(value) - 1) < 2e-3,
      kp,
    );
    const last = await answers.at(-1).json();
    assert.equal((await rowsOf(page))[0][1], last.as_typed.Kc);
    await page.getByRole("button", { name: "Back to the optimum" }).click();
    await page.waitForFunction(
      (value) => document.querySelector("table.typed .value").textContent === value,
      before[0][1],
    );
  });
});

for (const [name, options] of WINDOWS) {
  test(`with a controller, on a ${name}: axe finds nothing, and nothing is wider than the window`, async () => {
    await withPage("", options, async (page) => {
      await tuneModel(page);
      await search(page).fill("siemens");
      await found(page).first().waitFor();
      assert.deepEqual(await accessibilityViolations(page), []);
      await choose(page, "pid_compact", "Siemens PID_Compact (S7-1200/1500)");
      await typed(page).waitFor();
      await page.getByText("Today's settings in this controller").click();
      await page.getByText("Controller as code: Structured Text, C, Python").click();
      await page.getByRole("region", { name: "Source text" }).getByText("FUNCTION_BLOCK").first().waitFor();
      assert.deepEqual(await accessibilityViolations(page), []);
      assert.ok((await overflow(page)) <= 0);
    });
  });
}
