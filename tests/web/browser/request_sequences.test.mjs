// Any actions in any order: the request that Design hands out gives the displayed design and verdict.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import { openDesign, PLANT } from "../design_page.mjs";
import { browserTests, dropFile, openMore, root } from "../harness.mjs";
import { assertRequestIsShown, designOnScreen, watchCalls } from "../shown_request.mjs";
import { stepTest } from "../step_record.mjs";

const { withPage, post } = browserTests();
const heater = readFileSync(path.join(root, "tests/data/records/tclab-step.csv"), "utf8");

/** Numbers of [0, 1) that a seed decides (Park and Miller 1988). */
function random(seed) {
  let state = seed;
  return () => (state = (16807 * state) % 2147483647) / 2147483647;
}

/** A search for a product over a region of plants takes tens of seconds on a busy machine. */
const LONG_SEARCH = 120_000;
const onDesign = (page) => page.locator(".settings tbody tr").first();
const start = (page) => page.getByRole("navigation", { name: "Screens" }).getByRole("link", { name: "Start" }).click();
const sliders = (page) => page.locator(".controls .field.slider:not([hidden])");

/** Actions; each returns whether it was possible. */
const ACTIONS = {
  async model(page) {
    await page.goto(new URL(PLANT, page.url()).href);
    await openDesign(page, true);
    return true;
  },
  async example(page, draw) {
    await start(page);
    const title = ["A heater that is not known exactly", "An inverse response"][draw(2)];
    const button = page.getByRole("button", { name: `Tune: ${title}` });
    if ((await button.count()) === 0) return false;
    if (!(await button.first().isVisible())) await page.locator(".examples summary").first().click();
    await button.first().click();
    await onDesign(page).waitFor({ timeout: LONG_SEARCH });
    return true;
  },
  async record(page, draw) {
    await start(page);
    await dropFile(page, ".drop", "record.csv", draw(2) ? heater : stepTest);
    await page.getByRole("button", { name: "Use and tune" }).click();
    await onDesign(page).waitFor({ timeout: LONG_SEARCH });
    return true;
  },
  async slider(page, draw) {
    const count = await sliders(page).count();
    if (count === 0) return false;
    const range = sliders(page).nth(draw(count)).locator("input[type=range]");
    if (!(await range.isVisible())) return false;
    await range.focus();
    for (let press = draw(3); press >= 0; press -= 1) await page.keyboard.press(draw(2) ? "ArrowRight" : "ArrowLeft");
    return true;
  },
  async typed(page, draw) {
    const field = page.locator(".controls").getByRole("textbox", { name: /^(Robustness Ms|Kp)/ }).nth(draw(2));
    if ((await field.count()) === 0 || !(await field.isVisible())) return false;
    const value = Number(await field.inputValue());
    await field.fill(String(Number((value * (0.97 + 0.02 * draw(4))).toPrecision(4))));
    await field.press("Enter");
    return true;
  },
  async undo(page) {
    const button = page.getByRole("button", { name: "Undo" });
    if (!(await button.isVisible()) || (await button.isDisabled())) return false;
    await button.click();
    return true;
  },
  async entry(page, draw) {
    const buttons = page.locator(".legend button");
    const count = await buttons.count();
    if (count < 2 || !(await buttons.first().isVisible())) return false;
    await buttons.nth(draw(count)).click();
    return true;
  },
  async keep(page) {
    const button = page.getByRole("button", { name: "Keep this design" });
    if (!(await button.isVisible())) return false;
    const before = await designOnScreen(page);
    const address = page.url();
    await button.click();
    await page.waitForFunction((was) => location.href !== was, address);
    return before;
  },
  async back(page) {
    await page.goBack();
    return true;
  },
  async reload(page) {
    await page.reload();
    return true;
  },
  async product(page) {
    await openMore(page);
    const search = page.getByRole("combobox", { name: "Maker and product" });
    await search.fill("simple-pid");
    await page.getByRole("listbox", { name: "Maker and product" }).getByRole("option").first().waitFor();
    await page.keyboard.press("Enter");
    const button = page.getByRole("button", { name: "Design for this controller" });
    if (!(await button.isVisible())) return false;
    const address = page.url();
    await button.click();
    await page.waitForFunction((was) => location.href !== was, address);
    return true;
  },
};
const BEGIN = ["model", "example", "record"];
const THEN = ["slider", "slider", "slider", "typed", "undo", "entry", "keep", "keep", "back", "reload", "product", "record"];

const SEEDS = (process.env.SEEDS ?? "11,12,13").split(",").map(Number);
const STEPS = Number(process.env.STEPS ?? 10);

for (const seed of SEEDS)
  test(`the request shown is what is on the screen, seed ${seed}`, { timeout: 600_000 }, async () => {
    await withPage("", {}, async (page) => {
      const settled = watchCalls(page);
      const next = random(seed);
      const draw = (below) => Math.floor(next() * below);
      const done = [];
      let checked = 0;
      for (let step = 0; step < STEPS; step += 1) {
        const there = await onDesign(page).isVisible();
        const name = there ? THEN[draw(THEN.length)] : BEGIN[draw(BEGIN.length)];
        const could = await ACTIONS[name](page, draw);
        if (!could) continue;
        done.push(name);
        await settled();
        if (!(await onDesign(page).isVisible())) continue;
        if (name === "keep") assert.deepEqual(await designOnScreen(page), could, done.join(", "));
        await assertRequestIsShown(page, post, done.join(", "));
        checked += 1;
      }
      assert.ok(checked > STEPS / 3, `${checked} of ${done.join(", ")} were looked at`);
    });
  });
