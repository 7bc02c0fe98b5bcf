// The Nyquist curve and the peak of a response are dragged: the slider of the method follows, with its undo. Plots are
// enlarged over the window, and back.
import assert from "node:assert/strict";
import test from "node:test";
import { openDesign, PLANT, slider } from "../../design_page.mjs";
import { accessibilityViolations, browserTests, overflow, WINDOWS } from "../../harness.mjs";

const tests = browserTests();
const { withPage } = tests;

const plot = (page, title) => page.locator("section.plot").filter({ has: page.getByRole("heading", { name: title, exact: true }) });
const msNow = async (page) => Number(/[\d.]+/.exec(await slider(page, "Robustness Ms").getAttribute("aria-valuetext"))[0]);

/** The centre of a plot's handle, on the screen. */
async function handleOf(page, title) {
  const circle = plot(page, title).locator('svg.canvas circle[r="7"]');
  await circle.scrollIntoViewIfNeeded();
  const box = await circle.boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}

async function dragBy(page, from, dx, dy) {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let step = 1; step <= 8; step += 1) await page.mouse.move(from.x + (dx * step) / 8, from.y + (dy * step) / 8);
  await page.waitForTimeout(500);
  await page.mouse.move(from.x + dx, from.y + dy);
  await page.mouse.up();
}

test("the Nyquist curve dragged toward −1 raises Ms as a step of its slider; undo goes back", async () => {
  await withPage(PLANT, { height: 1400 }, async (page) => {
    await openDesign(page);
    const before = await msNow(page);
    const handle = await handleOf(page, "Nyquist curve of L");
    const minus = plot(page, "Nyquist curve of L").getByText("−1", { exact: true }).last();
    await minus.waitFor({ state: "attached" });
    // The distance of the handle from −1 is 1/Ms: halfway there is twice Ms, more than the slider allows.
    await dragBy(page, handle, -14, 8);
    const after = await msNow(page);
    assert.ok(after > before + 0.05, `${before} -> ${after}`);
    await page.waitForURL(/[?&]Ms=/);
    await page.keyboard.press("Control+z");
    await page.waitForFunction(() => !/[?&]Ms=/.test(location.hash));
    assert.equal(await msNow(page), before);
    const other = await handleOf(page, "Nyquist curve of L");
    await dragBy(page, other, 12, -8);
    assert.ok((await msNow(page)) < before, "away from −1 Ms falls");
  });
});

test("nothing moves under the pointer while a curve is dragged", async () => {
  await withPage("", {}, async (page) => {
    // A long name, whose remark on the settings needs another line.
    const plant = { type: "transfer_function", num: [1], den: [1, 4, 6, 4, 1] };
    const { id } = await tests.post("v1/jobs", { plant, tune: [{ method: "all" }] });
    await page.goto(`${tests.service.base}/#/jobs/${id}/design`);
    await slider(page, "Robustness Ms").waitFor();
    const handle = await handleOf(page, "Nyquist curve of L");
    const top = async () => (await plot(page, "Nyquist curve of L").locator("svg.canvas").boundingBox()).y;
    const before = await top();
    await page.mouse.move(handle.x, handle.y);
    await page.mouse.down();
    for (let step = 1; step <= 4; step += 1) {
      await page.mouse.move(handle.x - 2 * step, handle.y + step);
      await page.locator(".whose", { hasText: "moved by the sliders" }).waitFor();
      assert.equal(await top(), before, `after ${step} moves`);
    }
    await page.mouse.up();
    await page.waitForURL(/[?&]Ms=/);
  });
});

for (const [title, dy, moved] of [
  ["Set-point step", -9, /overshoot=/],
  ["Load step at the plant input", -9, /[?&]Ms=/],
])
  test(`the peak of the ${title} is dragged, and the slider of the method follows, as one step`, async () => {
    await withPage(PLANT, { height: 1400 }, async (page) => {
      await openDesign(page);
      await dragBy(page, await handleOf(page, title), 0, dy);
      await page.waitForURL(moved);
      await page.keyboard.press("Control+z");
      await page.waitForFunction(() => !location.hash.includes("?"));
    });
  });

