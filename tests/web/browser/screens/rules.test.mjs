import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { accessibilityViolations, browserTests, dropFile, overflow, WINDOWS } from "../../harness.mjs";

const { withPage, post, jobOf } = browserTests();

/** Few problems: one source at one limit. */
const FEW = { structure: "pi", Ms: "1.6", family: "amigo/" };
const RULE = { Kp: "0.4/(Kv*L)", Ti: "min(T, 6*L)" };
const addressOf = (values) => `#/rules?${new URLSearchParams({ kind: "formula", ...FEW, ...values })}`;
const PROBLEMS = { structure: "pi", Ms: 1.6, name: "amigo/" };
const ONE = "amigo/lag-delay/1/pi/1.6";

const score = (page) => page.getByRole("region", { name: "Score", exact: true });
const table = (page) => page.getByRole("region", { name: "Score problem by problem" });
const names = (page) => table(page).locator("tbody th").allInnerTexts();
const answered = (page, holds = () => true) => page.waitForResponse((response) => response.url().endsWith("/v1/score") && holds(response.request().postDataJSON()));
/** The scored rule in the profile. */
const steps = (page) => page.getByRole("img", { name: "Performance profile" }).locator('path[stroke="var(--series-1)"]').first();
const three = (value) => String(Number(value.toPrecision(3)));

test("a rule as formulas: counts, ratios and the table are those of the service", async () => {
  await withPage(addressOf(RULE), {}, async (page) => {
    await score(page).getByRole("heading").waitFor();
    const answer = await post("v1/score", { tune: { method: "formula", ...RULE }, problems: PROBLEMS });
    assert.ok(answer.kept > 0 && answer.limits_broken > 0, JSON.stringify(answer.kept));
    const words = await score(page).innerText();
    assert.match(words, new RegExp(`hold on ${answer.kept} of ${answer.problems.length} problems`));
    for (const value of [answer.median_ratio, answer.worst_ratio, answer.range.tau_low]) assert.ok(words.includes(three(value)), `${value}: ${words}`);
    assert.deepEqual((await names(page)).sort(), answer.problems.map(({ name }) => name).sort());
    await steps(page).waitFor();
    const points = page.getByRole("img", { name: "Ratio over tau" }).locator("circle");
    assert.equal(await points.count(), answer.kept + answer.limits_broken);
    assert.equal(await page.title(), "Rules · Tunewright");
    assert.equal(await page.getByRole("link", { name: "Rules", exact: true }).getAttribute("aria-current"), "page");
  });
});

test("the table is sorted by its heads and filtered by result, with the keyboard; its CSV has what is shown", async () => {
  await withPage(addressOf(RULE), {}, async (page) => {
    await score(page).getByRole("heading").waitFor();
    const answer = await post("v1/score", { tune: { method: "formula", ...RULE }, problems: PROBLEMS });
    await table(page).getByRole("button", { name: "Ratio", exact: true }).focus();
    await page.keyboard.press("Enter");
    await page.keyboard.press("Enter");
    const falling = [...answer.problems].sort((a, b) => b.ratio - a.ratio).map(({ name }) => name);
    assert.deepEqual(await names(page), falling);
    assert.equal(await table(page).getByRole("columnheader", { name: "Ratio" }).getAttribute("aria-sort"), "descending");
    await page.getByLabel("Show", { exact: true }).selectOption("limits-broken");
    const broken = answer.problems.filter(({ status }) => status === "limits-broken").map(({ name }) => name);
    assert.deepEqual((await names(page)).sort(), broken.sort());
    const saved = page.waitForEvent("download");
    await page.getByRole("region", { name: "Problem by problem", exact: true }).getByRole("button", { name: "CSV" }).click();
    const lines = readFileSync(await (await saved).path(), "utf8").trim().split("\r\n");
    assert.equal(lines.length, broken.length + 1);
    assert.match(lines[0], /^problem,status,ratio,tau/);
  });
});

test("all rules are computed on demand with the same problems and stand in the profile; three of them are named", async () => {
  await withPage(addressOf(RULE), {}, async (page) => {
    await score(page).getByRole("heading").waitFor();
    const asked = [];
    page.on("request", (request) => request.url().endsWith("/v1/score") && asked.push(request.postDataJSON()));
    await page.getByRole("button", { name: /^Compare with \d+ rules$/ }).click();
    await page.getByRole("button", { name: "All rules are shown" }).waitFor();
    assert.ok(asked.length > 15 && asked.every(({ problems }) => JSON.stringify(problems) === JSON.stringify(asked[0].problems)));
    assert.deepEqual({ ...asked[0].problems }, PROBLEMS);
    assert.ok(!asked.some(({ tune }) => ["robust", "emulation", "npid_ise", "formula"].includes(tune.method)));
    const rules = page.getByRole("region", { name: "All rules" }).last();
    const simc = await post("v1/score", { tune: { method: "simc" }, problems: PROBLEMS });
    const row = rules.locator("tr").filter({ has: page.getByRole("link", { name: "SIMC (Skogestad)", exact: true }) });
    assert.equal(await row.locator("td").first().innerText(), String(simc.kept));
    assert.equal(await rules.getByRole("checkbox", { checked: true }).count(), 3);
    await row.getByRole("checkbox").check();
    await page.locator(".pane-legend").filter({ hasText: "SIMC" }).waitFor();
    assert.equal(await page.locator(".pane-legend span").filter({ hasText: /\w/ }).count(), 4);
    // The same problems again: nothing is computed twice.
    const before = asked.length;
    await page.getByLabel("Ti", { exact: true }).fill("T");
    await Promise.all([answered(page), page.getByLabel("Ti", { exact: true }).press("Enter")]);
    await page.getByRole("button", { name: "All rules are shown" }).waitFor();
    assert.ok(asked.length <= before + 2, asked.slice(before).map(({ tune }) => tune.method).join());
  });
});

