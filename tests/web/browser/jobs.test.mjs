// Jobs: the list, a CSV of loops as a batch, and requests to copy.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import { accessibilityViolations, browserTests, overflow, root } from "../harness.mjs";

const tests = browserTests();
const { withPage, post } = tests;

const PLANT = { type: "fopdt", K: 2, T: 10, L: 3 };
const settings = { form: "ideal", Kp: 1, Ti: 20, Td: 0 };

test("a job is found, duplicated and deleted after one question", async () => {
  await post("v1/jobs", { name: "TIC-101", plant: PLANT, tune: [{ method: "simc" }], baseline: settings });
  await post("v1/jobs", { name: "FIC-7", plant: { ...PLANT, T: 4 }, tune: [{ method: "amigo" }, { method: "simc" }] });
  await withPage("#/jobs", {}, async (page) => {
    const row = (name) => page.getByRole("row", { name: new RegExp(name) });
    await row("TIC-101").waitFor();
    assert.match(await row("TIC-101").innerText(), /2 e\^\(−3s\)\/\(10s \+ 1\)\s+simc\s.*succeeded/s);
    await page.getByRole("textbox", { name: "Search jobs by name, method or id" }).fill("fic");
    await row("TIC-101").waitFor({ state: "detached" });
    assert.match(await row("FIC-7").innerText(), /best of 2/);
    assert.match(page.url(), /#\/jobs\?q=fic$/);
    await page.getByRole("button", { name: "Delete FIC-7", exact: true }).click();
    await page.getByRole("button", { name: "Delete for good: Delete FIC-7" }).click();
    await page.getByText('No job has "fic" in its name, method or id.').waitFor();
    await page.getByRole("textbox", { name: "Search jobs by name, method or id" }).fill("");
    await page.getByRole("link", { name: "Duplicate TIC-101" }).click();
    await page.getByRole("heading", { name: "What do you have?" }).waitFor();
    await page.getByRole("link", { name: "Jobs" }).click();
    await page.getByRole("link", { name: "TIC-101", exact: true }).click();
    await page.getByRole("heading", { name: "TIC-101" }).waitFor();
  });
});

test("a name of 100 letters leaves the actions of the list in the window", async () => {
  const name = "Temperaturregelung".repeat(6).slice(0, 100);
  await post("v1/jobs", { name, plant: PLANT, tune: [{ method: "simc" }] });
  await withPage("#/jobs", {}, async (page) => {
    const row = page.getByRole("row").filter({ hasText: name });
    await row.waitFor();
    const box = await row.getByRole("button", { name: /^Delete/ }).boundingBox();
    const list = await page.getByRole("region", { name: "List of jobs" }).boundingBox();
    assert.ok(box.x + box.width <= list.x + list.width, `${box.x + box.width} > ${list.x + list.width}`);
  });
});

test("a CSV of loops becomes a batch with a table, an order and a CSV", async () => {
  const loops = readFileSync(path.join(root, "docs/loops.csv"));
  await withPage("#/jobs", {}, async (page) => {
    await page.getByLabel("Largest Ms").fill("1.6");
    await page
      .getByLabel(/Drop a CSV of loops here/)
      .setInputFiles({ name: "unit 7.csv", mimeType: "text/csv", buffer: loops });
    await page.getByRole("heading", { name: "unit 7" }).waitFor();
    await page.getByText("5 loops: 5 tuned", { exact: true }).waitFor();
    await page.getByRole("link", { name: "PIC-12" }).waitFor();
    await page.getByRole("columnheader", { name: "Load IAE" }).getByRole("button").click();
    const heads = await page.getByRole("columnheader").allInnerTexts();
    for (const head of ["Kp", "Ti (s)"]) assert.ok(heads.includes(head), `${head} among ${heads.join(", ")}`);
    const cells = await page.locator(".job-list tbody tr").evaluateAll((rows) => rows.map((row) => [...row.cells].map((cell) => cell.innerText)));
    for (let column = 0; column < heads.length; column += 1)
      assert.ok(cells.some((row) => row[column] !== "–"), `${heads[column]} holds dashes alone`);
    const names = await page.getByRole("rowheader").allInnerTexts();
    assert.deepEqual(names, ["AIC-30", "TIC-101", "TIC-102", "PIC-12", "FIC-7"]);
    assert.match(page.url(), /sort=-iae$/);
    const [file] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Download CSV" }).click(),
    ]);
    const lines = readFileSync(await file.path(), "utf8")
      .trim()
      .split("\n");
    assert.equal(lines.length, 6);
    assert.match(lines[0], /^index,id,name,status,method/);
    assert.match(lines[0], /time_unit/);
    assert.deepEqual(await accessibilityViolations(page), []);
  });
});

