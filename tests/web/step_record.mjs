// A recorded step test with a known plant, and the results that the tests of Identify wait for.

export const candidatesShown = (page) => page.getByRole("heading", { name: "Model candidates" }).waitFor();
export const identified = (page) =>
  page.waitForResponse((response) => response.url().endsWith("/v1/identify") && response.status() === 200);

// A first-order step response with known parameters: K 2, T 30, L 5 from rest at y = 20. From t = 250 on another
// influence moves y.
export const rows = Array.from({ length: 400 }, (_, t) => {
  const y = 20 + (t > 25 ? 10 * (1 - Math.exp(-(t - 25) / 30)) : 0);
  return `${t},${t >= 20 ? 5 : 0},${(y + 0.01 * Math.sin(37 * t)).toFixed(4)}`;
});
export const stepTest = ["t,u,y", ...rows].join("\n");
export const disturbedTest = ["t,u,y", ...rows.map((row, t) => (t < 250 ? row : `${t},5,${30 + 0.02 * (t - 250)}`))].join(
  "\n",
);
