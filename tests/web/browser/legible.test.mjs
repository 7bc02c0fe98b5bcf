// Everything on the screen can be read: menus and help inside the window, tables whole, long names and units in their
// place.
import assert from "node:assert/strict";
import test from "node:test";
import { openDesign, PLANT } from "../design_page.mjs";
import { browserTests, openMore, overflow } from "../harness.mjs";

const tests = browserTests();
const { withPage, post } = tests;

const SIZES = [
  ["1440 x 900", {}],
  ["1280 x 720", { width: 1280, height: 720 }],
  ["a phone", { width: 390, height: 844 }],
];

/** The rectangle of an element, and the number of lines of its text. */
const measured = (locator) =>
  locator.evaluateAll((list) =>
    list.map((element) => {
      const { left, top, right, bottom } = element.getBoundingClientRect();
      const range = document.createRange();
      range.selectNodeContents(element);
      const lines = new Set([...range.getClientRects()].map((line) => Math.round(line.top))).size;
      return { left, top, right, bottom, lines, letters: element.textContent.length };
    }),
  );

for (const [window, options] of SIZES) {
  test(`help is read in lines, inside its dialog: ${window}`, async () => {
    await withPage(PLANT, options, async (page) => {
      await page.getByRole("button", { name: "Help" }).click();
      const dialog = page.getByRole("dialog", { name: "Keys and documents" });
      await dialog.waitFor();
      const { width, x } = await dialog.boundingBox();
      const meanings = await measured(dialog.locator(".keys-list dd"));
      assert.ok(meanings.length > 3);
      for (const { left, right, lines, letters } of meanings) {
        assert.ok(left >= x && right <= x + width, "inside the dialog");
        assert.ok(lines <= Math.max(1, Math.ceil(letters / 12)), `${letters} letters in ${lines} lines`);
      }
      const rows = await measured(dialog.locator(".keys-list > div"));
      for (const [index, row] of rows.entries())
        for (const other of rows.slice(index + 1))
          assert.ok(row.right <= other.left + 1 || other.right <= row.left + 1 || row.bottom <= other.top + 1 || other.bottom <= row.top + 1, "no row is on another");
    });
  });

  test(`the menus of Design open inside the window: ${window}`, async () => {
    await withPage(PLANT, options, async (page) => {
      await openDesign(page);
      for (const name of ["request-menu", "link-menu"]) {
        const menu = page.locator(`details.${name}`);
        await menu.locator("summary").click();
        const items = menu.locator(".menu-items");
        await page.waitForFunction(
          ([selector, edge]) => document.querySelector(selector).getBoundingClientRect().right <= edge,
          [`details.${name} .menu-items`, options.width ?? 1440],
        );
        assert.ok((await items.boundingBox()).x >= 0, `${name} begins inside the window`);
        assert.equal(await overflow(page), 0);
        await page.keyboard.press("Escape");
      }
    });
  });

  test(`the parameters of a product are a whole table: ${window}`, async () => {
    await withPage("", options, async (page) => {
      const { id } = await post("v1/jobs", {
        plant: { type: "fopdt", K: 2, T: 10, L: 3 },
        implement: { product: "emerson_deltav_standard", y_span: [0, 200], u_span: [0, 100] },
      });
      await page.goto(`${tests.service.base}/#/jobs/${id}/design`);
      await openMore(page);
      const table = page.locator(".product-card table");
      await table.waitFor();
      const heads = await measured(table.locator("thead th"));
      const cells = await measured(table.locator("tbody tr:first-child > *"));
      assert.equal(cells.length, 4);
      heads.forEach((head, index) => {
        assert.ok(Math.abs(head.left - cells[index].left) < 2, `column ${index + 1} is below its heading`);
        assert.ok(index === 0 || head.left >= heads[index - 1].right - 1);
      });
      const rows = await measured(table.locator("tr"));
      rows.slice(1).forEach(({ top }, index) => assert.ok(Math.abs(top - rows[index].bottom) < 3, "row follows row"));
      const frame = await page.locator(".product-card .scroll").boundingBox();
      assert.ok(heads.at(-1).right <= frame.x + frame.width + 1, "no column is cut");
    });
  });
}

test("long names and units stay in their place", async () => {
  const name = "TIC-101 reactor jacket outlet temperature, north train, second stage after the economiser bypass valve 7";
  await withPage("", {}, async (page) => {
    const { id } = await post("v1/jobs", {
      name,
      units: { time: "min", u: "percent of full span", y: "kilogram per cubic m" },
      plant: { type: "fopdt", K: 1.25, T: 40, L: 8 },
    });
    await page.goto(`${tests.service.base}/#/jobs/${id}/design`);
    const label = page.locator(".controls .tight .slider > .label").first();
    await label.waitFor();
    const range = await page.locator(".controls .tight input[type=range]").first().boundingBox();
    const box = await label.boundingBox();
    assert.ok(box.x + box.width <= range.x, "the label ends before its slider");
    assert.equal(await page.locator(".controls .tight .slider").first().getAttribute("title"), "Kp (percent of full span/kilogram per cubic m)");
    for (const title of ["Set-point step", "Sensitivities"]) {
      const plot = page.locator("section.plot").filter({ has: page.getByRole("heading", { name: title, exact: true }) });
      const texts = await measured(plot.locator("svg.canvas text[transform]"));
      texts.sort((a, b) => a.top - b.top);
      texts.slice(1).forEach(({ top }, index) => assert.ok(top >= texts[index].bottom - 1, `${title}: axis names do not overlap`));
    }
    await page.goto(`${tests.service.base}/#/jobs`);
    await page.getByRole("link", { name, exact: true }).waitFor();
    const { scrollWidth, clientWidth } = await page.locator(".scroll:has(.job-list)").evaluate(({ scrollWidth, clientWidth }) => ({ scrollWidth, clientWidth }));
    assert.ok(scrollWidth <= clientWidth, `${scrollWidth} in ${clientWidth}`);
  });
});