test("settings as a file; a problem that the library does not have is told with its line, the score before stays", async () => {
  await withPage(
    addressOf(RULE),
    {},
    async (page) => {
      await score(page).getByRole("heading").waitFor();
      await page.getByRole("tab", { name: "Settings" }).click();
      await page.getByText(/The first line has no column/).waitFor();
      await dropFile(page, ".rule-form textarea", "mine.csv", `problem,Kp,Ti\n${ONE},0.4,1.05\n`);
      await page.getByRole("heading", { name: /the limits hold on [01] of 1 problem\./ }).waitFor();
      assert.match(page.url(), /settings=problem/);
      await page.getByLabel("Settings (CSV)").fill(`problem,Kp,Ti\n${ONE},0.4,1.05\nnobody,1,2\n`);
      await page.getByRole("button", { name: "Score", exact: true }).click();
      await page.locator(".field .error", { hasText: "Line 3:" }).waitFor();
      assert.equal(await page.getByLabel("Settings (CSV)").getAttribute("aria-invalid"), "true");
      await page.getByText("These results belong to the last answered request").waitFor();
    },
    ["422"],
  );
});

test("a formula that cannot be read is told; a link with a method and its option shows the same score", async () => {
  await withPage(
    addressOf({ Kp: "T/(2*K*" }),
    {},
    async (page) => {
      await page.getByText(/character 8/).first().waitFor();
      await page.evaluate((hash) => (location.hash = hash), `#/rules?${new URLSearchParams({ kind: "method", ...FEW, method: "simc", "option.tau_c": "2" })}`);
      const answer = await post("v1/score", { tune: { method: "simc", tau_c: 2 }, problems: PROBLEMS });
      await page.getByRole("heading", { name: `SIMC (Skogestad): the limits hold on ${answer.kept} of ${answer.problems.length} problems.` }).waitFor();
      assert.equal(await page.getByLabel("tau_c", { exact: false }).first().inputValue(), "2");
      await page.reload();
      await page.getByRole("heading", { name: `SIMC (Skogestad): the limits hold on ${answer.kept} of ${answer.problems.length} problems.` }).waitFor();
    },
    ["422"],
  );
});

test("a problem opens as a design within its limits, beside the scored settings; Back leads to the same rule", async () => {
  await withPage(addressOf(RULE), {}, async (page) => {
    await score(page).getByRole("heading").waitFor();
    await page.getByRole("button", { name: ONE, exact: true }).click();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    const { request, result } = await jobOf(page);
    const [robust, given] = result.controllers;
    assert.deepEqual([robust.method, robust.options.Ms, robust.options.Mt, robust.options.controller], ["robust", 1.6, 1.6, "PI"]);
    const answer = await post("v1/score", { tune: { method: "formula", ...RULE }, problems: { ...PROBLEMS, name: ONE } });
    assert.equal(given.controller.Kp, answer.problems[0].controller.Kp);
    assert.equal(request.name, ONE);
    await page.goBack();
    await score(page).getByRole("heading").waitFor();
    assert.equal(await page.getByLabel("Kp", { exact: true }).inputValue(), RULE.Kp);
  });
});

test("an optimum is proved on Design: bound and gap are those of the job, and the file is its certificate", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=2", {}, async (page) => {
    await page.getByRole("button", { name: "Tune this model" }).click();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    const card = page.getByRole("region", { name: "How much better could another be?" });
    await card.getByText("How much better could another be?").click();
    await card.getByLabel(/^Prove it to within/).fill("5");
    await card.getByRole("button", { name: "Prove it" }).click();
    await card.getByText(/^No P.*\(proved\)\.$/).waitFor();
    const { result } = await jobOf(page);
    const { certificate } = result.controllers[0];
    assert.equal(certificate.asked_gap, 0.05);
    const words = await card.innerText();
    assert.ok(words.includes(String(Number(certificate.lower.toPrecision(4)))), words);
    assert.ok(words.includes(`within ${Number((100 * certificate.gap).toPrecision(2))} %`), words);
    assert.deepEqual(await accessibilityViolations(page), []);
    const saved = page.waitForEvent("download");
    await card.getByRole("button", { name: "Certificate file" }).click();
    const [head, ...leaves] = readFileSync(await (await saved).path(), "utf8").trim().split("\n");
    assert.equal(JSON.parse(head).goal, certificate.lower);
    assert.equal(JSON.parse(head).leaves, leaves.length);
  });
});

for (const [window, options] of WINDOWS)
  test(`Rules fits and is accessible: ${window}`, async () => {
    await withPage(addressOf(RULE), options, async (page) => {
      await score(page).getByRole("heading").waitFor();
      await steps(page).waitFor();
      assert.equal(await overflow(page), 0);
      assert.deepEqual(await accessibilityViolations(page), []);
      for (const tab of ["Method", "Settings"]) {
        await page.getByRole("tab", { name: tab }).click();
        assert.equal(await overflow(page), 0, tab);
        assert.deepEqual(await accessibilityViolations(page), [], tab);
      }
    });
  });
