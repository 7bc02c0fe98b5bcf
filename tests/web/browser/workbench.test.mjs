// The adjustable design: sliders, the frontier, undo and redo, the address, a slow network and a busy service.
import assert from "node:assert/strict";
import test from "node:test";
import { designedBy, openDesign, PLANT, setting, shows, slider } from "../design_page.mjs";
import { browserTests, tracesShown } from "../harness.mjs";

const { withPage, jobOf } = browserTests();
const designAt = designedBy(jobOf);

/** Drags a slider's thumb from one fraction of its range to another. */
async function drag(page, target, from, to, steps, pause = 0) {
  const box = await target.boundingBox();
  const x = (share) => box.x + 8 + (box.width - 16) * share;
  await page.mouse.move(x(from), box.y + box.height / 2);
  await page.mouse.down();
  for (let step = 1; step <= steps; step += 1) {
    await page.mouse.move(x(from + ((to - from) * step) / steps), box.y + box.height / 2);
    if (pause > 0) await page.waitForTimeout(pause);
  }
}

test("the slider of Ms designs anew; undo, redo and the proposal lead back, the address and a reload bring it again", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page, true);
    const proposal = await setting(page, "Kp");
    await slider(page, "Robustness Ms").focus();
    for (let press = 0; press < 3; press += 1) await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Shift+ArrowRight");
    await page.waitForURL(/Ms=1\.53/);
    const wanted = await designAt(page, 1.53);
    await shows(page, "Kp", wanted.controller.Kp);
    await page.waitForFunction(() => /^Ms 1\.53, load IAE \d/.test(document.querySelector(".controls input[type=range]").getAttribute("aria-valuetext")));
    // The design, the proposal from which it was moved, and today's settings.
    await tracesShown(page, "Nyquist curve of L", 3);
    await page.getByText("proposal", { exact: true }).first().waitFor();
    await page.reload();
    await slider(page, "Robustness Ms").waitFor();
    await shows(page, "Kp", wanted.controller.Kp);
    await page.getByRole("button", { name: "Back to the proposal" }).click();
    await shows(page, "Kp", proposal);
    await tracesShown(page, "Nyquist curve of L", 2);
    assert.doesNotMatch(page.url(), /Ms=/);
    await page.keyboard.press("Control+z");
    await shows(page, "Kp", wanted.controller.Kp);
    await page.keyboard.press("Control+Shift+Z");
    await shows(page, "Kp", proposal);
  });
});

test("what a job hands out is the design on the screen: its request at once, its report when it is kept", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const report = page.getByRole("link", { name: "Report" });
    const request = page.locator("summary", { hasText: /^Request$/ });
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("Shift+ArrowRight");
    await page.waitForURL(/Ms=1\.5/);
    await report.waitFor({ state: "hidden" });
    await request.waitFor();
    const kept = await designAt(page, 1.5);
    await page.getByRole("button", { name: "Keep this design" }).click();
    await report.waitFor();
    await request.waitFor();
    const job = await jobOf(page);
    assert.deepEqual([job.request.tune[0].Ms, job.request.tune[0].Mt], [1.5, 1.5]);
    assert.ok(Math.abs(job.result.controllers[0].controller.Kp / kept.controller.Kp - 1) < 1e-9);
    assert.doesNotMatch(page.url(), /Ms=/);
    await shows(page, "Kp", kept.controller.Kp);

    const field = page.locator(".controls").getByRole("textbox", { name: "Kp" });
    await field.fill("4");
    await field.press("Enter");
    await page.getByText(/^Ms is 2\.\d+, above 1\.50?\. Report, change sheet and code still describe the job's design/).waitFor();
    await report.waitFor({ state: "hidden" });
    await page.getByRole("button", { name: "Keep these settings" }).waitFor();
    await page.getByRole("button", { name: "Back to the proposal" }).click();
    await report.waitFor();
  });
});

test("the sliders stand where they were left, after Back and by the header's link", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    await slider(page, "Robustness Ms").focus();
    await page.keyboard.press("Shift+ArrowRight");
    await page.waitForURL(/Ms=1\.5/);
    const { controller } = await designAt(page, 1.5);
    await shows(page, "Kp", controller.Kp);
    const screens = page.getByRole("navigation", { name: "Screens" });
    await screens.getByRole("link", { name: "Methods" }).click();
    await page.waitForURL(/methods/);
    await page.goBack();
    await slider(page, "Robustness Ms").waitFor();
    await shows(page, "Kp", controller.Kp);
    await screens.getByRole("link", { name: "Methods" }).click();
    await screens.getByRole("link", { name: "Design" }).click();
    await page.waitForURL(/Ms=1\.5/);
    await shows(page, "Kp", controller.Kp);
  });
});

