// Answers that come late, or not at first: each belongs to the screen that asked, and lost data are loaded again.
import assert from "node:assert/strict";
import test from "node:test";
import { browserTests } from "../harness.mjs";

const tests = browserTests();
const { withPage, post } = tests;

const PLANT = { type: "fopdt", K: 9, T: 90, L: 9 };
const screen = (page, name) =>
  page.getByRole("navigation", { name: "Screens" }).getByRole("link", { name, exact: true });

/** Delays calls to these addresses until they are released; `done` resolves when the page has had their answers. */
async function hold(page, pattern) {
  let letGo;
  const gate = new Promise((resolve) => (letGo = resolve));
  await page.route(pattern, async (route) => {
    await gate;
    await route.continue();
  });
  return async (answered) => {
    const reply = page.waitForResponse(answered);
    letGo();
    await (await reply).finished();
    // The page processes an answer before the next frame is drawn.
    await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
  };
}

test("a job that fails to open leaves another screen as it is", async () => {
  await withPage(
    "",
    {},
    async (page) => {
      const release = await hold(page, "**/v1/jobs/nothere");
      await page.evaluate(() => (location.hash = "#/jobs/nothere/identify"));
      await screen(page, "Methods").click();
      await page.getByRole("heading", { level: 1, name: "Methods" }).waitFor();
      await release(/v1\/jobs\/nothere/);
      assert.equal(await page.getByRole("heading", { level: 1 }).innerText(), "Methods");
      assert.match(page.url(), /#\/methods$/);
    },
    ["404"],
  );
});

for (const [from, address] of [
  ["Start", ""],
  ["Relay test", "#/relay"],
])
  test(`a line that is read after ${from} was left does not touch the address`, async () => {
    await withPage(address, {}, async (page) => {
      await page.waitForLoadState("networkidle");
      const release = await hold(page, "**/v1/plants/**");
      await page.getByLabel("Model in one line").fill("3 e^(-1s)/(5s+1)");
      await screen(page, "Methods").click();
      await page.getByRole("heading", { level: 1, name: "Methods" }).waitFor();
      await release(/v1\/plants\//);
      assert.match(page.url(), /#\/methods$/);
    });
  });

test("a job that comes after its form was left does not replace what is typed", async () => {
  const job = await post("v1/jobs", { name: "OLD", plant: PLANT, tune: [{ method: "simc" }] });
  await withPage("", {}, async (page) => {
    const release = await hold(page, `**/v1/jobs/${job.id}`);
    await page.evaluate((id) => (location.hash = `#/jobs/${id}/edit`), job.id);
    await page.getByRole("link", { name: "Tunewright" }).click();
    await page.getByLabel("Loop name").fill("MINE");
    await release(new RegExp(job.id));
    assert.equal(await page.getByLabel("Loop name").inputValue(), "MINE");
  });
});

/** Calls to these addresses fail as without a service until it is back. */
async function lose(page, pattern) {
  let lost = true;
  await page.route(pattern, (route) => (lost ? route.abort() : route.continue()));
  return () => (lost = false);
}
const notConnected = (page) => page.getByText("Not connected to the service.");

test("a batch is followed again when the connection is back", async () => {
  const batch = await post("v1/batches", { name: "unit 9", jobs: [{ plant: PLANT, tune: [{ method: "simc" }] }] });
  await withPage(
    "",
    {},
    async (page) => {
      const back = await lose(page, "**/v1/batches/*");
      await page.evaluate((id) => (location.hash = `#/batches/${id}`), batch.id);
      await notConnected(page).waitFor();
      back();
      await page.getByText("1 loop: 1 tuned", { exact: true }).waitFor();
      await notConnected(page).waitFor({ state: "hidden" });
    },
    ["ERR_FAILED"],
  );
});

test("Jobs takes back that it was not connected, by itself", async () => {
  await post("v1/jobs", { name: "TIC-55", plant: PLANT, tune: [{ method: "simc" }] });
  await withPage(
    "",
    {},
    async (page) => {
      const back = await lose(page, "**/v1/jobs?*");
      await screen(page, "Jobs").click();
      await notConnected(page).waitFor();
      back();
      await page.getByRole("link", { name: "TIC-55", exact: true }).waitFor();
      await notConnected(page).waitFor({ state: "hidden" });
    },
    ["ERR_FAILED"],
  );
});

test("lists that could not be had at first are asked for again", async () => {
  await withPage(
    "#/jobs",
    {},
    async (page) => {
      const back = await lose(page, "**/v1/methods");
      await page.goto(`${tests.service.base}/?again#/methods`);
      await page.getByText("The service's list of methods could not be read").waitFor();
      back();
      await page.getByRole("link", { name: "Revised IMC", exact: false }).first().waitFor();
      await screen(page, "Start").click();
      await page.getByText(/^Compare with/).waitFor();
      assert.equal(await page.getByText("The service's list of methods could not be read").isVisible(), false);
    },
    ["ERR_FAILED"],
  );
});

/** Answers calls about the next posted job with a search under way, until it is let go. */
async function slowSearch(page) {
  let id = null;
  let slow = true;
  const running = (job) => ({ ...job, status: "running", result: undefined, finished_at: null, progress: { stage: "tune", fraction: 0.4 } });
  await page.route(/\/v1\/jobs(\/[^/]+(\/cancel)?)?$/, async (route) => {
    const request = route.request();
    const isNew = request.method() === "POST" && request.url().endsWith("/v1/jobs");
    const isIts = id !== null && request.url().includes(id);
    if (!isNew && !isIts) return route.continue();
    if (isIts && request.url().endsWith("/cancel")) {
      slow = false;
      const job = await (await fetch(`${tests.service.base}/v1/jobs/${id}`)).json();
      return route.fulfill({ json: { ...job, status: "cancelled", result: undefined } });
    }
    const response = await route.fetch();
    const job = await response.json();
    if (isNew) id = job.id;
    const ended = stopped ? { ...job, status: "cancelled", result: undefined } : job;
    return route.fulfill({ response, json: slow ? running(job) : ended });
  });
  let stopped = false;
  page.on("request", (request) => (stopped ||= request.url().endsWith("/cancel")));
  return { letGo: () => (slow = false), wasStopped: () => stopped };
}

for (const end of ["ended", "stopped"])
  test(`a slow design for another controller shows its progress beside the present one, until it is ${end}`, async () => {
    await withPage("#/new/fopdt?K=2&T=10&L=3", {}, async (page) => {
      await page.waitForLoadState("networkidle");
      await page.getByRole("button", { name: "Tune this model" }).click();
      await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
      const picker = page.getByRole("combobox", { name: "Maker and product" });
      await picker.fill("simple-pid");
      await page.getByRole("option").first().waitFor();
      await picker.press("Enter");
      const search = await slowSearch(page);
      const before = page.url();
      await page.getByRole("button", { name: "Design for this controller" }).click();
      await page.getByRole("heading", { name: "Searching for the best controller: 40 %" }).waitFor();
      assert.equal(page.url(), before, "the present design stays");
      assert.ok(await page.locator("table.typed").isVisible());
      if (end === "ended") {
        search.letGo();
        await page.waitForFunction((was) => location.href !== was, before);
      } else {
        await page.getByRole("button", { name: "Cancel" }).click();
        await page.getByText("The search was stopped; the design stays as it was.").waitFor();
        assert.ok(search.wasStopped());
        assert.equal(page.url(), before);
      }
      await page.getByRole("button", { name: "Cancel" }).waitFor({ state: "hidden" });
    });
  });
