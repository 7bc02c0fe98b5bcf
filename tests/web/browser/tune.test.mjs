import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { browserTests, openPage, tracesShown } from "../harness.mjs";

const tests = browserTests();
const { withPage, jobOf } = tests;

const designShown = (page) => page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();

/** Text of a figure's cell: row and column by their headings. */
async function figure(page, group, label, column = 0) {
  const body = page
    .locator(".figures-card tbody")
    .filter({ has: page.locator("tr.group", { hasText: new RegExp(`^${group}$`) }) });
  const row = body.locator("tr").filter({ has: page.locator("th[scope=row]", { hasText: label }) });
  return (await row.first().locator("td").nth(column).textContent()).replace("−", "-");
}

const asShown = (value) => Number(Number(value).toPrecision(3));

test("the FOPDT form runs a job; table, settings and plots show what the API answers", async () => {
  await withPage("", {}, async (page) => {
    await page.getByLabel("Kind of process").selectOption("fopdt");
    await page.getByLabel("K", { exact: true }).fill("1,25");
    await page.getByLabel("T (s)", { exact: true }).fill("40");
    await page.getByLabel("L (s)", { exact: true }).fill("8");
    await page.getByRole("math").waitFor();
    await page.getByRole("button", { name: "Tune this model" }).click();
    await designShown(page);
    const job = await jobOf(page);
    assert.equal(job.status, "succeeded");
    assert.deepEqual(job.request.plant, { type: "fopdt", K: 1.25, T: 40, L: 8 });
    assert.deepEqual(
      job.request.tune.map((entry) => [entry.method, entry.Ms, entry.Mt]),
      [["robust", 1.4, 1.4]],
    );
    const [entry] = job.result.controllers;
    for (const [group, label, value] of [
      ["Controller", "Kp", entry.controller.Kp],
      ["Controller", "Ti", entry.controller.Ti],
      ["Controller", "Td", entry.controller.Td],
      ["Controller", "Tf", entry.controller.filter.Tf],
      ["Robustness", "Ms", entry.robustness.Ms],
      ["Robustness", "Mt", entry.robustness.Mt],
      ["Robustness", "Phase margin", entry.robustness.phase_margin_deg],
      ["Load step", "IAE", entry.performance.load.IAE],
      ["Load step", "Peak", entry.performance.load.peak],
      ["Set-point step", "Overshoot", entry.performance.setpoint.overshoot_percent],
      ["Set-point step", "TV", entry.performance.setpoint.TV],
    ]) {
      assert.equal(Number(await figure(page, group, label)), asShown(value), `${group} ${label}`);
    }
    assert.ok(entry.robustness.Ms <= 1.4 * (1 + 2e-5) && entry.robustness.Mt <= 1.4 * (1 + 2e-5));
    for (const [title, traces] of [
      ["Set-point step", 2],
      ["Load step at the plant input", 2],
      ["Nyquist curve of L", 1],
      ["Sensitivities", 3],
    ]) {
      await tracesShown(page, title, traces);
    }
    assert.match(await page.getByRole("region", { name: "Verdict" }).innerText(), /Robust/);
    // The address alone restores the job.
    await page.reload();
    await designShown(page);
    assert.equal(Number(await figure(page, "Controller", "Kp")), asShown(entry.controller.Kp));
  });
});

test("settings change their form and are copied with all their digits", async () => {
  await withPage("#/new/fopdt?K=2&T=10&L=3", {}, async (page) => {
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"], { origin: tests.service.base });
    await page.getByRole("button", { name: "Tune this model" }).click();
    await designShown(page);
    const [entry] = (await jobOf(page)).result.controllers;
    await page.getByRole("combobox", { name: "Maker and product" }).fill("parallel");
    await page.getByRole("option", { name: "Parallel form" }).click();
    await page.getByRole("button", { name: "Copy all with units" }).click();
    await page.getByRole("button", { name: "Copied" }).waitFor();
    const copied = await page.evaluate(() => navigator.clipboard.readText());
    const Ki = Number(/^Ki = (\S+)/m.exec(copied)[1]);
    assert.ok(Math.abs(Ki / entry.equivalents.parallel.Ki - 1) < 1e-4, copied);
  });
});