test("a limit that the method does not take is reported at its field, and the address keeps the last good one", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const field = page.locator(".controls").getByRole("textbox", { name: "Robustness Ms" });
    await field.fill("0.9");
    await field.press("Enter");
    await page.getByText("Robustness Ms is 0.9; it must be above 1.").waitFor();
    assert.equal(await field.getAttribute("aria-invalid"), "true");
    assert.doesNotMatch(page.url(), /Ms=/);
  });
});

test("what is wrong with a typed value goes with the text", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const ms = page.getByRole("textbox", { name: "Robustness Ms" });
    const error = page.locator(`#${await ms.getAttribute("id")}-error`);
    await ms.fill("abc");
    await ms.press("Enter");
    await error.waitFor();
    await page.getByRole("slider", { name: "Robustness Ms, slider" }).press("ArrowRight");
    assert.equal(await error.isVisible(), false);
    assert.equal(await ms.getAttribute("aria-invalid"), null);
    await ms.fill("abc");
    await ms.press("Enter");
    await error.waitFor();
    await page.getByRole("button", { name: "Back to the proposal" }).click();
    await error.waitFor({ state: "hidden" });
    assert.equal(Number(await ms.inputValue()), 1.4);
  });
});

test("no number is cut off: fields of settings by hand, all figures next to today's", async () => {
  const cut = (list) =>
    list.filter((box) => box.scrollWidth > box.clientWidth).map((box) => box.value ?? box.getAttribute("aria-label"));
  // A gain with a sign, and times of a few thousandths.
  await withPage("#/new/fopdt?K=-0.8&T=6&L=0.05", {}, async (page) => {
    await openDesign(page, true);
    assert.ok((await page.locator(".controls").getByRole("textbox", { name: "Tf" }).last().inputValue()).length > 7);
    assert.deepEqual(await page.locator(".controls input[type=text]").evaluateAll(cut), []);
    await page.getByText("All figures", { exact: true }).click();
    assert.deepEqual(await page.locator(".figures-card .scroll").evaluateAll(cut), []);
  });
});

test("the focus stays at the sliders when a step has nothing left to do, and when a design is kept", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const press = async (name) => {
      await page.locator(".controls").getByRole("button", { name, exact: true }).focus();
      await page.keyboard.press("Enter");
    };
    const focused = () => page.evaluate(() => document.activeElement.ariaLabel ?? document.activeElement.textContent);
    const turn = () => slider(page, "Robustness Ms").press("ArrowRight");
    await turn();
    await press("Undo");
    assert.equal(await focused(), "Redo");
    await turn();
    await press("Back to the proposal");
    assert.equal(await focused(), "Undo");
    await turn();
    const before = page.url();
    await press("Keep this design");
    await page.waitForURL((url) => url.href.split("/design")[0] !== before.split("/design")[0]);
    await page.getByRole("button", { name: "Keep this design" }).waitFor({ state: "hidden" });
    assert.equal(await focused(), "Robustness Ms, slider");
  });
});

test("one undo takes back all the presses of a key, and two sliders are two steps", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    // As fast as a key repeats, also on a busy machine.
    await slider(page, "Robustness Ms").evaluate((range) => {
      for (let press = 0; press < 5; press += 1)
        range.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", shiftKey: true, bubbles: true, cancelable: true }));
    });
    await page.waitForURL(/Ms=1\.9/);
    await slider(page, "Kp").press("ArrowRight");
    await page.waitForURL(/Kp=/);
    const undo = page.getByRole("button", { name: "Undo" });
    await undo.click();
    await page.waitForURL((url) => /Ms=1\.9/.test(url.href) && !/Kp=/.test(url.href));
    await undo.click();
    await page.waitForURL((url) => !/Ms=/.test(url.href));
    assert.ok(await undo.isDisabled());
  });
});

