// The screen Check with made answers: every kind of cause, sorting and filtering, progress and cancelling, every window.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { accessibilityViolations, browserTests, openPage, overflow, tracesShown, WINDOWS } from "../../harness.mjs";
import { madeAnswer, madeJob } from "../../made_checks.mjs";

const tests = browserTests();
const ID = "madecheck00000000000000001";
const LIST = `#/jobs/${ID}/check`;
const json = (body) => ({ status: 200, contentType: "application/json", body: JSON.stringify(body) });

/** A page on which the service has this job. `routes`: further answers by the end of their address. */
async function withJob(address, job, options, body, routes = {}) {
  const opened = await openPage(tests.browser, options);
  const { page } = opened;
  await page.route(`**/v1/jobs/${ID}`, (route) => route.fulfill(json(job())));
  for (const [end, answer] of Object.entries(routes)) await page.route(`**${end}`, answer);
  await page.goto(`${tests.service.base}/${address}`);
  await body(page);
  assert.deepEqual(await opened.faults(), []);
  await page.unrouteAll({ behavior: "ignoreErrors" });
  await opened.close();
}

/** A page on which the service has this batch: its check, and a job for each of its loops. */
async function withBatch(address, ended, body, routes = {}) {
  const answer = madeAnswer();
  const bare = answer.loops.map(({ excerpt: _e, spectrum: _s, autocorrelation: _a, shape: _p, ...loop }, index) => ({ ...loop, index, job: `job${index}` }));
  const counts = (done) => ({ queued: 8 - done, running: 0, succeeded: done, failed: 0, cancelled: 0 });
  const state = () => ({ id: ID, name: "Unit 22", status: ended() ? "ended" : "running", total: 8, counts: counts(ended() ? 8 : 3), progress: { fraction: 0 }, cancel_requested: false, created_at: "2026-05-04T06:00:00Z", finished_at: null, links: {} });
  const listed = [{ id: "job7", name: "TIC-108", index: 7, status: "succeeded", created_at: "2026-05-04T06:00:00Z", outline: { method: "check", units: { time: "min" } } }];
  const opened = await openPage(tests.browser);
  const { page } = opened;
  await page.route(`**/v1/batches/${ID}`, (route) => route.fulfill(json(state())));
  await page.route(`**/v1/batches/${ID}/check`, (route) => route.fulfill(json({ ...answer, loops: bare, failed: 2, complete: true })));
  await page.route(`**/v1/jobs?batch=${ID}*`, (route) => route.fulfill(json({ jobs: listed, next: null })));
  await page.route(/\/v1\/jobs\/job\d$/, (route) => {
    const loop = answer.loops[Number(route.request().url().slice(-1))];
    return route.fulfill(json(madeJob("x", { ...answer, loops: [loop], clusters: [], cascades: [], ranking: [] })));
  });
  for (const [end, fulfil] of Object.entries(routes)) await page.route(`**${end}`, fulfil);
  await page.goto(`${tests.service.base}/${address}`);
  await body(page);
  assert.deepEqual(await opened.faults(), []);
  await page.unrouteAll({ behavior: "ignoreErrors" });
  await opened.close();
}

const made = () => madeJob(ID, madeAnswer());
const rows = (page) => page.locator(".work-table tbody tr");
const tags = (page) => rows(page).locator("th a").allInnerTexts();
const cause = (page, name) => page.getByRole("group", { name: "Causes" }).getByRole("button", { name });
const IN_ORDER = ["FIC-102", "PIC-105", "TIC-104", "PIC-106", "LIC-103", "AIC-107", "TIC-108", "FIC-101"];

