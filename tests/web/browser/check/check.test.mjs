// The screen Check against the real service: files in, the work list and a loop's page out, and the way on to a design.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { accessibilityViolations, browserTests, dropFile, tracesShown } from "../../harness.mjs";

const tests = browserTests();
const { withPage } = tests;

/** A loop whose output and measurement swing with a period in s, as CSV. */
function swinging(period, rows = 900) {
  const lines = ["time [s];SP;PV;OP;MODE"];
  for (let row = 0; row < rows; row += 1) {
    const phase = (2 * Math.PI * row) / (period / 2);
    const noise = ((row * 7919) % 101) / 101 - 0.5;
    lines.push([2 * row, "50,0", (50 + 2 * Math.sin(phase) + 0.1 * noise).toFixed(3), (40 + 3 * Math.cos(phase)).toFixed(2), "AUTO"].join(";").replaceAll(".", ","));
  }
  return lines.join("\n");
}

const file = (name, text) => ({ name, mimeType: "text/csv", buffer: Buffer.from(text) });
const choose = (page, files) => page.locator("input[type=file]").setInputFiles(files);
const rows = (page) => page.locator(".work-table tbody tr");
const tags = (page) => rows(page).locator("th a").allInnerTexts();
const answerOf = async (page) => {
  const id = /#\/jobs\/([^/?]+)\/check/.exec(page.url())[1];
  return (await fetch(`${tests.service.base}/v1/jobs/${id}`)).json();
};

async function checked(page, files) {
  await choose(page, files);
  await page.getByRole("button", { name: `Check ${files.length} loop${files.length === 1 ? "" : "s"}` }).click();
  await rows(page).first().waitFor();
}

