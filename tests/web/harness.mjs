// Runs the page's tests and gives the browser tests what they need: the real service, a real browser, one monitored
// page. `node harness.mjs unit` bundles unit/*.test.ts (Node 18 strips no types) and runs them; `node harness.mjs
// browser` runs browser/*.test.mjs.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import path from "node:path";
import { after, before } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
export const root = path.resolve(here, "../..");
// The tools are those of the front end; the tests are outside its folder.
const fromWeb = createRequire(path.join(root, "web/package.json"));

async function bundleUnitTests() {
  const { build } = fromWeb("esbuild");
  const outdir = path.join(root, "build/web-unit-tests");
  rmSync(outdir, { recursive: true, force: true });
  mkdirSync(outdir, { recursive: true });
  const folder = path.join(here, "unit");
  const entryPoints = readdirSync(folder, { recursive: true })
    .filter((name) => name.endsWith(".test.ts"))
    .map((name) => path.join(folder, name));
  await build({
    entryPoints,
    outdir,
    bundle: true,
    platform: "node",
    format: "esm",
    target: "node18",
    outExtension: { ".js": ".mjs" },
    logLevel: "warning",
  });
  return readdirSync(outdir, { recursive: true })
    .filter((name) => name.endsWith(".mjs"))
    .map((name) => path.join(outdir, name));
}

function runTests(files, environment = {}) {
  if (files.length === 0) throw new Error("There are no tests to run.");
  const run = spawnSync(process.execPath, ["--test", ...files], {
    stdio: "inherit",
    env: { ...process.env, TUNEWRIGHT_ROOT: root, ...environment },
  });
  process.exitCode = run.status ?? 1;
}

/** The path of the service's binary; fails with instructions if it does not exist. */
export function serviceBinary() {
  const binary = process.env.TUNEWRIGHT_BIN ?? path.join(root, "build/release/tunewright");
  if (!existsSync(binary))
    throw new Error(`There is no service at ${binary}. Build it first, or name another with TUNEWRIGHT_BIN.`);
  return binary;
}