test("a field that cannot be read says so next to itself, and the summary leads to it", async () => {
  await withPage("", {}, async (page) => {
    await page.getByLabel("T (s)", { exact: true }).fill("1,2,3");
    await page.getByRole("button", { name: "Tune this model" }).click();
    const summary = page.getByRole("group", { name: "Problems to fix" });
    await summary.waitFor();
    assert.ok(await summary.evaluate((element) => element === document.activeElement));
    assert.match(await summary.innerText(), /1 problem to fix/);
    const input = page.getByLabel("T (s)", { exact: true });
    assert.equal(await input.getAttribute("aria-invalid"), "true");
    assert.match(
      await page.locator(`#${await input.getAttribute("id")}-error`).innerText(),
      /T "1,2,3" is not a number\. Write/,
    );
    assert.equal(await input.inputValue(), "1,2,3");
    await summary.getByRole("link").click();
    assert.ok(await input.evaluate((element) => element === document.activeElement));
  });
});

test("a filter alone is no controller of today: Kp is asked for, and the filter's own fault is reported", async () => {
  await withPage("#/new/fopdt?K=1.25&T=40&L=8", {}, async (page) => {
    await page.getByRole("textbox", { name: "Tf" }).fill("abc");
    await page.getByRole("button", { name: "Tune this model" }).click();
    await page.getByText("2 problems to fix").waitFor();
    for (const name of ["Kp", "Tf"])
      assert.equal(await page.getByRole("textbox", { name, exact: true }).getAttribute("aria-invalid"), "true", name);
  });
});

test("faults that the service finds stand at their fields, several at once", async () => {
  const opened = await openPage(tests.browser);
  try {
    const { page } = opened;
    await page.goto(tests.service.base);
    await page.getByLabel("L (s)", { exact: true }).fill("-3");
    await page.getByRole("textbox", { name: "Ms", exact: true }).fill("0.5");
    const answer = page.waitForResponse(
      (response) => response.url().endsWith("/v1/jobs") && response.request().method() === "POST",
    );
    await page.getByRole("button", { name: "Tune this model" }).click();
    const response = await answer;
    assert.equal(response.status(), 422);
    const { errors } = await response.json();
    assert.deepEqual(errors.map((error) => error.pointer).sort(), ["/plant/L", "/tune/0/Ms"]);
    for (const [label, pointer] of [
      ["L (s)", "/plant/L"],
      ["Ms", "/tune/0/Ms"],
    ]) {
      const input = page.getByRole("textbox", { name: label, exact: true });
      assert.equal(await input.getAttribute("aria-invalid"), "true", label);
      assert.equal(
        await page.locator(`#${await input.getAttribute("id")}-error`).innerText(),
        errors.find((error) => error.pointer === pointer).detail,
      );
    }
    // Chromium reports every 4xx answer on the console; nothing else may be there.
    assert.deepEqual(
      (await opened.faults()).filter((fault) => !fault.includes("422")),
      [],
    );
  } finally {
    await opened.close();
  }
});

