import assert from "node:assert/strict";
import test from "node:test";
import { accessibilityViolations, browserTests, overflow, tracesShown, WINDOWS } from "../../harness.mjs";

const { withPage } = browserTests();

const simulated = (page) =>
  page.waitForResponse((response) => response.url().endsWith("/v1/experiments/relay") && response.status() === 200);
const figure = async (page, label) =>
  Number(
    (
      await page
        .locator(".cycle tr")
        .filter({ has: page.locator("th", { hasText: label }) })
        .first()
        .locator("td")
        .innerText()
    ).replace("−", "-"),
  );
const shown = (value, digits) => Number(Number(value).toPrecision(digits));

test("from a model to the relay test on it: record, limit cycle and plan as the service answers, and on to its model", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=2", {}, async (page) => {
    const first = simulated(page);
    await page.getByRole("button", { name: "Simulate a relay test on it" }).click();
    await first;
    assert.match(page.url(), /#\/relay\/fopdt\?K=1&T=10&L=2$/);
    await page.getByLabel("Upper level").fill("1,3");
    await page.getByLabel("Lower level").fill("-0.7");
    await page.getByLabel("Hysteresis").fill("0.2");
    await page.getByLabel("Cycles", { exact: true }).fill("8");
    const second = simulated(page);
    await page.getByRole("button", { name: "Simulate" }).click();
    const response = await second;
    assert.deepEqual(response.request().postDataJSON(), {
      plant: { type: "fopdt", K: 1, T: 10, L: 2 },
      relay: {
        u_plus: 1.3,
        u_minus: -0.7,
        hysteresis: 0.2,
        cycles: 8,
        noise_std: 0,
        relay_sample_time: 0,
        seed: 0,
      },
    });
    const answer = await response.json();
    await page.waitForFunction(
      (Pu) => document.querySelector(".cycle td")?.textContent === Pu,
      String(Number(answer.limit_cycle.Pu).toPrecision(5)),
    );
    assert.equal(await figure(page, "Au"), shown(answer.limit_cycle.Au, 4));
    assert.equal(await figure(page, "φu"), shown(answer.limit_cycle.phi_u, 4));
    await tracesShown(page, "The test as it would be recorded", 2);
    const plan = await page.getByRole("region", { name: "Recommended test" }).innerText();
    assert.match(plan, new RegExp(`period of ${Number(answer.plan.expected_period).toPrecision(3)} s`));
    if (answer.plan.reason) assert.ok(plan.includes(answer.plan.reason));

    const identified = page.waitForResponse((reply) => reply.url().endsWith("/v1/identify") && reply.status() === 200);
    await page.getByRole("button", { name: "Identify this record" }).click();
    const reply = await identified;
    const sent = reply.request().postDataJSON().record;
    assert.deepEqual([sent.t, sent.u, sent.y, sent.kind], [answer.record.t, answer.record.u, answer.record.y, "relay"]);
    const { model } = await reply.json();
    assert.equal(model.plant.type, "fopdt");
    for (const [name, value] of [
      ["K", 1],
      ["T", 10],
      ["L", 2],
    ])
      assert.ok(Math.abs(model.plant[name] / value - 1) < 1e-3, `${name} ${model.plant[name]}`);
    await page.getByRole("heading", { name: "Model candidates" }).waitFor();
    // Back leads to the test with what was typed.
    await page.goBack();
    await page.getByRole("heading", { name: "The test as it would be recorded" }).waitFor();
    assert.equal(await page.getByLabel("Upper level").inputValue(), "1,3");
  });
});

test("the plan's settings are taken over and simulated", async () => {
  await withPage("#/relay/fopdt?K=1&T=10&L=2", {}, async (page) => {
    await page.getByRole("button", { name: "Use these settings" }).waitFor();
    await page.getByLabel("Noise of y").fill("0.02");
    await page.getByLabel("Relay sample time").fill("0.05");
    const noisy = simulated(page);
    await page.getByRole("button", { name: "Simulate" }).click();
    const { plan } = await (await noisy).json();
    await page
      .getByText(`±${Number(plan.hysteresis).toPrecision(3)}`)
      .first()
      .waitFor();
    const again = simulated(page);
    await page.getByRole("button", { name: "Use these settings" }).click();
    const { relay } = (await again).request().postDataJSON();
    for (const name of ["u_plus", "u_minus", "hysteresis", "cycles"])
      assert.equal(relay[name], shown(plan[name], 4), name);
    assert.equal(relay.noise_std, 0.02);
  });
});

test("a relay that cannot oscillate says why at its field", async () => {
  await withPage(
    "#/relay/fopdt?K=1&T=10&L=2",
    {},
    async (page) => {
      await page.getByRole("button", { name: "Use these settings" }).waitFor();
      await page.getByLabel("Hysteresis").fill("5");
      const refused = page.waitForResponse((response) => response.url().endsWith("/v1/experiments/relay"));
      await page.getByRole("button", { name: "Simulate" }).click();
      const { errors } = await (await refused).json();
      const input = page.getByLabel("Hysteresis");
      await page.getByRole("group", { name: "Problems to fix" }).waitFor();
      assert.equal(errors[0].pointer, "/relay/hysteresis");
      assert.equal(await input.getAttribute("aria-invalid"), "true");
      const said = await page.locator(`#${await input.getAttribute("id")}-error`).innerText();
      assert.equal(said, errors[0].detail.replace("u_plus", '"Upper level"'));
      assert.ok(await page.getByRole("button", { name: "Identify this record" }).isDisabled());
    },
    ["422"],
  );
});

test("results next to a request that was refused are marked as those of the one before", async () => {
  await withPage("#/relay/fopdt?K=1&T=10&L=2", {}, async (page) => {
    const mark = page.getByText("These results belong to the last answered request");
    const results = page.locator(".relay-results");
    await page.getByRole("heading", { name: "The test as it would be recorded" }).waitFor();
    assert.equal(await mark.isVisible(), false);
    await page.getByLabel("Hysteresis").fill("abc");
    await page.getByRole("button", { name: "Simulate" }).click();
    await mark.waitFor();
    const identify = page.getByRole("button", { name: "Identify this record" });
    const look = (button, name) => button.evaluate((it, of) => getComputedStyle(it)[of], name);
    assert.ok(await identify.isDisabled());
    const enabled = page.getByRole("button", { name: "Simulate" });
    assert.notEqual(await look(identify, "backgroundColor"), await look(enabled, "backgroundColor"));
    assert.equal(await look(identify, "cursor"), "default");
    assert.equal(await results.locator("> .cards").evaluate((card) => getComputedStyle(card).filter), "grayscale(1)");
    await page.getByLabel("Hysteresis").fill("0.1");
    await page.getByRole("button", { name: "Simulate" }).click();
    await mark.waitFor({ state: "hidden" });
    assert.ok(await page.getByRole("button", { name: "Identify this record" }).isEnabled());
  });
});

for (const [name, options] of WINDOWS) {
  test(`the relay test on a ${name}: axe finds nothing, and nothing is wider than the window`, async () => {
    await withPage("#/relay", options, async (page) => {
      await page.getByRole("heading", { name: "The test as it would be recorded" }).waitFor();
      assert.deepEqual(await accessibilityViolations(page), []);
      assert.equal(await overflow(page), 0);
    });
  });
}