function freePort() {
  return new Promise((resolve, reject) => {
    const server = createServer();
    server.on("error", reject);
    server.listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

/** Starts the service on a free loopback port with an empty store and the given options. `stop` ends it and removes
    the store. */
export async function startService(options = []) {
  const web = path.join(root, "build/web");
  if (!existsSync(path.join(web, "index.html")))
    throw new Error("The page is not built: run `npm run build` in web/ first.");
  const port = await freePort();
  const folder = mkdtempSync(path.join(tmpdir(), "tunewright-web-test-"));
  const base = `http://127.0.0.1:${port}`;
  const child = spawn(
    serviceBinary(),
    ["serve", "--listen", `127.0.0.1:${port}`, "--store", `sqlite:${path.join(folder, "jobs.db")}`, "--web", web, ...options],
    {
      stdio: ["ignore", "pipe", "pipe"],
    },
  );
  let log = "";
  let ended = null;
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (chunk) => (log += chunk));
  const exit = new Promise((resolve) => {
    child.on("error", (error) => resolve((ended = String(error))));
    child.on("exit", (code, signal) => resolve((ended = `ended with ${code ?? signal}`)));
  });
  for (let attempt = 0; ; attempt += 1) {
    if (ended !== null || attempt > 300) {
      child.kill("SIGKILL");
      throw new Error(`The service did not start (${ended ?? "no answer"}):\n${log}`);
    }
    try {
      if ((await fetch(`${base}/healthz`)).ok) break;
    } catch {
      // Not listening yet.
    }
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  return {
    base,
    log: () => log,
    async stop() {
      child.kill("SIGTERM");
      const killer = setTimeout(() => child.kill("SIGKILL"), 10_000);
      await exit;
      clearTimeout(killer);
      rmSync(folder, { recursive: true, force: true });
    },
  };
}

export function launchBrowser() {
  const { chromium } = fromWeb("playwright-core");
  return chromium.launch({
    executablePath: process.env.CHROMIUM_BIN ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu"],
  });
}

/**
 * A page in a fresh context that records all faults: console errors and warnings, uncaught exceptions, violations of
 * the content security policy, answers of the service from 500 on.
 */
export async function openPage(browser, { scheme = "light", width = 1440, height = 900, hasTouch = false } = {}) {
  const viewport = { width, height };
  const context = await browser.newContext({ viewport, colorScheme: scheme, acceptDownloads: true, hasTouch });
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  const faults = [];
  await page.addInitScript(() => {
    globalThis.policyViolations = [];
    document.addEventListener("securitypolicyviolation", (event) =>
      globalThis.policyViolations.push(`${event.violatedDirective}: ${event.blockedURI || event.sample}`),
    );
  });
  page.on("console", (message) => {
    if (message.type() === "error" || message.type() === "warning") faults.push(`${message.type()}: ${message.text()}`);
  });
  page.on("pageerror", (error) => faults.push(`exception: ${error.message}`));
  page.on("response", (response) => {
    if (response.status() >= 500) faults.push(`${response.status()} from ${response.url()}`);
  });
  return {
    page,
    async faults() {
      return [...faults, ...(await page.evaluate(() => globalThis.policyViolations)).map((text) => `policy: ${text}`)];
    },
    close: () => context.close(),
  };
}

/**
 * Runs a test body on a fresh page at an address of the service; the page must end without a fault. Chromium reports
 * every 4xx answer on the console: those that the body provokes are named in `expected`.
 */
export async function withPage(service, browser, address, options, body, expected = []) {
  const opened = await openPage(browser, options);
  try {
    await opened.page.goto(`${service.base}/${address}`);
    await body(opened.page);
    const faults = (await opened.faults()).filter((fault) => !expected.some((status) => fault.includes(status)));
    if (faults.length > 0) throw new Error(`The page met faults:\n${faults.join("\n")}`);
  } finally {
    // A call that a test answers itself may still be in progress; its answer is dropped.
    await opened.page.unrouteAll({ behavior: "ignoreErrors" });
    await opened.close();
  }
}

/** Starts the service and the browser before a file's tests and ends them afterwards. Both are available once a test
    runs. */
export function browserTests(options = []) {
  const shared = { service: null, browser: null };
  before(async () => {
    shared.service = await startService(options);
    shared.browser = await launchBrowser();
  });
  after(async () => {
    await shared.browser?.close();
    await shared.service?.stop();
  });
  return {
    get service() {
      return shared.service;
    },
    get browser() {
      return shared.browser;
    },
    /** A page at an address of the service; see withPage. */
    withPage: (address, options, body, expected) =>
      withPage(shared.service, shared.browser, address, options, body, expected),
    /** The answer of the API to a body; for jobs after their end. */
    post: async (address, body) =>
      (
        await fetch(`${shared.service.base}/${address}`, {
          method: "POST",
          headers: { "Content-Type": "application/json", Prefer: "wait=20" },
          body: JSON.stringify(body),
        })
      ).json(),
    /** The answer of the API for the job in the page's address, once the job has ended: the page shows it earlier. */
    async jobOf(page) {
      const id = /#\/jobs\/([^/]+)\/(?:design|compare)/.exec(page.url())?.[1];
      if (!id) throw new Error(`There is no job in ${page.url()}.`);
      for (const until = Date.now() + 120_000; ; await page.waitForTimeout(200)) {
        const job = await (await fetch(`${shared.service.base}/v1/jobs/${id}`)).json();
        if (!["queued", "running"].includes(job.status) || Date.now() > until) return job;
      }
    },
  };
}

/** Window sizes in which every screen is tested. */
export const WINDOWS = [
  ["desktop", {}],
  ["dark desktop", { scheme: "dark" }],
  ["tablet", { width: 834, height: 1194 }],
  ["phone", { width: 400, height: 860 }],
];

/** The number of pixels by which the page is wider than its window. */
export const overflow = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

/** Unfolds the part of Design below its plots. */
export async function openMore(page) {
  const more = page.locator("details.more");
  await more.waitFor();
  if (!(await more.evaluate((element) => element.open))) await more.locator("> summary").click();
}

/** Drops a text file on an element. */
export async function dropFile(page, selector, name, text) {
  const transfer = await page.evaluateHandle(
    ([fileName, content]) => {
      const data = new DataTransfer();
      data.items.add(new File([content], fileName, { type: "text/csv" }));
      return data;
    },
    [name, text],
  );
  await page.locator(selector).dispatchEvent("drop", { dataTransfer: transfer });
}

/** The number of traces in a plot; a path that is not valid fails. */
async function drawnTraces(page, title) {
  const plot = page.locator("section.plot").filter({ has: page.getByRole("heading", { name: title, exact: true }) });
  const paths = await plot.locator("svg.canvas path").evaluateAll((list) => list.map((item) => item.getAttribute("d")));
  const broken = paths.find((d) => /NaN|Infinity|undefined/.test(d));
  if (broken) throw new Error(`${title}: ${broken.slice(0, 200)}`);
  return paths.filter((d) => (d.match(/L/g) ?? []).length > 20).length;
}

/** Waits at most 5 s until a plot shows this number of traces: plots are drawn a moment after a change. */
export async function tracesShown(page, title, count) {
  const until = Date.now() + 5000;
  let drawn = await drawnTraces(page, title);
  while (drawn !== count && Date.now() < until) {
    await page.waitForTimeout(50);
    drawn = await drawnTraces(page, title);
  }
  assert.equal(drawn, count, `traces of the plot "${title}"`);
}

/** The violations that axe-core finds in the page, one line each. */
export async function accessibilityViolations(page) {
  const source = readFileSync(fromWeb.resolve("axe-core/axe.min.js"), "utf8");
  await page.evaluate(source);
  const violations = await page.evaluate(async () => (await globalThis.axe.run(document)).violations);
  return violations.map(
    (violation) =>
      `${violation.id}: ${violation.help} (${violation.nodes.map((item) => item.target.join(" ")).join(", ")})`,
  );
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  if (process.argv[2] === "unit") {
    runTests(await bundleUnitTests());
  } else if (process.argv[2] === "browser") {
    const folder = path.join(here, "browser");
    runTests(
      readdirSync(folder, { recursive: true })
        .filter((name) => name.endsWith(".test.mjs"))
        .map((name) => path.join(folder, name)),
    );
  } else {
    console.error("Say which tests: unit or browser.");
    process.exitCode = 2;
  }
}
