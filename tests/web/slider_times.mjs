// Prints the time from a slider's move to its drawn frame: from the input event, through the service's answer, to the
// end of the frame that shows it. `node slider_times.mjs` in a real Chromium with the real service; nothing is
// asserted, because machines differ.
import { launchBrowser, openPage, startService } from "./harness.mjs";

const PLANTS = [
  ["first order with dead time", { type: "fopdt", K: 1.25, T: 40, L: 8 }],
  ["fourth order", { type: "transfer_function", num: [1], den: [1, 4, 6, 4, 1] }],
];
const SLIDERS = [
  ["Ms, designed anew", "Robustness Ms, slider"],
  ["Kp by hand", "Kp, slider"],
];
const STEPS = 100;
const LATENCY_MS = 60;
const DRAG_MS = 3000;

const service = await startService();
const browser = await launchBrowser();
try {
  for (const [name, plant] of PLANTS) {
    const id = await postJob(plant);
    for (const [what, label] of SLIDERS) {
      for (const latency of [0, LATENCY_MS]) await measure(`${name}: ${what}`, id, label, latency);
    }
  }
} finally {
  await browser.close();
  await service.stop();
}

async function measure(what, id, label, latency) {
  const { page, close } = await openPage(browser);
  await page.goto(`${service.base}/#/jobs/${id}/design`);
  const slider = page.locator(".controls").getByRole("slider", { name: label });
  await slider.waitFor();
  await page.waitForLoadState("networkidle");
  if (latency > 0)
    await page.route(/v1\/(design|evaluate)$/, async (route) => {
      await new Promise((resolve) => setTimeout(resolve, latency));
      await route.continue();
    });
  await slider.evaluate(watch);
  const box = await slider.boundingBox();
  const to = (share) => page.mouse.move(box.x + box.width * share, box.y + box.height / 2);
  await to(0.3);
  await page.mouse.down();
  // Slowly: each move is drawn before the next one.
  for (let step = 0; step < STEPS; step += 1) {
    await to(0.25 + 0.4 * Math.abs(Math.sin(step / 20)));
    await page.evaluate(() => globalThis.drawn());
  }
  const times = (await page.evaluate(() => globalThis.times.splice(0))).sort((a, b) => a - b);
  // As fast as a person: the number of frames per second with new content.
  const start = performance.now();
  for (let step = 0; performance.now() - start < DRAG_MS; step += 1) await to(0.25 + 0.45 * Math.abs(Math.sin(step / 60)));
  const redraws = (1000 * (await page.evaluate(() => globalThis.times.length))) / (performance.now() - start);
  await page.mouse.up();
  await close();
  const at = (share) => times[Math.floor(share * (times.length - 1))].toFixed(1);
  const far = latency > 0 ? ` with ${latency} ms of latency` : "";
  console.log(`${what}${far}: median ${at(0.5)} ms, p95 ${at(0.95)} ms to the drawn frame; ${redraws.toFixed(0)} redraws a second in a drag`);
}

async function postJob(plant) {
  const answer = await fetch(`${service.base}/v1/jobs`, {
    method: "POST",
    headers: { "Content-Type": "application/json", Prefer: "wait=20" },
    body: JSON.stringify({ plant, tune: [{ method: "robust" }], baseline: { form: "ideal", Kp: 0.5, Ti: 20 } }),
  });
  return (await answer.json()).id;
}

/** In the page: from an input's time stamp to the first task after the frame that shows its result. */
function watch(range) {
  globalThis.times = [];
  let since = null;
  let waiting = () => undefined;
  range.addEventListener("input", (event) => (since = event.timeStamp), true);
  new MutationObserver(() => {
    const start = since;
    requestAnimationFrame(() => {
      const { port1, port2 } = new MessageChannel();
      port1.onmessage = () => {
        if (start !== null) globalThis.times.push(performance.now() - start);
        waiting();
      };
      port2.postMessage(0);
    });
  }).observe(document.querySelector(".main-column svg.canvas > g"), { childList: true, subtree: true, attributes: true });
  // A move by less than a step draws nothing.
  globalThis.drawn = () =>
    new Promise((resolve) => {
      waiting = resolve;
      setTimeout(resolve, 150);
    });
}