test("a file's own settings of today make the batch's table sort by the gain over them", async () => {
  const csv = "name,K,T [min],L [min],Kp,Ti\nslow,2,10,3,0.2,20\nnear,1.4,25,4,2,20\nnone,0.4,1.2,0.5,,\n";
  await withPage("#/jobs", {}, async (page) => {
    await page
      .getByLabel(/Drop a CSV of loops here/)
      .setInputFiles({ name: "today.csv", mimeType: "text/csv", buffer: Buffer.from(csv) });
    await page.getByText("3 loops: 3 tuned", { exact: true }).waitFor();
    await page.getByRole("columnheader", { name: "Ti (min)" }).waitFor();
    await page.getByRole("button", { name: "Largest improvement over today" }).click();
    assert.deepEqual(await page.getByRole("rowheader").allInnerTexts(), ["slow", "near", "none"]);
  });
});

test("for a chosen product the batch's table holds what to type into it", async () => {
  const mine = {
    product: "emerson_deltav_standard",
    name: "Emerson DeltaV PID, FORM Standard",
    needs: ["y_span", "u_span"],
    y_span: [0, 200],
    u_span: [0, 100],
  };
  await withPage("#/jobs", {}, async (page) => {
    await page.evaluate((kept) => localStorage.setItem("tunewright-controller", JSON.stringify(kept)), mine);
    await page.reload();
    await page.getByLabel("Design for my controller, Emerson DeltaV PID, FORM Standard").waitFor();
    await page
      .getByLabel(/Drop a CSV of loops here/)
      .setInputFiles({ name: "loops.csv", mimeType: "text/csv", buffer: Buffer.from("name,K,T,L\na,2,100,30\n") });
    await page.getByText("1 loop: 1 tuned", { exact: true }).waitFor();
    await page.getByRole("columnheader", { name: "STRUCTURE" }).waitFor();
    assert.match(await page.getByRole("row", { name: /^1 a/ }).innerText(), /%\/%/);
  });
});

test("a column that is none of loops is refused in the words of the file", async () => {
  await withPage(
    "#/jobs",
    {},
    async (page) => {
      await page
        .getByLabel(/Drop a CSV of loops here/)
        .setInputFiles({ name: "log.csv", mimeType: "text/csv", buffer: Buffer.from("name,K,T,L,Ms\na,1,2,3,1.4\n") });
      const refusal = page.getByRole("alert").filter({ hasText: "Ms" });
      await refusal.waitFor();
      assert.match(await refusal.innerText(), /"Ms" is not a column of loops/);
      assert.doesNotMatch(await refusal.innerText(), /parameters of the call/);
    },
    ["422"],
  );
});

