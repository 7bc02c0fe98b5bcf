// The report for its reader, and printed pages: Compare and the report, page by page.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { inflateSync } from "node:zlib";
import { accessibilityViolations, browserTests, openPage, overflow } from "../harness.mjs";

const tests = browserTests();
const { withPage } = tests;

const table = (page) => page.getByRole("region", { name: "Comparison table" });
const PLANT = "#/new/fopdt?K=1.25&T=40&L=8";
const REQUEST = {
  name: "TIC-101 <b>&",
  units: { time: "s", u: "%", y: "°C" },
  plant: "2 e^(-3s)/((10s+1)(2s+1))",
  tune: [{ method: "robust" }, { method: "simc" }],
  baseline: { form: "ideal", Kp: 0.6, Ti: 15 },
};

async function compareAll(page) {
  await page.getByLabel("Kp", { exact: true }).fill("1.2");
  await page.getByLabel("Ti", { exact: true }).fill("40");
  await page.getByRole("button", { name: "Compare all methods", exact: true }).click();
  await table(page).waitFor();
}

async function tuned(request) {
  const response = await fetch(`${tests.service.base}/v1/jobs`, {
    method: "POST",
    headers: { "Content-Type": "application/json", Prefer: "wait=60" },
    body: JSON.stringify(request),
  });
  const job = await response.json();
  assert.equal(job.status, "succeeded");
  return job;
}

/** The number of text pieces on each page of a PDF from the browser. */
function textPieces(pdf) {
  const text = pdf.toString("latin1");
  const object = (number) => text.slice(text.search(new RegExp(`(^|\\n)${number} 0 obj`)));
  return [...text.matchAll(/\/Type\s*\/Page\b[^]*?endobj/g)].map(([page]) => {
    const contents = object(Number(/\/Contents (\d+) 0 R/.exec(page)[1]));
    const begin = contents.indexOf("stream\n") + "stream\n".length;
    const stream = Buffer.from(contents.slice(begin, contents.indexOf("\nendstream")), "latin1");
    return (inflateSync(stream).toString("latin1").match(/ T[jJ]\b/g) ?? []).length;
  });
}

test("on paper every column has its heading, and the table is no wider than its card", async () => {
  // The area of A4 between usual margins.
  await withPage(PLANT, { width: 720, height: 1000 }, async (page) => {
    await compareAll(page);
    await page.locator(".comparison-table tbody tr").first().waitFor();
    const headings = await page.locator(".comparison-table thead th").allInnerTexts();
    await page.emulateMedia({ media: "print" });
    const printed = page.locator(".comparison-table thead th:visible");
    assert.deepEqual(
      (await printed.allInnerTexts()).map((text) => text.replace(/\s+/g, " ").trim()),
      headings.map((text) => text.replace(/\s+/g, " ").trim()).filter((text) => !text.startsWith("y, ")),
    );
    const edge = (selector) => page.locator(selector).first().evaluate((box) => box.getBoundingClientRect().right);
    assert.ok((await edge(".comparison-table")) <= (await edge(".card.comparison")));
    await page.emulateMedia({ media: "screen" });
    await page.getByRole("link", { name: "Settings and verdict" }).click();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    await page.emulateMedia({ media: "print" });
    assert.equal(await page.locator(".legend input:visible").count(), 0);
    assert.match(await page.locator(".legend").innerText(), /robust[^]*today/i);
  });
});

test("the table begins on the first page and is printed whole", async () => {
  await withPage(PLANT, {}, async (page) => {
    await compareAll(page);
    await page.locator(".comparison-table tbody tr").first().waitFor();
    const rows = await page.locator(".comparison-table tbody tr").count();
    const pieces = textPieces(await page.pdf({ format: "A4", landscape: true }));
    assert.ok(pieces.length > 1, `${pieces.length} pages of ${rows} rows`);
    assert.ok(pieces[0] > 100, `the first page holds ${pieces[0]} pieces of text, the pages ${pieces.join(", ")}`);
    assert.ok(pieces.reduce((sum, count) => sum + count, 0) > 10 * rows);
  });
});

