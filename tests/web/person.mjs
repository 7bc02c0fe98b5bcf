// A user of the page who acts by roles and names alone, and whose clicks and fields are counted.

/** Acts by roles and names alone, as somebody does who hears the page, and counts the actions. */
export function person(page) {
  const counts = { clicks: 0, fields: 0 };
  return {
    counts,
    async click(role, name) {
      counts.clicks += 1;
      await page.getByRole(role, { name, exact: true }).click();
    },
    /** The dialog for a file is one click. */
    async file(name, text) {
      counts.clicks += 1;
      await page.getByLabel("CSV file").setInputFiles({ name, mimeType: "text/csv", buffer: Buffer.from(text) });
    },
    async fill(field, text, key = "Tab") {
      counts.fields += 1;
      await field.fill(text);
      await field.press(key);
    },
  };
}

/** Gives the chosen product the measurement's range. */
export async function giveMeasurementRange(page, who, low, high) {
  const range = page.getByRole("group", { name: /^Measurement range/ });
  await who.fill(range.getByRole("textbox", { name: "from" }), low);
  await who.fill(range.getByRole("textbox", { name: "to" }), high);
}

/** Types a product's name, and takes the first that is found. */
export async function chooseProduct(page, who, words, title) {
  const picker = page.getByRole("combobox", { name: "Maker and product" });
  await picker.fill("");
  await who.fill(picker, words, "ArrowRight");
  await page.getByRole("option", { name: title }).waitFor();
  await picker.press("Enter");
}
