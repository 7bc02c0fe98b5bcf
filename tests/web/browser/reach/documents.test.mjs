// The documents as pages of the service: every link leads somewhere, and each page is as clean as the page itself.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import { accessibilityViolations, browserTests, overflow, root, WINDOWS } from "../../harness.mjs";

const tests = browserTests();
const { withPage } = tests;

const pages = ["", "adr/"].flatMap((folder) =>
  readdirSync(path.join(root, "docs", folder))
    .filter((name) => name.endsWith(".md"))
    .map((name) => `documents/${folder}${name.replace(".md", ".html")}`),
);

test("every document is served, and every link and picture in it leads to something", async () => {
  const known = new Map();
  const read = async (address) => {
    if (!known.has(address)) {
      const answer = await fetch(address);
      known.set(address, answer.ok ? await answer.text() : null);
    }
    return known.get(address);
  };
  const broken = [];
  for (const page of pages) {
    const base = `${tests.service.base}/${page}`;
    const text = await read(base);
    assert.ok(text?.includes("<main"), page);
    for (const [, address] of text.matchAll(/(?:href|src)="([^"]+)"/g)) {
      const target = new URL(address.replaceAll("&amp;", "&"), base);
      if (target.origin !== tests.service.base) continue;
      const there = await read(target.origin + target.pathname);
      const anchor = decodeURIComponent(target.hash.slice(1));
      const found = there !== null && (anchor === "" || anchor.startsWith("/") || there.includes(`id="${anchor}"`));
      if (!found) broken.push(`${page}: ${address}`);
    }
  }
  assert.deepEqual(broken, []);
});

for (const [window, options] of WINDOWS)
  test(`the documents have no fault and fit their window: ${window}`, async () => {
    await withPage("documents/README.html", options, async (page) => {
      for (const name of ["README", "page", "methods", "symbols", "tutorial", "api"]) {
        await page.goto(`${tests.service.base}/documents/${name}.html`);
        await page.locator("main h1").waitFor();
        assert.deepEqual(await accessibilityViolations(page), [], name);
        assert.equal(await overflow(page), 0, name);
      }
    });
  });
