import assert from "node:assert/strict";
import test from "node:test";
import { accessibilityViolations, browserTests, overflow, tracesShown, WINDOWS } from "../harness.mjs";

const { withPage, jobOf } = browserTests();

/** Tunes the plant by robust and rimc, and shows rimc. */
async function showRimc(page) {
  await page.getByText(/^Compare with/).click();
  await page.getByRole("checkbox", { name: /rimc$/ }).check();
  await page.getByRole("button", { name: "Tune this model" }).click();
  await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
  await page.getByRole("button", { name: "rimc", exact: true }).click();
  await page.getByRole("heading", { name: "Effect of λ: load peak and Ms" }).waitFor();
}

const card = (page) => page.getByRole("region", { name: "Revised IMC: speed against robustness" });
const cell = async (page, label, column = 0) =>
  Number(
    (await card(page).locator("tr").filter({ hasText: label }).first().locator("td").nth(column).innerText()).replace(
      "−",
      "-",
    ),
  );
const shown = (value) => Number(Number(value).toPrecision(3));

test("the chart shows the curve of this plant with the design on it, and its figures", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=2", {}, async (page) => {
    await showRimc(page);
    const { result } = await jobOf(page);
    const { rimc } = result.controllers[1];
    await tracesShown(page, "Effect of λ: load peak and Ms", 2);
    assert.equal(await cell(page, "Ms"), shown(rimc.Ms));
    assert.equal(await cell(page, "Load peak"), shown(rimc.disturbance_peak));
    assert.equal(await cell(page, "Dead time error"), shown(rimc.dead_time_error));
    const labels = await page
      .getByRole("img", { name: "Effect of λ: load peak and Ms" })
      .locator("text")
      .allTextContents();
    assert.ok(labels.includes(`Ms ${Number(rimc.Ms).toPrecision(3)}`), labels.join());
    // For another method there is no such card.
    await page.getByRole("button", { name: "robust", exact: true }).click();
    await card(page).waitFor({ state: "hidden" });
  });
});

test("the slider shows what a lambda would buy while it moves, and designs it when it is let go", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=2", {}, async (page) => {
    await showRimc(page);
    const before = await jobOf(page);
    const slider = page.getByRole("slider", { name: "λ, slider" });
    assert.match(await slider.getAttribute("aria-valuetext"), /^lambda 10\.0 s, Ms 1\.\d\d$/);
    const tuned = page.waitForResponse((response) => response.request().postData()?.includes("lambda"));
    await slider.focus();
    await page.keyboard.press("Shift+ArrowLeft");
    await tuned;
    await page.waitForFunction((id) => !location.hash.includes(id), before.id);
    const after = await jobOf(page);
    const [old, next] = [before, after].map((job) => job.result.controllers[1].rimc);
    assert.ok(next.lambda < old.lambda && next.Ms > old.Ms && next.disturbance_peak < old.disturbance_peak);
    assert.deepEqual(after.request.tune[0], before.request.tune[0]);
    await page.waitForFunction(
      (Ms) => [...document.querySelectorAll(".rimc td")].some((item) => item.textContent === Ms),
      Number(next.Ms).toPrecision(3),
    );
    // The slider keeps its focus, and the settings are those of the new design.
    assert.ok(await slider.evaluate((element) => element === document.activeElement));
    await page.getByRole("heading", { name: "Settings to enter: rimc" }).waitFor();
    const Kp = await page.locator(".settings td.value").first().innerText();
    assert.equal(Number(Kp), Number(Number(after.result.controllers[1].controller.Kp).toPrecision(5)));
  });
});

test("of several steps in a row the last is shown and kept, however late the other answers come", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=2", {}, async (page) => {
    await showRimc(page);
    const slider = page.getByRole("slider", { name: "λ, slider" });
    const posted = [];
    await page.route("**/v1/jobs", async (route) => {
      posted.push(route.request().postDataJSON().tune[1].lambda);
      await new Promise((resolve) => setTimeout(resolve, posted.length === 2 ? 900 : 300));
      await route.continue();
    });
    await slider.focus();
    for (let press = 1; press <= 3; press += 1) {
      await page.keyboard.press("ArrowRight");
      for (let look = 0; look < 100 && posted.length < press; look += 1) await page.waitForTimeout(10);
    }
    assert.ok(posted[0] < posted[1] && posted[1] < posted[2], posted.join());
    const last = String(posted[2]);
    for (let look = 0; look < 100; look += 1) {
      if ((await jobOf(page)).request.tune[1].lambda === posted[2]) break;
      await page.waitForTimeout(50);
    }
    assert.equal((await jobOf(page)).request.tune[1].lambda, posted[2]);
    assert.equal(await page.getByLabel("λ (s)", { exact: true }).inputValue(), last);
  });
});

test("the full controller stands next to its PID, in figures and in its load response", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=2", {}, async (page) => {
    // In the form of the service's answer, with arbitrary figures.
    await page.route("**/v1/jobs/*", async (route) => {
      const reply = await route.fetch();
      if (reply.status() !== 200) return route.fulfill({ response: reply });
      const job = await reply.json();
      const entry = job.result?.controllers?.[1];
      if (entry?.rimc) {
        const { t, y, u } = entry.responses.load;
        entry.rimc.full_controller = {
          robustness: { stable: true, Ms: 1.23 },
          load: { peak: 0.321, IAE: 9.87 },
          responses: { load: { t, y: y.map((value) => 0.9 * value), u } },
        };
      }
      await route.fulfill({ response: reply, json: job });
    });
    await showRimc(page);
    assert.deepEqual(
      [await cell(page, "Ms", 1), await cell(page, "Load peak", 1), await cell(page, "Load IAE", 1)],
      [1.23, 0.321, 9.87],
    );
    await tracesShown(page, "Load step: PID and full controller", 4);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("a lambda out of reach is refused in the service's words, and the design stays", async () => {
  await withPage(
    "#/new/fopdt?K=1&T=10&L=2",
    {},
    async (page) => {
      await showRimc(page);
      const before = await jobOf(page);
      await page.getByLabel("λ (s)", { exact: true }).fill("-3");
      await page.keyboard.press("Enter");
      await page.getByText("λ is -3; it must be above 0.").waitFor();
      const answer = page.waitForResponse((response) => response.request().postData()?.includes("lambda"));
      await page.getByLabel("λ (s)", { exact: true }).fill("4000");
      await page.keyboard.press("Enter");
      const { result } = await (await answer).json();
      assert.ok(result.controllers[1].error, "lambda beyond the branch has no design");
      await card(page).getByText(result.controllers[1].error.detail).waitFor();
      assert.equal(await page.getByLabel("λ (s)", { exact: true }).inputValue(), "10");
      assert.equal((await jobOf(page)).id, before.id);
    },
    ["422"],
  );
});

for (const [name, options] of WINDOWS) {
  test(`revised IMC on a ${name}: axe finds nothing, and nothing is wider than the window`, async () => {
    await withPage("#/new/fopdt?K=1&T=10&L=2", options, async (page) => {
      await showRimc(page);
      assert.deepEqual(await accessibilityViolations(page), []);
      assert.equal(await overflow(page), 0);
    });
  });
}
