import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import test, { after } from "node:test";
import { accessibilityViolations, browserTests, serviceBinary } from "../harness.mjs";

const folder = mkdtempSync(path.join(tmpdir(), "tunewright-keys-"));
after(() => rmSync(folder, { recursive: true, force: true }));
const file = path.join(folder, "keys");
const key = spawnSync(serviceBinary(), ["key", "ann", "--keys", file], { encoding: "utf8" }).stdout.trim();
const { withPage } = browserTests(["--auth", "keys", "--keys", file]);

test("a service with keys asks for one, says when it is wrong, and tunes with the right one", async () => {
  await withPage(
    "#/new/fopdt?K=1&T=10&L=2",
    {},
    async (page) => {
      const dialog = page.getByRole("dialog", { name: "This service asks for a key" });
      await dialog.waitFor();
      assert.deepEqual(await accessibilityViolations(page), []);
      await dialog.getByLabel("Key").fill("tw_wrong");
      await dialog.getByRole("button", { name: "Use this key" }).click();
      await page.getByText("That key is not known here. Try another one.").waitFor();
      await page.getByLabel("Key", { exact: true }).fill(key);
      await page.getByRole("button", { name: "Use this key" }).click();
      await page.getByRole("button", { name: "Tune this model" }).click();
      await page.waitForURL(/#\/jobs\/[^/]+\/design/);
      await page.getByRole("heading", { name: /Settings|Controller/ }).first().waitFor();
      assert.equal(await page.evaluate(() => sessionStorage.getItem("tunewright-key")), key);
      assert.equal(await page.locator("dialog").count(), 0);
    },
    ["401"],
  );
});
