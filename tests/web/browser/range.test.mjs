import assert from "node:assert/strict";
import test from "node:test";
import { accessibilityViolations, browserTests, dropFile, overflow, tracesShown, WINDOWS } from "../harness.mjs";

const tests = browserTests();
const { withPage, jobOf } = tests;

const CURVES = "Ms and IAE over the range";
const verdict = (page) => page.locator(".range-results .verdict h2");
const answered = (page, holds = () => true) =>
  page.waitForResponse((response) => response.url().endsWith("/v1/range") && holds(response.request().postDataJSON()));
const handle = (page, row) => page.getByRole("slider", { name: `Handle of row ${row}` });
const cell = (page, name) => page.getByLabel(name, { exact: true });
const shown = (value) => String(Number(Number(value).toPrecision(5)));

/** The path of the schedule's Ms, which is drawn first. */
const curve = (page) =>
  page
    .locator("section.plot")
    .filter({ has: page.getByRole("heading", { name: CURVES }) })
    .locator('svg.canvas path[stroke="var(--series-1)"]')
    .first()
    .getAttribute("d");

async function changed(page, before) {
  for (let attempt = 0; attempt < 100 && (await curve(page)) === before; attempt += 1) await page.waitForTimeout(50);
  assert.notEqual(await curve(page), before);
}