test("a typed value that stands there already is no step, and nothing waits for it to be let go", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const report = page.getByRole("link", { name: "Report", exact: true });
    const undo = page.getByRole("button", { name: "Undo" });
    const field = page.locator(".controls").getByRole("textbox", { name: "Robustness Ms" });
    await field.fill("1,40");
    await field.press("Enter");
    await field.fill("1.5");
    await field.press("Enter");
    await page.waitForURL(/Ms=1\.5/);
    await undo.click();
    await report.waitFor();
    assert.ok(await undo.isDisabled(), "one step, not two");
    await field.fill("1,40");
    await field.press("Enter");
    assert.equal(await page.getByRole("button", { name: "Redo" }).isEnabled(), true);
    assert.ok(await report.isVisible());
  });
});

test("paper is light though the page is dark, and has no sliders", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    await page.evaluate(() => (document.documentElement.dataset.theme = "dark"));
    await page.emulateMedia({ media: "print" });
    const colour = await page.evaluate(() => getComputedStyle(document.body).color);
    assert.equal(colour, "rgb(23, 32, 42)");
    assert.equal(await page.locator(".controls").isVisible(), false);
  });
});

test("a gain by hand is evaluated as it stands, and typed values act when the field is left", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const field = page.locator(".controls").getByRole("textbox", { name: "Kp" });
    await field.fill("3");
    await field.press("Enter");
    await shows(page, "Kp", 3);
    const Ms = page.locator(".figures-card tr").filter({ has: page.getByRole("rowheader", { name: "Ms", exact: true }) });
    const { plant } = (await jobOf(page)).request;
    const values = new URLSearchParams(page.url().split("?")[1]);
    assert.equal(values.get("Kp"), "3");
    const answer = await page.request.post(`${new URL(page.url()).origin}/v1/evaluate`, {
      data: {
        plant,
        controllers: [
          {
            form: "ideal",
            Kp: 3,
            Ti: Number(values.get("Ti")),
            Td: Number(values.get("Td")),
            filter: { type: "measurement_second_order", Tf: Number(values.get("Tf")) },
          },
        ],
      },
    });
    const [entry] = (await answer.json()).controllers;
    assert.equal(Number(await Ms.locator("td").first().innerText()), Number(entry.robustness.Ms.toPrecision(3)));
  });
});

test("dragging draws all the time though every answer takes 60 ms, and is one step", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    await page.route("**/v1/design", async (route) => {
      await new Promise((resolve) => setTimeout(resolve, 60));
      await route.continue();
    });
    await page.evaluate(() => {
      globalThis.redraws = 0;
      const curve = document.querySelector(".main-column svg.canvas > g");
      new MutationObserver(() => (globalThis.redraws += 1)).observe(curve, { childList: true, subtree: true, attributes: true });
    });
    const started = Date.now();
    await drag(page, slider(page, "Robustness Ms"), 0.22, 0.8, 60, 16);
    const seconds = (Date.now() - started) / 1000;
    const redraws = await page.evaluate(() => globalThis.redraws);
    await page.mouse.up();
    assert.ok(redraws >= 5 && redraws / seconds >= 3, `${redraws} redraws while it was held for ${seconds} s`);
    console.log(`# ${(redraws / seconds).toFixed(1)} redraws a second with 60 ms of latency`);
    await page.getByRole("button", { name: "Undo" }).click();
    await page.waitForURL((url) => !/Ms=/.test(url.href));
    assert.ok(await page.getByRole("button", { name: "Undo" }).isDisabled(), "one step a drag");
  });
});

test("the point on the front is taken and moves the limit", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const plot = page.locator(".front section.plot");
    await plot.getByText("best PID").waitFor();
    await page.waitForFunction(() => [...document.querySelectorAll(".front svg.canvas path")].some((item) => (item.getAttribute("d").match(/L/g) ?? []).length > 20));
    // In one evaluation: the frontier is drawn again when its answers arrive.
    const box = await page.evaluate(() => [...document.querySelectorAll(".front svg.canvas circle")].at(-1).getBoundingClientRect().toJSON());
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + 60, box.y + 20, { steps: 8 });
    await page.mouse.up();
    await page.waitForURL(/Ms=1\.[5-9]|Ms=2/);
    const Ms = Number(/Ms=([\d.]+)/.exec(page.url())[1]);
    await shows(page, "Kp", (await designAt(page, Ms)).controller.Kp);
  });
});

