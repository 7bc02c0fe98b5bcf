// The requested value for a set-point step and the value reached by the displayed design are shown next to each other
// if they differ.
import assert from "node:assert/strict";
import test from "node:test";
import { openDesign, PLANT, slider } from "../design_page.mjs";
import { browserTests, openMore } from "../harness.mjs";
import { assertRequestIsShown, watchCalls } from "../shown_request.mjs";

const { withPage, jobOf, post } = browserTests();

const OVERSHOOT = "Set-point overshoot";
const lagged = { type: "fopdt", K: 1, T: 100, L: 30 };

const field = (page, name = OVERSHOOT) => page.locator(".controls").getByRole("textbox", { name });
const beside = (page, name = OVERSHOOT) => page.locator(".controls .slider").filter({ has: page.getByRole("textbox", { name }) }).locator(".reached");
const three = (value) => Number(value.toPrecision(3));

/** The number next to a slider; null if there is none. */
async function reached(page, name) {
  const text = await beside(page, name).textContent();
  if (text === "") return null;
  return Number(/^reached (\S+)/.exec(text)[1]);
}

/** The overshoot of the implemented loop. */
const overshootOf = ({ implemented, performance }) => (implemented?.performance ?? performance).setpoint.overshoot_percent;

/** The text next to the slider is that of the answer, or empty if the answer has the requested value. */
async function assertBeside(page, entry, asked) {
  const percent = three(overshootOf(entry));
  assert.equal(await reached(page), asked !== null && percent === three(asked) ? null : percent);
}

const askedOf = async (page, action) => {
  const [response] = await Promise.all([
    page.waitForResponse((answer) => /\/v1\/(design|evaluate)$/.test(answer.url()) && answer.status() === 200),
    action(),
  ]);
  return (await response.json()).controllers[0];
};

for (const [product, more] of [
  ["klipper", {}],
  ["marlin", { sample_time: 1 }],
  ["esphome_pid", { sample_time: 1 }],
]) {
  test(`a firmware without a set-point filter, ${product}: the overshoot asked, the one reached, and one lag that keeps it`, async () => {
    await withPage("", {}, async (page) => {
      const settled = watchCalls(page);
      const { id, result } = await post("v1/jobs", {
        plant: lagged,
        tune: [{ method: "robust", Ms: 1.6, Mt: 1.6 }],
        implement: { product, u_span: [0, 100], ...more },
      });
      const [entry] = result.controllers;
      const { figures } = entry.verdict.find(({ code }) => code === "overshoot");
      assert.ok(overshootOf(entry) > 15, `${overshootOf(entry)} %`);
      assert.equal(figures.overshoot_percent, overshootOf(entry));
      await page.goto(new URL(`#/jobs/${id}/design`, page.url()).href);
      await slider(page, OVERSHOOT).waitFor();
      await settled();
      assert.equal(await field(page).inputValue(), "5");
      await assertBeside(page, entry, 5);
      assert.ok(await beside(page).evaluate((span) => span.classList.contains("missed")));
      assert.match(await slider(page, OVERSHOOT).getAttribute("aria-valuetext"), new RegExp(`reached ${three(overshootOf(entry))}`));

      // Page, report and code use one lag: the verdict's, which the firmware does not have.
      const lag = String(three(figures.setpoint_lag));
      await openMore(page);
      const lags = (text) => [...text.matchAll(/lag of (\S+) s|1\/\(1 \+ (\S+) s\)|Set-point filter\D*(\d\S*)/g)].map((found) => found[1] ?? found[2] ?? found[3]);
      assert.deepEqual([...new Set(lags(await page.locator("main").innerText()))], [lag]);
      const job = `v1/jobs/${id}`;
      const report = await (await page.request.get(new URL(`${job}/report.html`, page.url()).href)).text();
      assert.deepEqual([...new Set(lags(report.replaceAll(/<[^>]*>/g, " ")))], [lag]);
      const row = /Overshoot \(%\), limit:\s+(\S+)\s+(\S+)\s+(\S+)/.exec(report.replaceAll(/<[^>]*>/g, " "));
      const both = [entry.performance, entry.implemented.performance].map(({ setpoint }) => Number(setpoint.overshoot_percent.toPrecision(4)));
      assert.deepEqual(row.slice(1).map(Number), [5, ...both]);
      for (const language of ["st", "c", "python"]) {
        const code = await page.request.get(new URL(`${job}/controllers/0/code?language=${language}`, page.url()).href);
        assert.equal(code.status(), 200);
        assert.doesNotMatch(await code.text(), /setpoint_f\b|\bTr\b/, `${language} has a filter that the firmware has not`);
      }

      // After a move: another limit is requested, and the value reached is that of the new answer.
      const modified = await askedOf(page, async () => {
        await field(page).fill("12");
        await field(page).press("Enter");
      });
      await settled();
      assert.equal(modified.options.setpoint.overshoot, 12);
      await assertBeside(page, modified, 12);
      await assertRequestIsShown(page, post, product);
    });
  });
}

