// Common helpers of the tests of Design: its sliders, its settings, a design to start from.

export const PLANT = "#/new/fopdt?K=1.25&T=40&L=8";

export const slider = (page, name) => page.locator(".controls").getByRole("slider", { name: `${name}, slider` });
export const setting = (page, name) =>
  page
    .locator(".settings tbody tr")
    .filter({ has: page.locator("th", { hasText: new RegExp(`^${name}\\b`) }) })
    .locator("td.value")
    .innerText()
    .then((text) => Number(text.replace("−", "-")));
export const shows = (page, name, value) =>
  page.waitForFunction(
    ([wanted, number]) =>
      [...document.querySelectorAll(".settings tbody tr")].some(
        (row) =>
          row.querySelector("th").textContent.startsWith(wanted) &&
          Math.abs(Number(row.querySelector("td.value").textContent.replace("−", "-")) / number - 1) < 1e-3,
      ),
    [name, value],
  );

export async function openDesign(page, today = false) {
  if (today) {
    await page.getByRole("region", { name: /^Today's settings/ }).getByLabel("Form").selectOption("ideal");
    await page.getByLabel("Kp", { exact: true }).fill("1.2");
    await page.getByLabel("Ti", { exact: true }).fill("40");
  }
  await page.getByRole("button", { name: "Tune this model" }).click();
  await slider(page, "Robustness Ms").waitFor();
}

/** The service's own answer for a limit on Ms, for the displayed job. */
export const designedBy = (jobOf) => async (page, Ms) => {
  const { plant, tune } = (await jobOf(page)).request;
  const answer = await page.request.post(`${new URL(page.url()).origin}/v1/design`, {
    data: { plant, tune: [{ ...tune[0], Ms, Mt: Ms }] },
  });
  return (await answer.json()).controllers[0];
};