test("the report prints on A4 and Letter, its style alone applies, and nothing is wrong with it", async () => {
  const csv = readFileSync(new URL("../../../api/examples/tclab-step.csv", import.meta.url), "utf8");
  const record = { record: { csv }, identify: { traces: true }, tune: [{ method: "robust" }] };
  for (const [request, most] of [
    [REQUEST, 5],
    [record, 6],
  ]) {
    const job = await tuned(request);
    const opened = await openPage(tests.browser, {});
    await opened.page.goto(`${tests.service.base}/v1/jobs/${job.id}/report.html`);
    assert.equal(await opened.page.evaluate(() => getComputedStyle(document.querySelector("table")).borderCollapse), "collapse");
    assert.equal(await opened.page.locator("figure svg path").count().then((count) => count > 20), true);
    for (const format of ["A4", "Letter"]) {
      const pieces = textPieces(await opened.page.pdf({ format, preferCSSPageSize: false }));
      assert.ok(pieces.length >= 2 && pieces.length <= most, `${pieces.length} pages of ${format}`);
      assert.ok(pieces.at(-1) >= 4, `the last page of ${format} holds ${pieces.at(-1)} pieces of text`);
    }
    assert.deepEqual(await opened.faults(), []);
    await opened.close();
  }
});

/** The record of a PI loop in automatic on 2/(20 s + 1) after 3 s, with one step of the set point. */
function recordedLoop() {
  const rows = ["t,r,y,u"];
  const delayed = Array(6).fill(0);
  let [x, y, integral] = [0, 0, 0];
  for (let i = 0; i < 1200; i++) {
    const r = i < 300 ? 10 : 12;
    const measured = 10 + y + (((i * 7919) % 101) - 50) / 5000;
    integral += (0.5 * (r - measured) * 0.6) / 20;
    const u = 0.6 * (r - measured) + integral;
    rows.push([i * 0.5, r, measured, 30 + u].map((value) => value.toFixed(5)).join(","));
    delayed.push(u);
    x += (0.5 * (2 * delayed.shift() - x)) / 20;
    y = x;
  }
  return rows.join("\n");
}

test("a change sheet of ten parameters and a long name is one page of A4 and of Letter, with a plot", async () => {
  const implement = { product: "emerson_deltav_standard", y_span: [0, 200], u_span: [0, 100], sample_time: 0.5 };
  const baseline = { product: "emerson_deltav_standard", settings: { GAIN: 1.1, RESET: 14 } };
  for (const name of ["W".repeat(100), "TIC-101 jacket temperature ".repeat(4).slice(0, 100)])
    for (const plant of [{ plant: REQUEST.plant }, { record: { csv: recordedLoop() } }]) {
      const job = await tuned({ name, units: REQUEST.units, ...plant, implement, baseline });
      const opened = await openPage(tests.browser, {});
      await opened.page.goto(`${tests.service.base}/v1/jobs/${job.id}/change-sheet.html`);
      const replayed = Boolean(job.result.controllers[0].replay?.figures);
      assert.equal(replayed, "record" in plant);
      await opened.page.locator("figcaption", { hasText: replayed ? "Replay of the record: y" : "Load step: y" }).waitFor();
      assert.equal(await overflow(opened.page), 0);
      await opened.page.evaluate(() => {
        const rows = document.querySelector("table tbody");
        while (rows.children.length < 10) rows.append(rows.lastElementChild.cloneNode(true));
      });
      for (const format of ["A4", "Letter"])
        assert.equal(textPieces(await opened.page.pdf({ format })).length, 1, `${format}, ${JSON.stringify(plant).slice(0, 20)}`);
      assert.deepEqual(await opened.faults(), []);
      await opened.close();
    }
});

test("a batch's page leads to its change sheets: one page a loop, and one with those that have none", async () => {
  const loops = [1, 2, 3].map((K) => ({ ...REQUEST, name: `TIC-${K}`, plant: `${K} e^(-3s)/((10s+1)(2s+1))` }));
  const jobs = [...loops, { name: "TIC-4", plant: { type: "fopdt", K: 2 } }];
  const { id } = await tests.post("v1/batches", { name: "unit 7", jobs });
  await tests.withPage(`#/batches/${id}`, {}, async (page) => {
    await page.getByText("3 tuned, 1 failed").waitFor();
    const opened = page.waitForEvent("popup");
    await page.getByRole("link", { name: "Change sheets", exact: true }).click();
    const sheets = await opened;
    await sheets.getByRole("heading", { name: "unit 7: loops without a change sheet" }).waitFor();
    assert.deepEqual(await sheets.locator("h1").allInnerTexts(), [
      ...loops.map(({ name }) => `${name}: change sheet`),
      "unit 7: loops without a change sheet",
    ]);
    for (const format of ["A4", "Letter"]) assert.equal(textPieces(await sheets.pdf({ format })).length, 4, format);
    assert.equal(await overflow(sheets), 0);
  });
});