test("several methods and today's settings are compared; a second plot and the keyboard follow", async () => {
  await withPage("#/new/fopdt?K=1.25&T=40&L=8", {}, async (page) => {
    await page.getByText(/^Compare with/).click();
    await page.getByRole("checkbox", { name: / simc$/ }).check();
    await page.getByLabel("Kp", { exact: true }).fill("1.2");
    await page.getByLabel("Ti", { exact: true }).fill("40");
    await page.getByRole("button", { name: "Tune this model" }).click();
    await designShown(page);
    const { controllers } = (await jobOf(page)).result;
    assert.deepEqual(
      controllers.map((entry) => entry.method),
      ["robust", "simc", "baseline"],
    );
    for (const [column, entry] of controllers.entries()) {
      assert.equal(
        Number(await figure(page, "Load step", "IAE", column)),
        asShown(entry.performance.load.IAE),
        entry.method,
      );
    }
    await tracesShown(page, "Nyquist curve of L", 3);
    await page.getByRole("checkbox", { name: "Draw simc" }).uncheck();
    await page.waitForFunction(() => !document.querySelector(".legend input[aria-label='Draw simc']").checked);
    await tracesShown(page, "Nyquist curve of L", 2);
    await page.getByRole("button", { name: "today", exact: true }).click();
    await page.getByRole("heading", { name: "Settings to enter: today" }).waitFor();
    assert.match(page.url(), /entry=2$/);

    const load = page.getByRole("img", { name: "Load step at the plant input" });
    await load.focus();
    await page.keyboard.press("Home");
    await page.keyboard.press("Shift+ArrowRight");
    const overlayOf = (name) => page.getByRole("img", { name }).locator("> g").nth(1);
    assert.match(await overlayOf("Load step at the plant input").textContent(), /time .*robust .*today/);
    assert.ok(
      (await overlayOf("Set-point step").locator("circle").count()) > 0,
      "the set-point plot follows the cursor",
    );
    const before = await load.locator("text").allTextContents();
    await page.keyboard.press("+");
    assert.notDeepEqual(await load.locator("text").allTextContents(), before);
    await page.keyboard.press("0");
    await page.keyboard.press("t");
    const table = page.getByRole("region", { name: "Data of Load step at the plant input" });
    assert.ok((await table.locator("tbody tr").count()) >= 40);
  });
});