test("causes are counted, and a press shows their loops; the address keeps what is shown", async () => {
  await withJob(LIST, made, {}, async (page) => {
    await rows(page).first().waitFor();
    assert.deepEqual(await tags(page), IN_ORDER);
    assert.match(await cause(page, /^Sticking valve/).innerText(), /1$/);
    await cause(page, /^Tuned too tight/).click();
    assert.deepEqual(await tags(page), ["PIC-105"]);
    assert.equal(await cause(page, /^Tuned too tight/).getAttribute("aria-pressed"), "true");
    await page.getByText("1 of 8 loops").waitFor();
    await cause(page, /^All loops/).click();
    await page.getByLabel("Owner").selectOption({ label: "control (4)" });
    await page.getByLabel("Loop", { exact: true }).fill("tic1");
    assert.deepEqual(await tags(page), ["TIC-104", "TIC-108"]);
    await page.getByRole("button", { name: "Loop", exact: true }).click();
    await page.getByRole("button", { name: "Loop", exact: true }).click();
    assert.deepEqual(await tags(page), ["TIC-108", "TIC-104"]);
    assert.match(page.url(), /\/check\?sort=-loop&owner=control&text=tic1$/);
    await page.reload();
    await rows(page).first().waitFor();
    assert.deepEqual(await tags(page), ["TIC-108", "TIC-104"]);
    assert.equal(await page.getByLabel("Loop", { exact: true }).inputValue(), "tic1");
    // The way from loop to loop is that of the list as shown.
    await rows(page).getByRole("link", { name: "TIC-104", exact: true }).click();
    await page.getByText("2 of 2", { exact: true }).waitFor();
    await page.goBack();
    await rows(page).first().waitFor();
    assert.deepEqual(await tags(page), ["TIC-108", "TIC-104"]);
  });
});

test("headings sort by their figures, and say how", async () => {
  await withJob(LIST, made, {}, async (page) => {
    await rows(page).first().waitFor();
    const heading = (name) => page.getByRole("columnheader", { name });
    await heading(/^Money per hour/).getByRole("button").first().press("Enter");
    assert.deepEqual((await tags(page)).slice(0, 2), ["PIC-105", "FIC-102"]);
    assert.equal(await heading(/^Money per hour/).getAttribute("aria-sort"), "descending");
    await heading("#").getByRole("button").click();
    assert.deepEqual(await tags(page), IN_ORDER);
    assert.equal(await heading(/^Money per hour/).getAttribute("aria-sort"), null);
    // A figure that is missing has its reason.
    await page.getByText("Why figures are missing").click();
    await page.getByRole("listitem").filter({ hasText: "The cause is open." }).waitFor();
    await heading(/^Cause/).getByRole("button", { name: "What is Cause?" }).click();
    await page.getByRole("dialog", { name: "Cause" }).waitFor();
  });
});

test("a filter that shows no loop is taken away with one press", async () => {
  await withJob(`${LIST}?text=pump`, made, {}, async (page) => {
    await page.getByText("0 of 8 loops").waitFor();
    await page.getByRole("button", { name: "Show all" }).press("Enter");
    await rows(page).nth(7).waitFor();
    assert.equal(await page.getByRole("button", { name: "Show all" }).count(), 0);
    assert.equal(await page.evaluate(() => document.activeElement.id), "work-find");
  });
});

test("the work list is saved as it is shown", async () => {
  await withJob(`${LIST}?owner=process`, made, {}, async (page) => {
    await rows(page).first().waitFor();
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Work list as CSV" }).click()]);
    assert.equal(download.suggestedFilename(), "Unit-21-work-list.csv");
    const lines = readFileSync(await download.path(), "utf8").trim().split("\r\n");
    assert.equal(lines.length, 2);
    assert.match(lines[1], /^5,LIC-103,"Disturbed from outside, likely",find the source,process,.*,FIC-102,What to do about external\.$/);
  });
});

test("a loop's page says why, what to do, what else may be, and which loop comes first", async () => {
  await withJob(`${LIST}?loop=2`, made, {}, async (page) => {
    await page.getByRole("heading", { name: "LIC-103", level: 1 }).waitFor();
    const verdict = page.locator(".check-loop .verdict");
    assert.match(await verdict.innerText(), /Disturbed from outside, likely\s+The figure for external is −0\.5\./);
    await verdict.getByRole("link", { name: "FIC-102" }).waitFor();
    await page.locator(".loop-action").getByRole("link", { name: "FIC-102" }).click();
    await page.getByRole("heading", { name: "FIC-102", level: 1 }).waitFor();
    await verdict.getByText("Not excluded: Tuned too tight.").waitFor();
    await page.getByRole("row", { name: /^Dead band and stick 3\.20/ }).waitFor();
  });
});

test("a loop is drawn together with another one, first those that oscillate with it", async () => {
  await withJob(`${LIST}?loop=2`, made, {}, async (page) => {
    const choice = page.getByLabel("Draw with");
    await page.getByRole("heading", { name: "Whole record" }).waitFor();
    assert.deepEqual((await choice.locator("option").allInnerTexts()).slice(0, 3), ["no other loop", "FIC-102", "PIC-105"]);
    await choice.selectOption("FIC-102");
    await page.getByText("FIC-102 PV", { exact: true }).first().waitFor();
    await tracesShown(page, "Whole record", 5);
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.reload();
    await tracesShown(page, "Whole record", 5);
    assert.equal(await choice.inputValue(), "1", "the address keeps it");
    await choice.selectOption("no other loop");
    await tracesShown(page, "Whole record", 3);
    await choice.selectOption("FIC-102");
    await page.getByRole("link", { name: /^Next/ }).click();
    await page.getByRole("heading", { name: "AIC-107", level: 1 }).waitFor();
    assert.equal(await choice.inputValue(), "", "another loop begins by itself");
  });
});

