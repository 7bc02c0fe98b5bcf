// The displayed Design, and the request that it hands out: posted again, it must give the same result to the last
// digit.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";

/** Waits until no call of the page is in progress; `watchCalls` must be called before the page's first call. */
export function watchCalls(page) {
  const calls = new Set();
  page.on("request", (request) => request.url().includes("/v1/") && calls.add(request));
  for (const event of ["requestfinished", "requestfailed"]) page.on(event, (request) => calls.delete(request));
  return async () => {
    for (let quiet = 0, round = 0; quiet < 6; round += 1) {
      if (round > 1200) throw new Error(`Calls do not end: ${[...calls].map((call) => call.url()).join(", ")}`);
      await page.waitForTimeout(50);
      quiet = calls.size === 0 ? quiet + 1 : 0;
    }
  };
}

/** The request that the menu hands out. */
export async function requestHandedOut(page) {
  const menu = page.locator("details.request-menu");
  await menu.locator("summary").click();
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    menu.getByRole("button", { name: "Download JSON" }).click(),
  ]);
  await page.keyboard.press("Escape");
  if (await menu.evaluate((element) => element.open)) await menu.locator("summary").click();
  return JSON.parse(await readFile(await file.path(), "utf8"));
}

const plain = (text) => text.replaceAll("−", "-").replaceAll(" ", " ").trim();

/** Settings in the ideal form, or in a product the values to type, sorted; and the verdict's sentences, as displayed. */
export async function designOnScreen(page) {
  const settings = await page
    .locator("table.typed tbody tr")
    .evaluateAll((rows) =>
      rows.map((row) => [row.querySelector("th").textContent.replace(/ \(.*/, ""), row.querySelector("td.value").textContent]),
    );
  const head = await page.locator(".verdict > h2").evaluate((node) => {
    const copy = node.cloneNode(true);
    copy.querySelector(".who")?.remove();
    return copy.textContent;
  });
  const others = await page.locator(".verdict > p:not(.trouble) > span").allTextContents();
  return {
    settings: (await page.getByRole("heading", { name: /^Type into/ }).count())
      ? settings.map(([, value]) => plain(value)).sort()
      : Object.fromEntries(settings.map(([name, value]) => [name, plain(value)])),
    verdict: [head, ...others].map(plain),
  };
}

const five = (value) => String(Number(value.toPrecision(5)));

/** The same data from an entry of an answer. */
export function designAnswered({ controller, verdict, as_entered: entered }) {
  const { Kp, Ti, Td, filter, b, setpoint_filter: lag } = controller;
  if (entered) return { settings: Object.values(entered.as_typed).map(plain).sort(), verdict: verdict.map(({ text }) => plain(text)) };
  return {
    settings: {
      Kp: five(Kp),
      Ti: Ti === null || Ti === undefined ? "off" : five(Ti),
      Td: five(Td ?? 0),
      ...(typeof filter?.Tf === "number" ? { Tf: five(filter.Tf) } : {}),
      ...(typeof b === "number" && b !== 1 ? { b: five(b) } : {}),
      ...(typeof lag?.T === "number" ? { "Set-point filter": five(lag.T) } : {}),
    },
    verdict: verdict.map((finding) => plain(finding.text)),
  };
}

/** The displayed request gives the displayed design and verdict. `post`: to the service. */
export async function assertRequestIsShown(page, post, what) {
  const request = await requestHandedOut(page);
  const shown = await designOnScreen(page);
  let answer = await post("v1/jobs", request);
  // A search for a product may take longer than one call waits.
  while (answer.status === "queued" || answer.status === "running") {
    await page.waitForTimeout(500);
    answer = await (await page.request.get(new URL(`v1/jobs/${answer.id}`, page.url()).href)).json();
  }
  const entries = answer.result?.controllers;
  assert.ok(entries, `${what}: ${JSON.stringify(answer).slice(0, 400)}`);
  const answered = entries.filter((entry) => entry.controller).map(designAnswered);
  const same = answered.filter((entry) => JSON.stringify(entry.settings) === JSON.stringify(shown.settings));
  assert.ok(same.length > 0, `${what}: ${JSON.stringify(shown.settings)} on the screen, ${JSON.stringify(answered)} answered`);
  assert.ok(
    same.some((entry) => JSON.stringify(entry.verdict) === JSON.stringify(shown.verdict)),
    `${what}: "${shown.verdict.join(" | ")}" on the screen, "${same.map((entry) => entry.verdict.join(" | ")).join('" or "')}" answered`,
  );
  return { request, answer };
}