test("the first example is designed at once, and what is shown is what the service answers", async () => {
  await withPage("#/range", {}, async (page) => {
    await verdict(page).waitFor();
    const { ranges } = await (await fetch(`${tests.service.base}/v1/examples`)).json();
    const asked = await fetch(`${tests.service.base}/v1/range`, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(ranges[0].request),
    });
    const { range } = await asked.json();
    assert.equal(await page.locator(".range-results .verdict").innerText(), range.verdict.text);
    for (const [index, row] of range.schedule.rows.entries())
      for (const name of ["Kp", "Ti", "Td", "b"])
        assert.equal(await cell(page, `${name} of row ${index + 1}`).inputValue(), shown(row[name]));
    const points = page.getByRole("region", { name: "Figures at each point" }).locator("tbody tr");
    assert.equal(await points.count(), range.points.length);
    assert.ok((await points.nth(2).innerText()).includes(Number(range.one.points[2].relative_IAE.toPrecision(3))));
    await tracesShown(page, CURVES, 4);
    await tracesShown(page, "The plant", 3);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("a row moves by keys and by the pointer, the curves follow, and the design comes back", async () => {
  await withPage("#/range", {}, async (page) => {
    await verdict(page).waitFor();
    const designed = await curve(page);
    const before = await handle(page, 2).getAttribute("aria-valuetext");
    const place = await cell(page, "Place of row 2").inputValue();
    const Kp = await cell(page, "Kp of row 2").inputValue();
    assert.match(before, /^Row 2 at load [\d.]+ %, Kp [\d.]+, largest Ms [\d.]+$/);
    const moved = answered(page);
    await handle(page, 2).focus();
    await page.keyboard.press("Shift+ArrowLeft");
    const sent = (await moved).request().postDataJSON();
    assert.equal(sent.runs, false);
    assert.equal(sent.schedule.given[1].at, Number((Number(place) - 3.5).toFixed(2)));
    assert.equal(shown(sent.schedule.given[1].Kp), Kp);
    await changed(page, designed);
    await page.getByRole("heading", { name: "Schedule, moved by hand" }).waitFor();
    assert.notEqual(await cell(page, "Place of row 2").inputValue(), place);
    // Held by the pointer, and released.
    const after = await curve(page);
    const box = await handle(page, 3).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    const last = answered(page);
    await page.mouse.move(box.x + box.width / 2 + 40, box.y, { steps: 4 });
    await last;
    await changed(page, after);
    await page.mouse.up();
    await page.getByRole("button", { name: "Back to the design" }).click();
    assert.equal(await curve(page), designed);
    assert.equal(await handle(page, 2).getAttribute("aria-valuetext"), before);
    assert.equal(await cell(page, "Place of row 2").inputValue(), place);
  });
});

test("the focus goes on to the schedule when the design is back", async () => {
  await withPage("#/range", {}, async (page) => {
    await verdict(page).waitFor();
    await handle(page, 1).press("ArrowRight");
    await page.getByRole("button", { name: "Back to the design" }).press("Enter");
    await page.getByRole("button", { name: "Back to the design" }).waitFor({ state: "hidden" });
    assert.equal(await page.evaluate(() => document.activeElement.ariaLabel), "Rows of the schedule");
  });
});

test("a row is typed over; what cannot be read stands at its cell", async () => {
  await withPage("#/range", {}, async (page) => {
    await verdict(page).waitFor();
    await cell(page, "Kp of row 2").fill("x");
    await cell(page, "Kp of row 2").press("Enter");
    await page.locator(".schedule-card .summary a").waitFor();
    assert.equal(await cell(page, "Kp of row 2").getAttribute("aria-invalid"), "true");
    const asked = answered(page);
    await cell(page, "Kp of row 2").fill("0,9");
    await cell(page, "Kp of row 2").press("Enter");
    assert.equal((await asked).request().postDataJSON().schedule.given[1].Kp, 0.9);
    await page.getByText("The limits do not hold everywhere.").waitFor();
    assert.match(await verdict(page).innerText(), /do not hold/);
  });
});

test("the rows are typed into the user's controller, follow a row that moves, and go with the job", async () => {
  await withPage("#/range", {}, async (page) => {
    await verdict(page).waitFor();
    const typed = () => page.waitForResponse((response) => response.url().endsWith("/emerson_deltav_standard/schedule"));
    const table = page.getByRole("region", { name: "Settings of each row" });
    const first = typed();
    await page.getByRole("combobox", { name: "Maker and product" }).fill("deltav standard");
    await page.getByRole("listbox", { name: "Maker and product" }).getByRole("option").first().waitFor();
    await page.keyboard.press("Enter");
    for (const [name, value] of [["Measurement range", "200"], ["Output range", "100"]]) {
      const range = page.getByRole("group", { name });
      await range.getByLabel("from").fill("0");
      await range.getByLabel("to").fill(value);
      await range.getByLabel("to").press("Tab");
    }
    const answer = await (await first).json();
    await table.waitFor();
    for (const [index, { typing }] of answer.rows.entries())
      assert.ok((await table.locator("tbody tr").nth(index).innerText()).includes(typing.as_typed.GAIN));
    assert.equal(await table.locator("tbody tr").count(), answer.rows.length);
    assert.ok((await page.locator(".own-rows").innerText()).includes("PID_GAINSCHED"));
    assert.deepEqual(await accessibilityViolations(page), []);

    const second = typed();
    await cell(page, "Kp of row 2").fill("0.5");
    await cell(page, "Kp of row 2").blur();
    const { rows } = (await second).request().postDataJSON();
    assert.equal(rows[1].Kp, 0.5);
    const posted = page.waitForRequest((request) => request.url().endsWith("/v1/jobs") && request.method() === "POST");
    await page.getByRole("button", { name: "Send as a job" }).click();
    assert.equal((await posted).postDataJSON().schedule.given[1].Kp, 0.5);
  });
});

test("a controller that is chosen on Start is known in Range, though Range was opened before", async () => {
  await withPage("#/range", {}, async (page) => {
    const search = page.getByRole("combobox", { name: "Maker and product" });
    const screens = page.getByRole("navigation", { name: "Screens" });
    await verdict(page).waitFor();
    assert.equal(await search.inputValue(), "");
    await screens.getByRole("link", { name: "Start" }).click();
    await search.fill("deltav standard");
    await page.getByRole("listbox", { name: "Maker and product" }).getByRole("option").first().waitFor();
    await page.keyboard.press("Enter");
    const chosen = await search.inputValue();
    assert.match(chosen, /DeltaV/);
    await screens.getByRole("link", { name: "Range" }).click();
    await verdict(page).waitFor();
    assert.equal(await search.inputValue(), chosen);
  });
});

test("equations show their runs, and with moved rows run again", async () => {
  await withPage("#/range", {}, async (page) => {
    await verdict(page).waitFor();
    await page.getByLabel("Fill from an example").selectOption("range-of-a-cone");
    await page.getByLabel("Run", { exact: true }).waitFor();
    assert.match(page.url(), /#\/range\/range-of-a-cone$/);
    assert.equal(await page.getByRole("tab", { name: "Equations" }).getAttribute("aria-selected"), "true");
    await page.getByLabel("Run", { exact: true }).selectOption({ label: "ramp" });
    await tracesShown(page, "Run: ramp", 7);
    const asked = answered(page);
    await handle(page, 2).focus();
    await page.keyboard.press("ArrowRight");
    await asked;
    const again = answered(page, (request) => request.runs === true);
    await page.getByRole("button", { name: "Run the present rows" }).click();
    assert.ok((await (await again).json()).range.runs.length > 0);
    await page.getByText("these runs still show the design").waitFor({ state: "hidden" });
    await tracesShown(page, "Run: ramp", 7);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("files of recorded tests become points; faults stand at their rows", async () => {
  const csv = (K, T, L) => {
    const rows = [...Array(200).keys()].map((t) => [
      t,
      t < 10 ? 0 : 1,
      t < 10 + L ? 0 : K * (1 - Math.exp((10 + L - t) / T)),
    ]);
    return `t,u,y\n${rows.map((row) => row.join(",")).join("\n")}`;
  };
  await withPage("#/range/empty", {}, async (page) => {
    await page.getByLabel("The plant varies with").fill("load");
    await dropFile(page, ".range-form", "low.csv", csv(4, 20, 4));
    await page.getByText("low.csv: 200 rows.").waitFor();
    await dropFile(page, ".range-form", "high.csv", csv(1, 8, 2));
    await page.getByText("high.csv: 200 rows.").waitFor();
    await page.getByRole("button", { name: "Design", exact: true }).click();
    await page.getByText("2 problems to fix").waitFor();
    await cell(page, "Place").nth(0).fill("30");
    await cell(page, "Place").nth(1).fill("100");
    assert.ok(await page.getByLabel("Keep the limits on every plant").isChecked());
    const asked = answered(page);
    await page.getByRole("button", { name: "Design", exact: true }).click();
    const sent = (await asked).request().postDataJSON();
    assert.deepEqual([sent.points.length, sent.points[1].at, sent.uncertainty], [2, 100, "identified"]);
    assert.ok(sent.points[0].record.csv.startsWith("t,u,y"));
    await verdict(page).waitFor();
    assert.match(await page.getByRole("region", { name: "Figures at each point" }).innerText(), /fit 100 %|fit 99/);
    // During the drag the answer is for the models, then for the records themselves.
    const quick = answered(page, (request) => request.schedule.given && request.points[0].plant);
    const whole = answered(page, (request) => request.schedule.given && request.points[0].record);
    await handle(page, 1).focus();
    await page.keyboard.press("ArrowRight");
    await Promise.all([quick, whole]);
    await page.getByRole("heading", { name: "Schedule, moved by hand" }).waitFor();
  });
});

test("a fault of the service stands at the row that it is about", async () => {
  await withPage(
    "#/range",
    {},
    async (page) => {
      await verdict(page).waitFor();
      await cell(page, "Plant").nth(1).fill("2 e^(-3s)/(12s+1");
      await page.getByRole("button", { name: "Design", exact: true }).click();
      await page.getByText("1 problem to fix").waitFor();
      assert.equal(await cell(page, "Plant").nth(1).getAttribute("aria-invalid"), "true");
      // The verdict belongs to the previous request, and says so.
      const mark = page.getByText("These results belong to the last answered request");
      await mark.waitFor();
      const colours = page.locator(".range-results > .verdict").evaluate((card) => getComputedStyle(card).filter);
      assert.equal(await colours, "grayscale(1)");
      await cell(page, "Plant").nth(1).fill("2 e^(-3s)/(12s+1)");
      await page.getByRole("button", { name: "Design", exact: true }).click();
      await mark.waitFor({ state: "hidden" });
    },
    ["422"],
  );
});

test("a design that takes long can be stopped, and asked for again", async () => {
  await withPage("#/range", {}, async (page) => {
    await verdict(page).waitFor();
    let letGo = () => undefined;
    const gate = new Promise((resolve) => (letGo = resolve));
    await page.route("**/v1/range", async (route) => {
      await gate;
      await route.continue().catch(() => undefined);
    });
    await page.getByRole("button", { name: "Design", exact: true }).click();
    await page.getByRole("button", { name: "Cancel", exact: true }).click();
    await page.getByRole("button", { name: "Cancel", exact: true }).waitFor({ state: "hidden" });
    letGo();
    await page.unroute("**/v1/range");
    await cell(page, "Ms").fill("1.6");
    const asked = answered(page);
    await page.getByRole("button", { name: "Design", exact: true }).click();
    assert.equal((await asked).request().postDataJSON().schedule.Ms, 1.6);
    await page.getByText("limit 1.60").first().waitFor();
  });
});

test("a range as a job shows its schedule and its report, has no comparison, and opens in Range without another design", async () => {
  await withPage("#/range", {}, async (page) => {
    await verdict(page).waitFor();
    await page.getByRole("button", { name: "Send as a job" }).click();
    await page.getByRole("link", { name: "Open in Range" }).waitFor();
    const { id, result } = await jobOf(page);
    assert.equal(await page.getByRole("region", { name: "Verdict" }).innerText(), result.range.verdict.text);
    assert.equal(await page.locator(".range-job tbody tr").count(), result.range.schedule.rows.length);
    await page.getByText("Controller as code").click();
    await page.getByRole("region", { name: "Source text" }).getByText("scheduling : LREAL").waitFor();
    const [report] = await Promise.all([page.waitForEvent("popup"), page.getByRole("link", { name: "Report" }).click()]);
    await report.getByRole("heading", { name: "Over the range" }).waitFor();
    assert.equal(await report.getByText(result.range.verdict.text).count(), 1);
    await report.close();
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.getByRole("link", { name: "Compare", exact: true }).click();
    await page.waitForURL(/\/design$/);
    await page.getByRole("link", { name: "Jobs", exact: true }).click();
    await page.getByText("3 points over load").first().waitFor();
    await page.getByRole("link", { name: /^Duplicate/ }).first().click();
    await page.waitForURL(new RegExp(`#/jobs/${id}/range$`));
    await verdict(page).waitFor();
    assert.equal(await verdict(page).innerText(), result.range.verdict.text);
  });
});

test("moved rows go with the job under another name and from its screen again, not with another design", async () => {
  await withPage("#/range", {}, async (page) => {
    const send = page.getByRole("button", { name: "Send as a job" });
    const sent = async () => {
      const isPost = (request) => request.url().endsWith("/v1/jobs") && request.method() === "POST";
      const posted = page.waitForRequest(isPost);
      await send.click();
      return (await posted).postDataJSON();
    };
    await verdict(page).waitFor();
    await handle(page, 2).focus();
    await page.keyboard.press("Shift+ArrowRight");
    const place = Number(await handle(page, 2).getAttribute("aria-valuenow"));
    await page.getByText("Name of the loop, units").click();
    await page.locator(".range-form").getByLabel("Loop", { exact: true }).fill("TIC-7");
    const first = await sent();
    assert.deepEqual([first.name, first.schedule.given[1].at], ["TIC-7", place]);

    await page.getByRole("link", { name: "Open in Range" }).click();
    await page.waitForURL(/\/range$/);
    await verdict(page).waitFor();
    await page.waitForFunction(
      (at) => document.querySelectorAll(".handle")[1]?.getAttribute("aria-valuenow") === String(at),
      place,
    );
    assert.deepEqual((await sent()).schedule.given, first.schedule.given);

    // A job that arrives late: until then the result of the screen is not shown, so that nothing is typed into its form.
    const open = page.getByRole("link", { name: "Open in Range" });
    await open.waitFor();
    let arrive;
    const arrived = new Promise((release) => (arrive = release));
    await page.route("**/v1/jobs/*", async (route) => {
      await arrived;
      await route.continue();
    });
    await open.click();
    await page.waitForURL(/\/range$/);
    await page.locator(".range[data-busy]").waitFor();
    assert.equal(await verdict(page).isVisible(), false);
    arrive();
    await verdict(page).waitFor();
    const limit = page.locator(".range-form").getByLabel("Ms", { exact: true });
    await limit.fill("1.7");
    await send.click();
    await page.getByText("The rows belong to an earlier request; the form has changed since.").waitFor();
    assert.match(page.url(), /\/range$/);
  });
});

for (const [name, options] of WINDOWS) {
  test(`a range fits the window and has no accessibility violations: ${name}`, async () => {
    for (const address of ["#/range", "#/range/range-of-a-cone"])
      await withPage(address, options, async (page) => {
        await verdict(page).waitFor();
        await tracesShown(page, CURVES, 4);
        assert.ok((await overflow(page)) <= 0, `${address} is wider than the window`);
        assert.deepEqual(await accessibilityViolations(page), []);
        const small = await page
          .locator(
            ".range button:visible, .range input:visible:not(.visually-hidden), .range select:visible, .handle:visible",
          )
          .evaluateAll((list) =>
            list
              .map((item) => [
                item.outerHTML.slice(0, 80),
                item.closest("label")?.getBoundingClientRect() ?? item.getBoundingClientRect(),
              ])
              .filter(([, box]) => box.width < 24 || box.height < 24)
              .map(([text]) => text),
          );
        assert.deepEqual(small, [], "targets below 24 px");
      });
  });
}