/** One finger: as the mouse, but the browser may take its movement for scrolling. */
/** `held`: before the finger is lifted. */
async function swipe(page, from, dx, dy, held = async () => undefined) {
  const client = await page.context().newCDPSession(page);
  const touch = (type, touchPoints) => client.send("Input.dispatchTouchEvent", { type, touchPoints });
  await touch("touchStart", [from]);
  for (let step = 1; step <= 12; step += 1) await touch("touchMove", [{ x: from.x + (dx * step) / 12, y: from.y + (dy * step) / 12 }]);
  await held();
  await touch("touchEnd", []);
  await client.detach();
}

const scrolled = (page) => page.evaluate(() => document.scrollingElement.scrollTop);

for (const [title, dx, dy, moved] of [
  ["Nyquist curve of L", -14, 8, /[?&]Ms=/],
  ["Set-point step", 0, -12, /overshoot=/],
  ["Load step at the plant input", 0, -12, /[?&]Ms=/],
])
  test(`by touch the ${title} is dragged at its handle, and the page scrolls elsewhere`, async () => {
    await withPage(PLANT, { width: 800, height: 1100, hasTouch: true }, async (page) => {
      await openDesign(page);
      const handle = await handleOf(page, title);
      const before = await scrolled(page);
      // On release a line may appear above the plot, for which the browser makes up.
      await swipe(page, handle, dx, dy, async () => assert.equal(await scrolled(page), before, "the page stays while a handle is dragged"));
      await page.waitForURL(moved);
      await page.getByRole("button", { name: "Undo" }).click();
      await page.waitForFunction(() => !location.hash.includes("?"));
      const canvas = plot(page, title).locator("svg.canvas");
      await canvas.evaluate((element) => element.scrollIntoView({ block: "center" }));
      const box = await canvas.boundingBox();
      const start = await scrolled(page);
      await swipe(page, { x: box.x + box.width - 4, y: box.y + box.height - 4 }, 0, -150);
      await page.waitForFunction((from) => document.scrollingElement.scrollTop !== from, start);
      assert.ok(!page.url().includes("?"), "nothing was dragged");
    });
  });

test("elsewhere on the plot a drag still zooms, and a fixed rule has no handle", async () => {
  await withPage(PLANT, { height: 1400 }, async (page) => {
    await page.getByText(/^Compare with/).click();
    await openDesign(page);
    const box = await plot(page, "Nyquist curve of L").locator("svg.canvas").boundingBox();
    await page.mouse.move(box.x + 90, box.y + 30);
    await page.mouse.down();
    await page.mouse.move(box.x + 140, box.y + 60, { steps: 4 });
    await page.mouse.up();
    await plot(page, "Nyquist curve of L").getByRole("button", { name: "Show all" }).waitFor();
  });
});

for (const [window, options] of WINDOWS)
  test(`a plot is enlarged by its button or F, keeps its zoom, and Escape goes back: ${window}`, async () => {
    await withPage(PLANT, options, async (page) => {
      await openDesign(page);
      const nyquist = plot(page, "Nyquist curve of L");
      const canvas = nyquist.locator("svg.canvas");
      await canvas.focus();
      await page.keyboard.press("+");
      await nyquist.getByRole("button", { name: "Show all" }).waitFor();
      const small = await canvas.boundingBox();
      await page.keyboard.press("f");
      const dialog = page.getByRole("dialog", { name: "Nyquist curve of L" });
      await dialog.waitFor();
      await page.waitForFunction((height) => document.querySelector("dialog.enlarged svg.canvas").getBoundingClientRect().height > height, small.height * 1.2);
      assert.equal(await nyquist.getByRole("button", { name: "Show all" }).count(), 1);
      assert.equal(await overflow(page), 0);
      assert.deepEqual(await accessibilityViolations(page), []);
      await page.keyboard.press("Escape");
      await dialog.waitFor({ state: "hidden" });
      assert.equal(await page.evaluate(() => document.activeElement.classList.contains("canvas")), true);
      await nyquist.getByRole("button", { name: /^Enlarge/ }).click();
      await dialog.waitFor();
      await dialog.getByRole("button", { name: "Close" }).click();
      await dialog.waitFor({ state: "hidden" });
    });
  });