test("loops that failed say why; gain and risk order the table", async () => {
  const batch = await post("v1/batches", {
    name: "unit 8",
    jobs: [
      { name: "good", plant: PLANT, tune: [{ method: "simc" }], baseline: settings },
      { name: "wild", plant: PLANT, tune: [{ method: "ziegler_nichols_step" }], baseline: { ...settings, Kp: 0.2 } },
      { name: "impossible", plant: { type: "fopdt", K: 1, T: -10, L: 9 }, tune: [{ method: "cohen_coon" }] },
      { name: "unread", plant: { type: "fopdt", K: 1 } },
    ],
  });
  await withPage(`#/batches/${batch.id}`, { width: 834, height: 1194 }, async (page) => {
    await page.getByText("4 loops: 2 tuned, 2 failed", { exact: true }).waitFor();
    assert.match(await page.getByRole("row", { name: /unread/ }).innerText(), /T is missing/);
    await page.getByRole("button", { name: "Highest risk" }).click();
    assert.equal((await page.getByRole("rowheader").allInnerTexts())[0], "wild");
    await page.getByRole("button", { name: "Largest improvement over today" }).click();
    assert.equal((await page.getByRole("rowheader").allInnerTexts())[0], "wild");
    assert.equal(await overflow(page), 0);
    // The readable entries run again, as a new batch.
    await page.getByRole("button", { name: "Retry the failed jobs" }).click();
    await page.waitForFunction((old) => !location.hash.includes(old), batch.id);
    await page.getByText("1 loop: 0 tuned, 1 failed", { exact: true }).waitFor();
    await page.getByRole("rowheader", { name: "impossible" }).waitFor(); // rows come after the counts
    assert.deepEqual(await page.getByRole("rowheader").allInnerTexts(), ["impossible"]);
  });
});

test("a limit that is no number is named by its label, and no loop is sent", async () => {
  await withPage("#/jobs", {}, async (page) => {
    for (const [text, sentence] of [
      ["abc", 'Largest Ms "abc" is not a number. Write for example 1.25, 1,25 or 1e-3.'],
      ["0,9", "Largest Ms is 0,9; it must be above 1."],
    ]) {
      await page.getByLabel("Largest Ms").fill(text);
      await page
        .getByLabel(/Drop a CSV of loops here/)
        .setInputFiles({ name: "loops.csv", mimeType: "text/csv", buffer: Buffer.from("name,K,T,L\na,1,10,2\n") });
      await page.getByText(sentence).waitFor();
      assert.equal(await page.locator(".loops .error").innerText(), sentence);
    }
    assert.match(page.url(), /#\/jobs$/);
  });
});

test("a file that is no list of loops is refused where it was dropped", async () => {
  await withPage(
    "#/jobs",
    {},
    async (page) => {
      await page
        .getByLabel(/Drop a CSV of loops here/)
        .setInputFiles({ name: "log.csv", mimeType: "text/csv", buffer: Buffer.from("a,b\n1,2\n") });
      await page.getByRole("alert").filter({ hasText: /K/ }).waitFor();
      await page.getByText("There is no job yet.").waitFor({ state: "detached" });
    },
    ["422"],
  );
});

test("the limit that a refusal names is taken by a button", async () => {
  const job = await post("v1/jobs", {
    plant: { type: "fopdt", K: 1, T: -1, L: 0.2 },
    tune: [{ method: "robust", Ms: 1.2, Mt: 1.2 }],
  });
  const { cure } = job.error;
  assert.ok(cure.options.Ms > 1.2 && cure.options.Ms === cure.options.Mt);
  await withPage(`#/jobs/${job.id}/design`, {}, async (page) => {
    await page.getByRole("button", { name: cure.text }).click();
    await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
    const id = /jobs\/([^/]+)\/design/.exec(page.url())[1];
    const cured = await (await fetch(`${tests.service.base}/v1/jobs/${id}`)).json();
    assert.equal(cured.request.tune[0].Ms, cure.options.Ms);
    assert.equal(await page.getByRole("button", { name: cure.text }).count(), 0);
  });
});

test("the request of what is shown can be taken along as JSON and as a call", async () => {
  const job = await post("v1/jobs", { name: "Jim's loop", plant: PLANT, tune: [{ method: "simc" }] });
  await withPage(`#/jobs/${job.id}/design`, {}, async (page) => {
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    await page.getByText("Request", { exact: true }).click();
    const [file] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Download JSON" }).click(),
    ]);
    assert.deepEqual(JSON.parse(readFileSync(await file.path(), "utf8")), job.request);
    await page.getByRole("button", { name: "Copy as curl" }).click();
    await page.getByRole("button", { name: "Copied" }).waitFor();
    const call = await page.evaluate(() => navigator.clipboard.readText());
    const { execFileSync } = await import("node:child_process");
    const again = JSON.parse(execFileSync("sh", ["-c", call], { encoding: "utf8" }));
    assert.equal(again.status, "succeeded");
    assert.deepEqual(again.request, job.request);
  });
});