test("reports and change sheets of an ordinary job are short, and in the reader's time", async () => {
  const implement = { product: "emerson_deltav_standard", y_span: [0, 200], u_span: [0, 100], sample_time: 0.5 };
  const baseline = { product: "emerson_deltav_standard", settings: { GAIN: 1.1, RESET: 14 } };
  const job = await tuned({ ...REQUEST, tune: [{ method: "robust" }], implement, baseline });
  for (const [timezone, zone] of [["Europe/Berlin", /UTC\+0[12]:00/], ["Asia/Kolkata", /UTC\+05:30/], ["UTC", /UTC\+00:00/]]) {
    const context = await tests.browser.newContext({ timezoneId: timezone });
    const page = await context.newPage();
    await page.goto(`${tests.service.base}/#/jobs/${job.id}/design`);
    const link = page.getByRole("link", { name: "Report", exact: true });
    await link.waitFor();
    const address = await link.getAttribute("href");
    const there = new Date(job.finished_at).toLocaleTimeString("en-GB", { timeZone: timezone, hour: "2-digit", minute: "2-digit" });
    await page.goto(new URL(address, tests.service.base).href);
    assert.match(await page.locator("header").innerText(), zone);
    assert.ok((await page.locator("header").innerText()).includes(` ${there} UTC`), `${there} in ${timezone}`);
    if (timezone === "UTC")
      for (const format of ["A4", "Letter"]) assert.ok(textPieces(await page.pdf({ format })).length <= 4, format);
    await context.close();
  }
});

test("Design leads to the change sheet of a design, and to none of today's settings", async () => {
  const job = await tuned(REQUEST);
  for (const [entry, address] of [
    [1, `v1/jobs/${job.id}/change-sheet.html?controller=1&utc_offset=0`],
    [2, null],
  ])
    await tests.withPage(`#/jobs/${job.id}/design?entry=${entry}`, {}, async (page) => {
      await page.getByRole("link", { name: "Report", exact: true }).waitFor();
      const link = page.getByRole("link", { name: "Change sheet", exact: true });
      assert.equal((await link.count()) ? await link.getAttribute("href") : null, address);
    });
});

test("axe finds nothing in the change sheet", async () => {
  const job = await tuned(REQUEST);
  const text = await (await fetch(`${tests.service.base}/v1/jobs/${job.id}/change-sheet.html`)).text();
  const opened = await openPage(tests.browser, { width: 390, height: 844 });
  await opened.page.setContent(text);
  assert.deepEqual(await accessibilityViolations(opened.page), []);
  assert.equal(await overflow(opened.page), 0);
  await opened.close();
});

test("a screen with a result leads to the report of the entry that it shows", async () => {
  const job = await tuned(REQUEST);
  await tests.withPage(`#/jobs/${job.id}/design?entry=1`, {}, async (page) => {
    const opened = page.waitForEvent("popup");
    await page.getByRole("link", { name: "Report", exact: true }).click();
    const report = await opened;
    await report.getByRole("heading", { name: "TIC-101 <b>&: tuning report" }).waitFor();
    assert.match(report.url(), /report\.html\?controller=1&utc_offset=0$/);
  });
});

test("the link itself has the entry, chosen or not: a middle click or a copy leads to the same report", async () => {
  const job = await tuned({ ...REQUEST, tune: [{ method: "cohen_coon" }, { method: "robust" }] });
  // If none is chosen it is the one that the answer proposes.
  for (const [address, index] of [
    ["design", 1],
    ["design?entry=0", 0],
  ])
    await tests.withPage(`#/jobs/${job.id}/${address}`, {}, async (page) => {
      const link = page.getByRole("link", { name: "Report", exact: true });
      await link.waitFor();
      assert.equal(await link.getAttribute("href"), `v1/jobs/${job.id}/report.html?controller=${index}&utc_offset=0`);
    });
});

test("on a phone the report is as wide as the window; wide tables scroll by themselves", async () => {
  const job = await tuned({ ...REQUEST, units: { time: "min", u: "%", y: "degC" } });
  const opened = await openPage(tests.browser, { width: 390, height: 844 });
  await opened.page.goto(`${tests.service.base}/v1/jobs/${job.id}/report.html`);
  assert.equal(await overflow(opened.page), 0);
  await opened.close();
});

test("axe finds nothing in the report", async () => {
  const job = await tuned(REQUEST);
  // axe is a script, which the report's own policy blocks: its markup is checked without the policy.
  const text = await (await fetch(`${tests.service.base}/v1/jobs/${job.id}/report.html`)).text();
  const opened = await openPage(tests.browser, {});
  await opened.page.setContent(text);
  assert.deepEqual(await accessibilityViolations(opened.page), []);
  await opened.close();
});
