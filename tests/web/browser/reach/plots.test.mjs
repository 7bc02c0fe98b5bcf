// Plots in use: zoom, linked zoom, focus that moves nothing, and curves that are readable.
import assert from "node:assert/strict";
import test from "node:test";
import { browserTests } from "../../harness.mjs";

const { withPage } = browserTests();

const plot = (page, name) => page.getByRole("img", { name, exact: true });
const tickTexts = (of) => of.locator("text").allTextContents();

async function designOf(page) {
  await page.getByRole("button", { name: "Tune this model" }).click();
  await page.getByText("best PID").waitFor();
}

async function dragOver(page, of, from, to) {
  await of.scrollIntoViewIfNeeded();
  const box = await of.boundingBox();
  const at = ([x, y]) => [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at(from));
  await page.mouse.down();
  await page.mouse.move(...at(to), { steps: 4 });
  await page.mouse.up();
}

test("dragging zooms, equal axes stay equal, and Show all goes back", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=2", {}, async (page) => {
    await designOf(page);
    const nyquist = page.getByRole("img", { name: "Nyquist curve of L" });
    const circle = () => nyquist.locator("circle").first().getAttribute("r").then(Number);
    const before = await circle();
    await dragOver(page, nyquist, [0.4, 0.25], [0.8, 0.55]);
    assert.ok((await circle()) > 1.5 * before, "the circle grows with the zoom and stays a circle");
    await page.getByRole("button", { name: "Show all" }).click();
    assert.equal(await circle(), before);
  });
});

test("what is zoomed in time is zoomed in every response, y fits what is in view, and Show all shows all", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=2", {}, async (page) => {
    await designOf(page);
    const [setpoint, load] = [plot(page, "Set-point step"), plot(page, "Load step at the plant input")];
    const frequency = plot(page, "Sensitivities");
    const before = await Promise.all([setpoint, load, frequency].map(tickTexts));
    await dragOver(page, setpoint, [0.2, 0.3], [0.35, 0.31]);
    const zoomed = await Promise.all([setpoint, load, frequency].map(tickTexts));
    const last = (texts) => Number(texts.at(texts.findIndex((text) => text.startsWith("time")) - 2));
    assert.ok(last(zoomed[0]) < last(before[0]) / 2, String(zoomed[0]));
    assert.equal(last(zoomed[1]), last(zoomed[0]));
    assert.notDeepEqual(zoomed[1].slice(0, 4), before[1].slice(0, 4), "y of the other response fits what is in view");
    assert.deepEqual(zoomed[2], before[2]);
    await page.getByRole("button", { name: "Show all" }).first().click();
    assert.deepEqual(await Promise.all([setpoint, load].map(tickTexts)), before.slice(0, 2));
    await page.getByRole("button", { name: "Show all" }).first().waitFor({ state: "hidden" });
  });
});

test("focus and taps move nothing, and a tap leaves no ring", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=2", { width: 834, height: 1194, hasTouch: true }, async (page) => {
    await designOf(page);
    const places = () =>
      page.locator("main section, main .canvas").evaluateAll((all) =>
        all.flatMap((item) => {
          const { top, height } = item.getBoundingClientRect();
          return height > 0 ? [[Math.round(top + scrollY), Math.round(height)]] : [];
        }),
      );
    const before = await places();
    const setpoint = plot(page, "Set-point step");
    await setpoint.tap();
    assert.equal(await setpoint.evaluate((svg) => getComputedStyle(svg).outlineStyle), "none");
    assert.deepEqual(await places(), before);
    await page.keyboard.press("Tab");
    await page.keyboard.press("Shift+Tab");
    await page.keyboard.press("ArrowRight");
    await setpoint.evaluate((svg) => svg.focus());
    assert.deepEqual(await places(), before);
  });
});

test("a dead time's turns about the origin are no solid disc", async () => {
  await withPage("#/new/fopdt?K=2&T=10&L=3", {}, async (page) => {
    await designOf(page);
    const nyquist = plot(page, "Nyquist curve of L");
    const curve = nyquist.locator('path[stroke="var(--series-1)"]');
    const corners = (await curve.getAttribute("d")).split("L").length;
    assert.ok(corners < 300, `one turn of a small ring, and no more; ${corners} corners`);
    assert.equal(await nyquist.locator('circle[fill="var(--series-1)"]:not([stroke="var(--surface)"])').count(), 1);
    await nyquist.focus();
    const ring = nyquist.locator('circle[fill="var(--series-1)"]:not([stroke="var(--surface)"])');
    const radius = Number(await ring.getAttribute("r"));
    await page.keyboard.press("+");
    await page.keyboard.press("+");
    assert.ok(Number(await ring.getAttribute("r")) > 2 * radius);
  });
});