test("a loop without a usable record shows the reason and no pictures; an unknown loop is named as such", async () => {
  await withJob(`${LIST}?loop=7`, made, {}, async (page) => {
    await page.getByRole("heading", { name: "TIC-108", level: 1 }).waitFor();
    await page.getByText("The record has 40 usable rows; a check needs at least 200.").waitFor();
    assert.equal(await page.locator("section.plot").count(), 0);
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.goto(`${tests.service.base}/${LIST}?loop=99`);
    await page.getByText("This check has no such loop.").waitFor();
  });
});

const SETTINGS = { form: "ideal", Kp: 2.5, Ti: 40, Td: 0, b: 1, c: 0, filter: { type: "none" }, action: "reverse" };
const cureAnswer = (cure) => {
  const answer = madeAnswer();
  return { ...answer, loops: [{ ...answer.loops[4], cure }], clusters: [], cascades: [], ranking: [] };
};

test("where tuning is the cause, new settings stand next to today's; where a valve sticks, what ends its cycle", async () => {
  const cure = { settings: SETTINGS, today: { ...SETTINGS, Kp: 4 }, worst_Ms: 1.45, error_ratio: 0.6, detail: "The record shows the plant." };
  const stops = [{ means: "gap", Kp: 2, Ti: 20, gap: 0.5, error_ratio: [4, 5], standing_error: 0.4, detail: "With a gap the cycle ends." }];
  const valve = { outcome: "found", stops, period: 50, amplitude: 1, recorded_amplitude: 1, detail: "" };
  const ofValve = { worst_Ms: null, error_ratio: null, valve, detail: "Each has a cost.", why_null: {} };
  const asked = [];
  const check = (route) => {
    asked.push(route.request().postDataJSON());
    return route.fulfill(json(cureAnswer(asked.at(-1).loops[0].tag === "FIC-102" ? ofValve : cure)));
  };
  await withJob(`${LIST}?loop=4`, made, {}, async (page) => {
    const card = page.getByRole("region", { name: "New settings" });
    await card.getByText("The record shows the plant.").waitFor();
    assert.deepEqual(await card.getByRole("row", { name: /^Kp/ }).getByRole("cell").allInnerTexts(), ["4", "2.5"]);
    assert.equal(await card.getByRole("row", { name: /^Td/ }).count(), 0, "no derivative action");
    assert.match(await card.innerText(), /Worst Ms\s+1\.45/);
    assert.equal(asked[0].settings, true);
    assert.deepEqual(asked[0].loops.map(({ tag }) => tag), ["PIC-105"]);
    assert.deepEqual(await accessibilityViolations(page), []);
    // Known by now, and another card where a valve sticks.
    await page.getByRole("link", { name: /^‹ Previous/ }).click();
    await page.getByRole("heading", { name: "FIC-102", level: 1 }).waitFor();
    await page.getByRole("region", { name: "Until the valve is repaired" }).getByRole("listitem").getByText("With a gap the cycle ends.").waitFor();
    assert.equal(await card.count(), 0);
    await page.getByRole("link", { name: /^Next/ }).click();
    await card.getByText("The record shows the plant.").waitFor();
    assert.equal(asked.length, 2);
  }, { "/v1/check": check });
});

test("where the record does not suffice, the page shows the test to make", async () => {
  const test_ = { kind: "set-point-steps", size: 0.5, steps: 4, hold: 60, duration: 300, beyond_seen: true, detail: "" };
  const cure = { worst_Ms: null, error_ratio: null, test: test_, detail: "Nothing moves the set point.", why_null: {} };
  await withJob(`${LIST}?loop=4`, made, {}, async (page) => {
    const card = page.getByRole("region", { name: "The test that is missing for new settings" });
    assert.match(await card.innerText(), /Steps of the set point, in automatic\s+4\s+Size of each\s+0\.500 more than the range in the record/);
    assert.match(await card.innerText(), /Held for\s+60\.0 s/);
  }, { "/v1/check": (route) => route.fulfill(json(cureAnswer(cure))) });
});