test("dropped files become loops with their tags and kinds, and the list shows what the service answers", async () => {
  await withPage("#/check", {}, async (page) => {
    await page.getByRole("heading", { name: "Check loops in operation" }).waitFor();
    await dropFile(page, ".check-form", "TIC-103.csv", swinging(120));
    await page.getByRole("textbox", { name: "Name of TIC-103" }).waitFor();
    await choose(page, [file("FIC-101.csv", swinging(60)), file("short.csv", swinging(60, 40)), file("notes.pdf", "no")]);
    await page.getByText("2 files added. 1 file without the ending csv, tsv or txt left out.").waitFor();
    assert.equal(await page.getByLabel("Kind of TIC-103").inputValue(), "temperature");
    assert.equal(await page.getByLabel("Kind of FIC-101").inputValue(), "flow");
    assert.equal(await page.getByLabel("Kind of short").inputValue(), "unknown");
    await page.getByLabel("Lower end of the output of all loops").fill("10");
    await page.getByLabel("Upper end of the output of all loops").fill("90");
    await page.getByLabel("Upper end of the output of all loops").press("Tab");
    await page.getByLabel("Weight of FIC-101").fill("3");
    await page.getByLabel("Name of this check").fill("Unit 21");
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.getByRole("button", { name: "Check 3 loops" }).click();
    await rows(page).first().waitFor();
    const { request, result } = await answerOf(page);
    assert.equal(request.name, "Unit 21");
    assert.deepEqual(request.loops.map(({ tag, kind, range, weight }) => [tag, kind, range.op, weight]), [
      ["TIC-103", "temperature", [10, 90], undefined],
      ["FIC-101", "flow", [10, 90], 3],
      ["short", undefined, [10, 90], undefined],
    ]);
    assert.deepEqual(await tags(page), result.ranking.map(({ loop }) => result.loops[loop].tag));
    assert.equal(await page.title(), "Unit 21 · Check · Tunewright");
    const short = rows(page).filter({ hasText: "short" });
    assert.match(await short.innerText(), /Record not sufficient/);
    assert.equal(await rows(page).locator("td.spark svg").count(), result.loops.filter(({ excerpt }) => excerpt.t.length > 1).length);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("a loop's page has its record, its evidence and its figures, and leads from loop to loop", async () => {
  await withPage("#/check", {}, async (page) => {
    await checked(page, [file("A.csv", swinging(60)), file("B.csv", swinging(120)), file("C.csv", swinging(200))]);
    const { result } = await answerOf(page);
    const order = await tags(page);
    await page.getByRole("link", { name: order[1], exact: true }).first().click();
    await page.getByRole("heading", { name: order[1], level: 1 }).waitFor();
    const shown = result.loops.find(({ tag }) => tag === order[1]);
    const verdict = await page.locator(".check-loop .verdict").innerText();
    for (const { detail } of shown.cause.evidence) assert.ok(verdict.includes(detail.replaceAll(/(^|[\s(])-(?=\d)/g, "$1−")), detail);
    assert.ok((await page.locator(".loop-action").innerText()).includes(shown.action.detail));
    await tracesShown(page, "Whole record", 3);
    for (const title of ["Last periods", "Measurement against output", "Spectrum of the error", "Autocorrelation of the error"])
      await page.getByRole("heading", { name: title }).waitFor();
    assert.ok((await page.getByRole("row", { name: /^Rows 900/ }).count()) > 0);
    assert.deepEqual(await accessibilityViolations(page), []);
    // By the keyboard alone, the focus stays on the way.
    await page.getByRole("link", { name: `Next › ${order[2]}` }).press("Enter");
    await page.getByRole("heading", { name: order[2], level: 1 }).waitFor();
    assert.equal(await page.getByRole("link", { name: /^Next/ }).count(), 0);
    await page.getByRole("link", { name: `‹ Previous ${order[1]}` }).press("Enter");
    await page.getByRole("heading", { name: order[1], level: 1 }).waitFor();
    await page.getByRole("link", { name: `‹ Previous ${order[0]}` }).press("Enter");
    await page.getByText("1 of 3", { exact: true }).waitFor();
    await page.getByRole("link", { name: "Work list", exact: true }).press("Enter");
    await page.waitForFunction((tag) => document.activeElement.textContent === tag, order[0]);
    await page.keyboard.press("ArrowDown");
    assert.equal(await page.evaluate(() => document.activeElement.textContent), order[1]);
  });
});

test("the example plant is checked with one press, and its map joins the loops with one period", async () => {
  await withPage("#/check", {}, async (page) => {
    await page.getByRole("button", { name: "Try the example plant" }).click();
    await rows(page).first().waitFor();
    assert.equal(await rows(page).count(), 6);
    const { result } = await answerOf(page);
    assert.ok(result.clusters.length > 0, "FIC101 and TIC102 oscillate together");
    const map = page.getByRole("region", { name: "Loops over their periods" });
    const group = map.locator("tbody").first();
    assert.ok((await group.innerText()).includes(result.clusters[0].detail));
    assert.deepEqual(await group.locator("tr:not(.group) a").allInnerTexts(), result.clusters[0].loops.map((place) => result.loops[place].tag));
    for (const { master, slave } of result.cascades)
      await page.getByText(`${result.loops[master].tag} gives ${result.loops[slave].tag} its set point.`).waitFor();
    const oscillating = result.loops.filter(({ shape }) => shape.period > 0);
    assert.equal(await map.locator("td.ridge svg").count(), oscillating.length);
    await group.locator("a").first().click();
    await page.getByRole("heading", { name: result.loops[result.clusters[0].loops[0]].tag, level: 1 }).waitFor();
    await page.getByText("It oscillates together with").waitFor();
  });
});

test("a record goes on to Identify, and back the check is as it was", async () => {
  await withPage("#/check", {}, async (page) => {
    await checked(page, [file("FIC-7.csv", swinging(60))]);
    await page.getByRole("link", { name: "FIC-7", exact: true }).first().click();
    const sent = page.waitForRequest((request) => request.url().endsWith("/v1/identify"));
    await page.getByRole("button", { name: "Identify from this record" }).click();
    const { record, name } = (await sent).postDataJSON();
    assert.equal(name, "FIC-7");
    assert.equal(record.csv, swinging(60));
    assert.match(page.url(), /#\/identify$/);
    await page.goBack();
    await page.getByRole("heading", { name: "FIC-7", level: 1 }).waitFor();
  }, ["422"]);
});

test("checks are found again: in the form, among the jobs, and under the address of a design", async () => {
  await withPage("#/check", {}, async (page) => {
    await checked(page, [file("LIC-9.csv", swinging(80))]);
    const { id } = await answerOf(page);
    await page.getByRole("link", { name: "New check" }).click();
    const earlier = page.getByRole("region", { name: "Earlier checks" });
    await earlier.getByRole("link", { name: "LIC-9" }).first().click();
    await page.waitForURL((url) => url.hash === `#/jobs/${id}/check`);
    await rows(page).first().waitFor();
    await page.goto(`${tests.service.base}/#/jobs/${id}/design`);
    await page.waitForURL((url) => url.hash === `#/jobs/${id}/check`);
    await rows(page).first().waitFor();
    await page.goto(`${tests.service.base}/#/jobs`);
    await page.getByRole("link", { name: `Duplicate Job ${id.slice(0, 8)}` }).click();
    await page.getByLabel("Name of LIC-9").waitFor();
    assert.match(page.url(), new RegExp(`#/check\\?from=${id}$`));
    // Changed and checked again.
    await page.getByLabel("Kind of LIC-9").selectOption("level");
    await page.getByLabel("LIC-9 smooths flows").check();
    await page.getByRole("button", { name: "Check 1 loop" }).click();
    await page.waitForURL((url) => url.hash.endsWith("/check"));
    await rows(page).first().waitFor();
    const [loop] = (await answerOf(page)).request.loops;
    assert.deepEqual([loop.kind, loop.averaging, loop.csv], ["level", true, swinging(80)]);
  });
});

test("faults stand at their fields, files that are not UTF-8 are read as the service reads them", async () => {
  await withPage("#/check", {}, async (page) => {
    await page.getByRole("button", { name: "Check the loops" }).click();
    await page.getByRole("group", { name: "Problems to fix" }).getByText("There is no loop yet.").waitFor();
    const latin = Buffer.from(swinging(60).replace("PV", "PV [°C]"), "latin1");
    await choose(page, [{ name: "Kühlung.csv", mimeType: "text/csv", buffer: latin }]);
    await page.getByLabel("Name of Kühlung").waitFor();
    await page.getByText("How the files are read").click();
    await page.locator(".preview").getByText("PV [°C]").first().waitFor();
    await page.getByLabel("Lower end of the output of Kühlung").fill("5");
    await page.getByRole("button", { name: "Check 1 loop" }).click();
    await page.getByRole("group", { name: "Problems to fix" }).getByText("The range of the output has one end only").waitFor();
    assert.equal(await page.getByLabel("Upper end of the output of Kühlung").getAttribute("aria-invalid"), "true");
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.getByLabel("Upper end of the output of Kühlung").fill("95");
    await page.getByLabel("Measurement (PV)").selectOption({ label: "PV [°C]" });
    await page.getByRole("button", { name: "Check 1 loop" }).click();
    await rows(page).first().waitFor();
    const [loop] = (await answerOf(page)).request.loops;
    assert.deepEqual([loop.range.op, loop.columns], [[5, 95], { y: "PV [°C]" }]);
  });
});

/** Loops side by side in one file; the error of the second one is this much larger. */
function wideFile(tags, size = 1) {
  const lines = [`time [s],${tags.map((tag) => `${tag}.SP,${tag}.PV,${tag}.OP`).join(",")}`];
  for (let row = 0; row < 900; row += 1)
    lines.push([2 * row, ...tags.flatMap((_, index) => [50, (50 + (index === 1 ? size : 1) * 2 * Math.sin(row / (5 + 6 * index)) + 0.01 * ((row * 7919) % 11)).toFixed(3), (40 + 3 * Math.cos(row / (5 + 6 * index))).toFixed(2)])].join(","));
  return lines.join("\n");
}

test("a file with the columns of many loops becomes a batch, and its work list has them all", async () => {
  const tags = ["FIC-1", "TIC-2", "PIC-3"];
  await withPage("#/check", {}, async (page) => {
    await choose(page, [file("Unit 7.csv", wideFile(tags))]);
    await page.getByRole("button", { name: "Check all loops of the file" }).click();
    await rows(page).nth(2).waitFor();
    const id = /#\/batches\/([^/?]+)\/check/.exec(page.url())[1];
    const answer = await (await fetch(`${tests.service.base}/v1/batches/${id}/check`)).json();
    assert.deepEqual(await rows(page).locator("th a").allInnerTexts(), answer.ranking.map(({ loop }) => answer.loops[loop].tag));
    assert.deepEqual((await rows(page).locator("th a").allInnerTexts()).sort(), [...tags].sort());
    assert.equal(await page.title(), "Unit 7 · Check · Tunewright");
    await page.getByRole("link", { name: "TIC-2", exact: true }).first().click();
    await tracesShown(page, "Whole record", 3);
    await page.getByRole("button", { name: "Identify from this record" }).waitFor();
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.goto(`${tests.service.base}/#/batches/${id}`);
    await page.getByText("3 loops: 3 checked").waitFor();
    await page.getByRole("link", { name: "Work list of the loops" }).click();
    await rows(page).nth(2).waitFor();
  });
});

test("a batch is compared with an earlier one, in the list, on a loop's page and in the saved list", async () => {
  const send = async (page, name, csv) => {
    await page.goto(`${tests.service.base}/#/check`);
    await choose(page, [file(name, csv)]);
    await page.getByRole("button", { name: "Check all loops of the file" }).click();
    await rows(page).nth(1).waitFor();
    const id = /#\/batches\/([^/?]+)\/check/.exec(page.url())[1];
    await page.getByRole("link", { name: "New check" }).click();
    await page.getByRole("button", { name: "Remove all" }).click();
    return id;
  };
  await withPage("#/check", {}, async (page) => {
    const before = await send(page, "May.csv", wideFile(["FIC-1", "TIC-2"]));
    const now = await send(page, "June.csv", wideFile(["FIC-1", "TIC-2", "PIC-3"], 0.1));
    await page.getByRole("region", { name: "Earlier checks" }).getByRole("link", { name: "June" }).click();
    await rows(page).nth(2).waitFor();
    const choice = page.getByLabel("Compare with");
    await choice.selectOption({ label: "May, 2 loops, now" });
    await page.getByRole("columnheader", { name: "Cause before" }).waitFor();
    assert.match(page.url(), new RegExp(`before=${before}`));
    const { loops, changes } = await (await fetch(`${tests.service.base}/v1/batches/${now}/check?before=${before}`)).json();
    assert.deepEqual(changes.map(({ loop }) => loops[loop].tag), ["FIC-1", "TIC-2"]);
    const { change } = changes[1];
    assert.ok(change.variability_ratio < 0.15);
    const row = rows(page).filter({ has: page.getByRole("link", { name: "TIC-2", exact: true }) });
    await row.getByRole("cell", { name: change.variability_ratio.toPrecision(3), exact: true }).waitFor();
    await row.getByRole("cell", { name: change.significant ? "yes" : "no", exact: true }).waitFor();
    await page.getByRole("columnheader", { name: /^Error now/ }).getByRole("button", { name: /^Error/ }).click();
    assert.deepEqual(await tags(page), ["FIC-1", "TIC-2", "PIC-3"], "a loop that the earlier check does not have is last");
    assert.deepEqual(await accessibilityViolations(page), []);
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Work list as CSV" }).click()]);
    assert.match(readFileSync(await download.path(), "utf8"), /^#,Loop,Cause,Cause before,Error now\/before,Significant,/);
    await row.getByRole("link").first().click();
    await page.getByRole("heading", { name: "Since May" }).waitFor();
    await page.getByText(`The standard deviation of the error is ${change.variability_ratio.toPrecision(3)} times that of then;`).waitFor();
    assert.deepEqual(await accessibilityViolations(page), []);
    // The link holds the comparison; without it the list is as before.
    await page.reload();
    await page.getByRole("heading", { name: "Since May" }).waitFor();
    await page.getByRole("link", { name: "Work list", exact: true }).click();
    await choice.selectOption("no earlier check");
    await page.getByRole("columnheader", { name: "Cause before" }).waitFor({ state: "detached" });
    assert.ok(!page.url().includes("before="));
  });
});

test("an earlier check that is gone is named, and the list stays", async () => {
  await withPage("#/check", {}, async (page) => {
    await choose(page, [file("Unit 7.csv", wideFile(["FIC-1", "TIC-2"]))]);
    await page.getByRole("button", { name: "Check all loops of the file" }).click();
    await rows(page).nth(1).waitFor();
    await page.goto(`${page.url()}?before=nosuchbatch`);
    await page.locator(".trouble").filter({ hasText: "nosuchbatch" }).waitFor();
    assert.equal(await rows(page).count(), 2);
  }, ["404"]);
});

test("a file that cannot be read says so in its row, before anything is checked", async () => {
  await withPage("#/check", {}, async (page) => {
    await choose(page, [file("FIC-101.csv", swinging(60)), file("only-pv.csv", "Time,PV\n0,1\n1,2\n2,3\n")]);
    const row = (name) => page.getByRole("row").filter({ has: page.getByLabel(`Name of ${name}`) });
    await row("only-pv").locator("td .error").filter({ hasText: /output/ }).first().waitFor();
    assert.equal(await row("FIC-101").locator("td .error").filter({ hasText: /./ }).count(), 0);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("units that the files name are the units of the answer", async () => {
  const text = swinging(60).replace("PV", "PV [°C]").replace("OP", "OP [%]");
  await withPage("#/check", {}, async (page) => {
    await checked(page, [file("TIC-7.csv", text)]);
    const { request } = await answerOf(page);
    assert.deepEqual(request.units, { y: "°C", u: "%" });
    await page.getByRole("link", { name: "TIC-7", exact: true }).first().click();
    await page.locator("svg.canvas").getByText("TIC-7 PV (°C)").first().waitFor();
    await page.getByRole("row", { name: /^Mean error .* °C$/ }).waitFor();
  });
});