test("the ideal design typed into a firmware: the implemented loop has its own overshoot in the table, and one lag is named", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    await page.evaluate(() =>
      localStorage.setItem(
        "tunewright-controller",
        JSON.stringify({ product: "klipper", name: "Klipper", needs: ["u_span"], u_span: [0, 100] }),
      ),
    );
    const request = { plant: lagged, tune: [{ method: "robust", Ms: 1.6, Mt: 1.6 }] };
    const { id, result } = await post("v1/jobs", request);
    const [{ controller, performance }] = result.controllers;
    await page.goto(new URL(`#/jobs/${id}/design`, page.url()).href);
    await page.reload();
    await slider(page, OVERSHOOT).waitFor();
    await settled();
    await openMore(page);
    const { controllers } = await post("v1/evaluate", {
      plant: lagged,
      controllers: [controller],
      implement: { product: "klipper", u_span: [0, 100] },
    });
    await page.getByText("How it computes them").click();
    const cells = await page.locator("table.built tr", { hasText: "Overshoot" }).locator("td").allInnerTexts();
    const built = overshootOf(controllers[0]);
    const ideal = performance.setpoint.overshoot_percent;
    assert.ok(built > 20 && ideal < 5.05, `${ideal} %, implemented ${built} %`);
    assert.deepEqual(cells.slice(0, 2).map(Number), [three(ideal), three(built)]);
    assert.ok(Math.abs(Number(cells[2]) - (built - ideal)) < 0.06, cells[2]);
    const lag = three(controller.setpoint_filter.T);
    const note = controllers[0].as_entered.notes.find(({ code }) => code === "setpoint-filter");
    assert.equal(three(Number(/([\d.]+) s\)/.exec(note.detail)[1])), lag);
    await page.getByText(note.detail).waitFor();
    assert.equal(await page.getByText(/lag of [\d.]+ s/).count(), 0, "no second lag");
  });
});

test("while the slider is held, what is reached follows each answer", async () => {
  await withPage(PLANT, {}, async (page) => {
    const settled = watchCalls(page);
    await openDesign(page);
    await settled();
    const { result } = await jobOf(page);
    await assertBeside(page, result.controllers[0], result.controllers[0].options.setpoint.overshoot);
    const hold = (share) =>
      slider(page, OVERSHOOT).evaluate((input, at) => {
        input.value = String(Math.round(at * Number(input.max)));
        input.dispatchEvent(new Event("input", { bubbles: true }));
      }, share);
    for (const share of [0.25, 1]) {
      await hold(share);
      await settled();
      const asked = 40 * share;
      const { controllers } = await post("v1/design", {
        plant: { type: "fopdt", K: 1.25, T: 40, L: 8 },
        tune: [{ ...result.controllers[0].options, method: "robust", setpoint: { overshoot: asked } }],
      });
      const percent = three(overshootOf(controllers[0]));
      await page.waitForFunction(
        ([text, same]) => {
          const shown = [...document.querySelectorAll(".controls .slider .reached")]
            .filter((span) => span.closest(".slider").textContent.startsWith("Set-point overshoot"))
            .map((span) => span.textContent);
          return same ? shown.every((one) => one === "") : shown.some((one) => Number(/reached (\S+)/.exec(one)?.[1]) === text);
        },
        [percent, percent === asked],
      );
      if (share === 1) assert.ok(percent < 39, `${percent} % is as much as this loop has`);
      assert.equal(await beside(page).evaluate((span) => span.classList.contains("missed")), false);
    }
  });
});

test("an integral time by hand keeps to no overshoot: what it reaches stands next to what was asked of the design", async () => {
  await withPage(PLANT, {}, async (page) => {
    const settled = watchCalls(page);
    await openDesign(page);
    await settled();
    const entry = await askedOf(page, async () => {
      await field(page, "Ti").fill("10");
      await field(page, "Ti").press("Enter");
    });
    await settled();
    assert.ok(overshootOf(entry) > 10, `${overshootOf(entry)} %`);
    assert.equal(await field(page).inputValue(), "5");
    await assertBeside(page, entry, 5);
    await page.getByRole("button", { name: "Back to the proposal" }).click();
    await settled();
    const { result } = await jobOf(page);
    await assertBeside(page, result.controllers[0], 5);
  });
});

test("a request without a limit on the overshoot is given none by its slider", async () => {
  await withPage("", {}, async (page) => {
    const settled = watchCalls(page);
    const { id, result } = await post("v1/jobs", {
      plant: lagged,
      tune: [{ method: "robust", Ms: 1.6, Mt: 1.6, setpoint: { best: "iae" } }],
    });
    await page.goto(new URL(`#/jobs/${id}/design`, page.url()).href);
    await slider(page, OVERSHOOT).waitFor();
    await settled();
    assert.equal(await field(page).inputValue(), "");
    await assertBeside(page, result.controllers[0], null);
    const Ms = field(page, "Robustness Ms");
    await Ms.fill("1.7");
    await Ms.press("Enter");
    await settled();
    assert.equal(await field(page).inputValue(), "");
    const { request } = await assertRequestIsShown(page, post, "best");
    assert.deepEqual(request.tune[0].setpoint, { best: "iae" });
  });
});

for (const product of ["openplc_iec_pid", "foxboro_pid", "emerson_deltav_series"]) {
  test(`a filter that the block ${product} fixes, or ties to something else: the ratio asked and the one reached`, async () => {
    await withPage("", {}, async (page) => {
      const settled = watchCalls(page);
      const { id, result } = await post("v1/jobs", {
        plant: lagged,
        tune: [{ method: "robust", Ms: 1.6, Mt: 1.6, filter: { Tf_over_Td: 0.3 } }],
        implement: { product, y_span: [0, 300], u_span: [0, 100], sample_time: 1 },
      });
      await page.goto(new URL(`#/jobs/${id}/design`, page.url()).href);
      await slider(page, "Noise filter Tf/Td").waitFor();
      await settled();
      const { filter, Td } = result.controllers[0].controller;
      assert.ok(Math.abs(filter.Tf / Td - 0.3) > 0.05, `${filter.Tf / Td}`);
      assert.equal(await field(page, "Noise filter Tf/Td").inputValue(), "0.3");
      assert.equal(await reached(page, "Noise filter Tf/Td"), three(filter.Tf / Td));
    });
  });
}
