import assert from "node:assert/strict";
import test from "node:test";
import { browserTests, dropFile } from "../../harness.mjs";
import { candidatesShown, identified, rows, stepTest } from "../../step_record.mjs";

const { withPage, jobOf } = browserTests();


/** Replaces the record by another text, and identifies it. */
async function replaceText(page, text) {
  await page.getByText("How the record is read").click();
  await page.getByLabel("The record as text").fill(text);
  const answered = identified(page);
  await page.getByRole("button", { name: "Identify again" }).click();
  return (await answered).request().postDataJSON();
}

test("a longer record in place of the first is used whole, also with another model", async () => {
  await withPage("", {}, async (page) => {
    const [from, to] = ["Use from", "Use up to"].map((name) => page.getByRole("textbox", { name }));
    await dropFile(page, ".drop", "short.csv", ["t,u,y", ...rows.slice(0, 200)].join("\n"));
    await candidatesShown(page);
    assert.equal(await to.inputValue(), "199");
    const first = identified(page);
    await from.fill("10");
    await from.press("Enter");
    await first;
    const asked = await replaceText(page, stepTest);
    assert.deepEqual([asked.record.from, asked.record.to], [undefined, undefined]);
    await page.waitForFunction(() => document.querySelectorAll(".part input[type=text]")[1].value === "399");
    assert.equal(await from.inputValue(), "0");
    const second = identified(page);
    await page.getByLabel("Model", { exact: true }).selectOption("fopdt");
    const again = (await second).request().postDataJSON();
    assert.deepEqual([again.record.from, again.record.to, again.identify.model], [undefined, undefined, "fopdt"]);
    // A chosen part of the record remains chosen.
    const third = identified(page);
    await to.fill("249");
    await to.press("Enter");
    await third;
    const fourth = identified(page);
    await page.getByRole("button", { name: "Identify again" }).click();
    assert.equal((await fourth).request().postDataJSON().record.to, 249);
  });
});

test("Use and tune takes the model that is shown, not what was typed since", async () => {
  await withPage("", {}, async (page) => {
    const answered = identified(page);
    await dropFile(page, ".drop", "step.csv", stepTest);
    const { model } = await (await answered).json();
    await candidatesShown(page);
    await page.getByText("How the record is read").click();
    await page.getByRole("textbox", { name: "y before" }).fill("10");
    await page.getByRole("button", { name: "Use and tune" }).click();
    await page.getByRole("heading", { name: "Model from the record" }).waitFor();
    const { request, result } = await jobOf(page);
    assert.equal(request.record.y0, undefined);
    assert.deepEqual(result.model.plant, model.plant);
  });
});

test("candidate and check box are as they were chosen after Back, and the record after a reload", async () => {
  await withPage("", {}, async (page) => {
    await page.getByLabel("Loop name").fill("TIC-9");
    await page.getByLabel("Unit of y").fill("degC");
    await dropFile(page, ".drop", "step.csv", stepTest);
    await candidatesShown(page);
    const choice = page.getByRole("group", { name: "Which model to use" });
    const region = page.getByRole("checkbox", { name: /^Always meet the limits for every model/ });
    const other = choice.locator("label:not(:has(:checked)):visible").first();
    const name = await other.locator("strong").innerText();
    await other.locator("input").check();
    await region.check();
    await page.getByRole("navigation", { name: "Screens" }).getByRole("link", { name: "Methods" }).click();
    await page.waitForURL(/methods/);
    await page.goBack();
    await candidatesShown(page);
    await choice.locator("label", { has: page.locator(":checked") }).filter({ hasText: name }).waitFor();
    assert.ok(await region.isChecked());

    await page.reload();
    await candidatesShown(page);
    await page.getByRole("heading", { name: "Identify: TIC-9" }).waitFor();
    await page.getByRole("button", { name: "Use and tune" }).click();
    await page.getByRole("heading", { name: "Model from the record" }).waitFor();
    const { request } = await jobOf(page);
    assert.equal(request.record.csv, stepTest);
    assert.deepEqual([request.name, request.units], ["TIC-9", { y: "degC" }]);
  });
});
