// Each kind of input, to its result, by roles and names only, in common window sizes and themes.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import { accessibilityViolations, browserTests, overflow, root } from "../../harness.mjs";

const { withPage } = browserTests();

const press = (page, name) => page.getByRole("button", { name, exact: true }).click();
const file = (name, folder) => ({ name, mimeType: "text/csv", buffer: readFileSync(path.join(root, folder, name)) });

/** A controller is there, with a verdict and settings. */
async function designed(page) {
  await page.getByRole("heading", { name: /^Settings to enter/ }).waitFor();
  assert.notEqual((await page.getByRole("region", { name: "Verdict" }).innerText()).trim(), "");
}

const WAYS = {
  async "a model in one line"(page) {
    await page.getByRole("textbox", { name: /in one line/i }).fill("2 e^(-3s)/((10s+1)(2s+1))");
    await press(page, "Tune this model");
    await designed(page);
  },
  async "a recorded test"(page) {
    const [chooser] = await Promise.all([
      page.waitForEvent("filechooser"),
      page
        .getByRole("button", { name: /^Choose / })
        .first()
        .click(),
    ]);
    await chooser.setFiles(file("tclab-step.csv", "api/examples"));
    await press(page, "Use and tune");
    await designed(page);
  },
  async equations(page) {
    const form = page.getByRole("form", { name: "Equations" });
    await form.getByLabel("Fill from an example").selectOption({ index: 1 });
    await press(page, "Tune these equations");
    await designed(page);
  },
  async "an example"(page) {
    await page
      .getByRole("button", { name: /^Tune: / })
      .first()
      .click();
    await designed(page);
  },
  async "a relay test"(page) {
    await page.getByRole("link", { name: "Relay test" }).click();
    await press(page, "Simulate");
    await press(page, "Identify this record");
    await press(page, "Use and tune");
    await designed(page);
  },
  async "a CSV of loops"(page) {
    await page.getByRole("link", { name: "Jobs", exact: true }).click();
    await page.getByLabel(/Drop a CSV of loops here/).setInputFiles(file("loops.csv", "docs"));
    await page.getByText("5 loops: 5 tuned", { exact: true }).waitFor();
    await page.getByRole("link", { name: "FIC-7", exact: true }).click();
    await designed(page);
  },
};

const WINDOWS = [
  ["desktop", { width: 1440, height: 900 }],
  ["tablet", { width: 834, height: 1194 }],
  ["phone", { width: 390, height: 844 }],
];

// Every window size is used with both themes, and every kind of input with three window sizes; all combinations would
// only be slower.
Object.entries(WAYS).forEach(([way, walk], place) => {
  WINDOWS.forEach(([window, size], turn) => {
    const scheme = (place + turn) % 2 === 0 ? "light" : "dark";
    test(`${way}: to the end on a ${window}, ${scheme}`, async () => {
      await withPage("", { ...size, scheme }, async (page) => {
        await walk(page);
        assert.equal(await overflow(page), 0);
        assert.deepEqual(await accessibilityViolations(page), []);
      });
    });
  });
});
