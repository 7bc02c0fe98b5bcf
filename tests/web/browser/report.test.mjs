// The report for its reader: the link from a result, without scripts, printed on A4 and Letter.
import assert from "node:assert/strict";
import test from "node:test";
import { accessibilityViolations, browserTests, openPage, overflow } from "../harness.mjs";

const tests = browserTests();

const REQUEST = {
  name: "TIC-101 <b>&",
  units: { time: "s", u: "%", y: "°C" },
  plant: "2 e^(-3s)/((10s+1)(2s+1))",
  tune: [{ method: "robust" }, { method: "simc" }],
  baseline: { form: "ideal", Kp: 0.6, Ti: 15 },
};

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

test("a screen with a result leads to the report of the entry that it shows", async () => {
  const job = await tuned(REQUEST);
  await tests.withPage(`#/jobs/${job.id}/design?entry=1`, {}, async (page) => {
    const opened = page.waitForEvent("popup");
    await page.getByRole("link", { name: "Report", exact: true }).click();
    const report = await opened;
    await report.getByRole("heading", { name: "TIC-101 <b>&: tuning report" }).waitFor();
    assert.match(report.url(), /report\.html\?controller=1$/);
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
      assert.equal(await link.getAttribute("href"), `v1/jobs/${job.id}/report.html?controller=${index}`);
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