test("a plot is saved as SVG without class and style, and as PNG", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=2", {}, async (page) => {
    await page.getByRole("button", { name: "Tune this model" }).click();
    await designShown(page);
    const plot = page
      .locator("section.plot")
      .filter({ has: page.getByRole("heading", { name: "Nyquist curve of L" }) });
    const save = async (kind) => {
      await plot.getByText("Export").first().click();
      const [download] = await Promise.all([
        page.waitForEvent("download"),
        plot.getByRole("button", { name: kind, exact: true }).click(),
      ]);
      return readFileSync(await download.path());
    };
    const svg = (await save("SVG")).toString("utf8");
    assert.doesNotMatch(svg, /\sclass=|\sstyle=|var\(/);
    assert.match(svg, /<title>Nyquist curve of L<\/title>/);
    assert.match(svg, /#2363c5/);
    const png = await save("PNG");
    assert.deepEqual([...png.subarray(0, 8)], [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
    assert.ok(png.readUInt32BE(16) > 600, "drawn at twice its size");
  });
});

test("every example of the service is tuned unchanged from the page", async () => {
  const { examples } = await (await fetch(`${tests.service.base}/v1/examples`)).json();
  assert.ok(examples.length > 0);
  for (const example of examples) {
    await withPage("", {}, async (page) => {
      await page
        .getByRole("button", { name: /^Tune: / })
        .first()
        .waitFor();
      const folded = page.locator(".examples details summary");
      if ((await folded.count()) > 0) await folded.click();
      await page.getByRole("button", { name: `Tune: ${example.title}`, exact: true }).click();
      await designShown(page);
      const job = await jobOf(page);
      assert.equal(job.status, "succeeded", example.id);
      assert.deepEqual(job.request, example.request);
    });
  }
});

test("an example is shown in the form and sent from there as the same plant and methods", async () => {
  const { examples } = await (await fetch(`${tests.service.base}/v1/examples`)).json();
  for (const example of examples.filter(
    (candidate) => candidate.request.plant && Array.isArray(candidate.request.tune ?? []),
  )) {
    await withPage(`#/examples/${example.id}`, {}, async (page) => {
      const nonlinear = example.request.plant.type === "nonlinear";
      const button = page.getByRole("button", { name: nonlinear ? "Tune these equations" : "Tune this model" });
      await button.waitFor();
      await page.waitForLoadState("networkidle");
      await button.click();
      await designShown(page);
      const { request } = await jobOf(page);
      assert.deepEqual({ L: 0, ...request.plant }, { L: 0, ...example.request.plant }, example.id);
      if (example.request.tune)
        assert.deepEqual(
          new Set(request.tune.map((entry) => entry.method)),
          new Set(example.request.tune.map((entry) => entry.method)),
          example.id,
        );
    });
  }
});

test("a job that cannot be done says why, and leads back to its request", async () => {
  await withPage("#/new/fopdt?K=1&T=10&L=10", {}, async (page) => {
    await page.getByRole("textbox", { name: "Ms", exact: true }).fill("1.01");
    await page.getByRole("textbox", { name: "Mt", exact: true }).fill("1.01");
    await page.getByRole("button", { name: "Tune this model" }).click();
    await page.getByRole("link", { name: "Change the request" }).waitFor();
    const verdict = page.getByRole("region", { name: "Verdict" });
    await verdict.waitFor();
    const job = await jobOf(page);
    const said = job.status === "failed" ? job.error.detail : job.result.controllers[0].controller.Kp;
    assert.ok(job.status !== "failed" || (await verdict.innerText()).includes(said));
    await page.getByRole("link", { name: "Change the request" }).click();
    await page.getByRole("button", { name: "Tune this model" }).waitFor();
    await page.waitForFunction(() =>
      [...document.querySelectorAll("label")].some(
        (label) => label.textContent === "Ms" && document.getElementById(label.htmlFor).value === "1.01",
      ),
    );
  });
});

test("a running job shows its fraction, stage, message and best design, and Cancel ends it", async () => {
  await withPage("", {}, async (page) => {
    const job = {
      id: "running",
      name: "slow loop",
      status: "running",
      created_at: "2026-01-01T00:00:00Z",
      attempts: 1,
      request: { plant: { type: "fopdt", K: 1, T: 10, L: 1 } },
      progress: {
        fraction: 0.42,
        stage: "tune",
        message: "Searching from 3 of 7 starts.",
        best: { controller: { Kp: 2.5, Ti: 16 }, load_IAE: 8.4, Ms: 1.4, Mt: 1.3 },
      },
    };
    // The service gets no request here: the test must not depend on the duration of a real search.
    await page.route("**/v1/jobs/running", (route) => route.fulfill({ json: job }));
    await page.route("**/v1/jobs/running/cancel", (route) => {
      job.status = "cancelled";
      return route.fulfill({ status: 202, json: job });
    });
    await page.goto(`${tests.service.base}/#/jobs/running/design`);
    await page.getByRole("heading", { name: "Searching for the best controller: 42 %" }).waitFor();
    assert.equal(await page.getByRole("progressbar").evaluate((bar) => bar.value), 0.42);
    await page.getByText("Searching from 3 of 7 starts.").waitFor();
    await page.getByText("Best so far: Kp 2.50, Ti 16.0, load IAE 8.40, Ms 1.40, Mt 1.30.").waitFor();
    await page.getByRole("button", { name: "Cancel" }).click();
    await page.getByRole("heading", { name: "Stopped before a controller was found." }).waitFor();
    await page.getByRole("progressbar").waitFor({ state: "hidden" });
  });
});

test("a lost connection is said, and the job is found again when it is back", async () => {
  const opened = await openPage(tests.browser);
  try {
    const { page } = opened;
    await page.goto(`${tests.service.base}/#/new/fopdt?K=1&T=10&L=2`);
    let lost = true;
    await page.route("**/v1/jobs/*", (route) => (lost ? route.abort() : route.continue()));
    await page.getByRole("button", { name: "Tune this model" }).click();
    await page.getByText("Not connected to the service.").waitFor();
    lost = false;
    await designShown(page);
    await page.getByText("Not connected to the service.").waitFor({ state: "hidden" });
  } finally {
    await opened.close();
  }
});

test("an address of a job that does not exist says so", async () => {
  const opened = await openPage(tests.browser);
  try {
    await opened.page.goto(`${tests.service.base}/#/jobs/00000000-0000-0000-0000-000000000000/design`);
    await opened.page.locator(".trouble:visible").filter({ hasText: /\S/ }).waitFor();
  } finally {
    await opened.close();
  }
});