test("a check that runs shows its progress, and what it has when it is cancelled", async () => {
  let cancelled = false;
  const partial = () => {
    const answer = madeAnswer();
    return madeJob(ID, { ...answer, partial: true }, { status: "cancelled" });
  };
  const job = () => (cancelled ? partial() : madeJob(ID, madeAnswer(), { status: "running", result: undefined, progress: { fraction: 0.25, stage: "check", message: "2 of 8 loops checked." } }));
  const routes = {
    "/events": (route) => route.fulfill({ status: 200, contentType: "text/event-stream", body: `event: progress\nid: 1\ndata: ${JSON.stringify({ fraction: 0.5, stage: "check", message: "4 of 8 loops checked." })}\n\n` }),
    "/cancel": (route) => {
      cancelled = true;
      return route.fulfill(json(partial()));
    },
  };
  await withJob(LIST, job, {}, async (page) => {
    await page.getByText("4 of 8 loops checked.").waitFor();
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.getByRole("button", { name: "Cancel" }).click();
    await rows(page).first().waitFor();
    await page.getByText("8 loops. The check was stopped early: loops that it did not reach have no result.").waitFor();
    assert.equal(await page.evaluate(() => document.activeElement.tagName), "H1", "the button that had the focus is gone");
  }, routes);
});

test("a batch that was stopped says how many loops were not checked", async () => {
  const stopped = { id: ID, name: "Unit 22", status: "ended", total: 8, counts: { queued: 0, running: 0, succeeded: 6, failed: 0, cancelled: 2 }, progress: { fraction: 1 }, cancel_requested: true, created_at: "2026-05-04T06:00:00Z", finished_at: null, links: {} };
  await withBatch(`#/batches/${ID}/check`, () => true, async (page) => {
    await page.getByText("8 loops. The check was stopped early: 2 loops not checked.", { exact: true }).waitFor();
  }, { [`/v1/batches/${ID}`]: (route) => route.fulfill(json(stopped)) });
});

test("a long list comes in parts as it is scrolled, and each loop is found", async () => {
  const many = () => {
    const { loops, ranking, ...rest } = madeAnswer();
    const all = Array.from({ length: 300 }, (_, index) => ({ ...loops[index % 7], tag: `FIC-${1000 + index}` }));
    return madeJob(ID, { ...rest, clusters: [], cascades: [], loops: all, ranking: all.map((_, loop) => ({ ...ranking[loop % 7], loop, after: undefined })) });
  };
  await withJob(LIST, many, {}, async (page) => {
    await rows(page).first().waitFor();
    const shown = await rows(page).count();
    assert.ok(shown < 300, `${shown} rows`);
    await page.getByText(`${300 - shown} more below: scroll the table.`).waitFor();
    await page.getByRole("region", { name: "Work list" }).evaluate((element) => (element.scrollTop = element.scrollHeight));
    await page.waitForFunction((before) => document.querySelectorAll(".work-table tbody tr").length > before, shown);
    await page.getByLabel("Loop", { exact: true }).fill("1287");
    assert.deepEqual(await tags(page), ["FIC-1287"]);
    await page.getByLabel("Loop", { exact: true }).fill("");
    // Back from the last loop the list has come that far.
    await page.goto(`${tests.service.base}/${LIST}?loop=299`);
    await page.getByRole("heading", { name: "FIC-1299", level: 1 }).waitFor();
    await page.getByRole("link", { name: "Work list", exact: true }).click();
    await page.waitForFunction(() => document.activeElement.textContent === "FIC-1299");
  });
});