test("what is wrong in a field is said when the button that was pressed on leaving it is let go", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page);
    const field = page.getByRole("textbox", { name: "Robustness Ms" });
    await field.fill("much");
    // The next thing below that can be pressed.
    const spot = await field.evaluate((input) => {
      const under = [...document.querySelectorAll(".controls button, .controls summary, .card button, .card summary")]
        .map((item) => [item, item.getBoundingClientRect()])
        .filter(([item, box]) => box.top > input.getBoundingClientRect().bottom && document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2) === item);
      const [next, box] = under.sort(([, a], [, b]) => a.top - b.top)[0];
      next.toggleAttribute("data-next");
      return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
    });
    const wrong = page.getByText('"much" is not a number');
    await page.mouse.move(spot.x, spot.y);
    await page.mouse.down();
    await page.waitForTimeout(100);
    assert.ok(await page.evaluate(({ x, y }) => document.elementFromPoint(x, y).closest("[data-next]") !== null, spot), "it has moved");
    assert.equal(await wrong.count(), 0);
    await page.mouse.up();
    await wrong.first().waitFor();
  });
});

test("a busy service keeps the last plots and says so; the design follows when it answers again", async () => {
  await withPage(
    PLANT,
    {},
    async (page) => {
      await openDesign(page);
      let busy = true;
      await page.route("**/v1/design", (route) =>
        busy
          ? route.fulfill({
              status: 429,
              headers: { "Retry-After": "1", "Content-Type": "application/problem+json" },
              body: JSON.stringify({ title: "Too many", status: 429, detail: "Too many computations are waiting." }),
            })
          : route.continue(),
      );
      await slider(page, "Robustness Ms").focus();
      await page.keyboard.press("PageUp");
      await page.locator(".controls .trouble").getByText("The last plots remain; trying again in 1 s.").waitFor();
      await tracesShown(page, "Nyquist curve of L", 1);
      busy = false;
      await page.locator(".controls .trouble").first().waitFor({ state: "hidden" });
      await shows(page, "Kp", (await designAt(page, 1.5)).controller.Kp);
    },
    ["429"],
  );
});

test("Design stands in one window of 1440 by 900 pixels", async () => {
  await withPage(PLANT, {}, async (page) => {
    await openDesign(page, true);
    await page.getByText("best PID").waitFor();
    assert.ok((await page.evaluate(() => document.documentElement.scrollHeight)) <= 900);
  });
});

test("on a phone the settings stand first, then the responses, and the sliders directly under them", async () => {
  await withPage(PLANT, { width: 390, height: 844 }, async (page) => {
    await openDesign(page);
    const top = async (locator) => (await locator.first().boundingBox()).y;
    const plot = (name) => page.locator(".main-column section.plot").filter({ hasText: name });
    const order = [
      await top(page.locator(".settings")),
      await top(page.locator(".verdict")),
      await top(plot("Set-point step")),
      await top(plot("Load step")),
      await top(page.locator(".controls")),
      await top(plot("Nyquist curve")),
      await top(page.locator(".front")),
    ];
    assert.deepEqual(order, [...order].sort((a, b) => a - b));
    assert.ok(order[0] < 250, `the settings begin at ${order[0]}`);

    const scrolled = await page.evaluate(() => window.scrollY);
    await slider(page, "Robustness Ms").scrollIntoViewIfNeeded();
    await slider(page, "Robustness Ms").focus();
    assert.ok(scrolled < (await page.evaluate(() => window.scrollY)), "the sliders lie below the first screen");
    const before = await top(slider(page, "Robustness Ms"));
    await page.keyboard.press("Shift+ArrowRight");
    await page.waitForURL(/Ms=1\.5/);
    const after = await top(slider(page, "Robustness Ms"));
    assert.ok(Math.abs(after - before) <= 1, `the slider stays where it is, although the verdict above it has other lines`);
    for (const name of ["Methods", "Start"]) {
      const link = page.getByRole("navigation", { name: "Screens" }).getByRole("link", { name });
      await link.click();
      await page.waitForFunction((wanted) => document.querySelector("nav a[aria-current]")?.textContent === wanted, name);
      await page.waitForTimeout(100);
      const { x, width } = await link.boundingBox();
      assert.ok(x >= 0 && x + width <= 390, `${name} stands from ${x} to ${x + width}`);
    }
  });
});