test("a batch is followed until it has ended; the pages of its loops have the curves of their own jobs", async () => {
  let over = false;
  await withBatch(`#/batches/${ID}/check`, () => over, async (page) => {
    await page.getByText("3 of 8 loops checked.").waitFor();
    over = true;
    await rows(page).first().waitFor();
    assert.deepEqual(await tags(page), IN_ORDER);
    await page.getByText("8 loops. 2 records of the batch could not be checked.").waitFor();
    assert.equal(await page.getByRole("columnheader", { name: "Last periods" }).count(), 0);
    assert.equal(await rows(page).locator("td.spark svg").count(), 7, "of the whole record");
    await page.getByRole("columnheader", { name: "Period (min)" }).waitFor();
    assert.equal(await page.title(), "Unit 22 · Check · Tunewright");
    await page.getByRole("link", { name: "TIC-104", exact: true }).first().click();
    await page.getByRole("heading", { name: "TIC-104", level: 1 }).waitFor();
    await page.getByRole("heading", { name: "Autocorrelation of the error" }).waitFor();
    assert.match(page.url(), new RegExp(`#/batches/${ID}/check\\?loop=3$`));
    await page.getByRole("button", { name: "Identify from this record" }).waitFor();
    await page.getByRole("link", { name: /^Next/ }).click();
    await page.getByRole("heading", { name: "PIC-106", level: 1 }).waitFor();
    await page.getByRole("heading", { name: "Autocorrelation of the error" }).waitFor();
    assert.deepEqual(await accessibilityViolations(page), []);
  }, { "/v1/check": (route) => route.fulfill(json(cureAnswer({ settings: SETTINGS, worst_Ms: 1.4, error_ratio: 0.5, detail: "" }))) });
});

test("records that are too long for one request, and a file of many loops, become a batch", async () => {
  const sent = [];
  const receive = (route) => {
    const request = route.request();
    sent.push([request.headers()["content-type"], new URL(request.url()).searchParams]);
    return route.fulfill({ status: 202, contentType: "application/json", body: JSON.stringify({ id: ID }) });
  };
  const file = (name, text) => ({ name, mimeType: "text/csv", buffer: Buffer.from(text) });
  const one = ["t,sp,pv,op", ...Array.from({ length: 300 }, (_, t) => `${t},50,${50 + Math.sin(t / 5)},${40 - Math.cos(t / 5)}`)].join("\n");
  const wide = ["time [s],FIC1.SP,FIC1.PV,FIC1.OP,TIC2.SP,TIC2.PV,TIC2.OP", ...Array.from({ length: 300 }, (_, t) => `${t},50,${50 + Math.sin(t / 5)},${40 - Math.cos(t / 5)},20,${20 + Math.sin(t / 9)},${30 - Math.cos(t / 9)}`)].join("\n");
  const routes = { "/healthz": (route) => route.fulfill(json({ status: "ok", max_body_bytes: 15_000 })), "/v1/batches?kind=check*": receive };
  await withBatch("#/check", () => true, async (page) => {
    await page.locator("input[type=file]").setInputFiles([file("A.csv", one), file("B.csv", one)]);
    await page.getByRole("button", { name: "Check 2 loops" }).click();
    await rows(page).first().waitFor();
    assert.match(page.url(), new RegExp(`#/batches/${ID}/check$`));
    await page.getByRole("link", { name: "New check" }).click();
    await page.getByRole("button", { name: "Remove all" }).click();
    await page.locator("input[type=file]").setInputFiles([file("plant.csv", wide)]);
    await page.getByText("This file has the columns of several loops.").waitFor();
    assert.equal(await page.getByRole("table", { name: "Loops to check" }).count(), 0);
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.getByRole("button", { name: "Check all loops of the file" }).click();
    await rows(page).first().waitFor();
    // The columns of one loop make it that loop.
    await page.getByRole("link", { name: "New check" }).click();
    await page.getByText("How the files are read").click();
    await page.getByLabel("Measurement (PV)").selectOption("FIC1.PV");
    await page.getByLabel("Controller output (OP)").selectOption("FIC1.OP");
    await page.getByRole("button", { name: "Check 1 loop" }).waitFor();
  }, routes);
  assert.deepEqual(sent.map(([type, options]) => [type, options.get("kind"), options.get("name")]), [
    ["application/x-ndjson", "check", null],
    ["text/csv", "check", "plant"],
  ]);
});

for (const [window, options] of WINDOWS)
  test(`the list, a loop and the form fit the window, and are accessible: ${window}`, async () => {
    await withJob(LIST, made, options, async (page) => {
      await rows(page).first().waitFor();
      assert.equal(await overflow(page), 0);
      assert.deepEqual(await accessibilityViolations(page), []);
      await page.getByRole("link", { name: "FIC-102", exact: true }).first().click();
      await page.getByRole("heading", { name: "Autocorrelation of the error" }).waitFor();
      assert.equal(await overflow(page), 0);
      assert.deepEqual(await accessibilityViolations(page), []);
      await page.goto(`${tests.service.base}/#/check?from=${ID}`);
      await page.getByLabel("Name of FIC-102").waitFor();
      assert.equal(await overflow(page), 0);
      assert.deepEqual(await accessibilityViolations(page), []);
    });
  });
