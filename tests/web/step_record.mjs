// Recorded tests with known plants, by hand and in automatic, and the results that the tests of Identify wait for.

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

/** A PI on a plant with K 2, T 40, L 8: four moves of the set point, a load, noise of y. */
export function loopTest() {
  const [K, T, late, h] = [2, 40, 4, 2];
  const given = [];
  let [x, integral] = [50, 25];
  const samples = Array.from({ length: 900 }, (_, k) => {
    const r = 50 + (k > 60 ? 5 : 0) - (k > 240 ? 8 : 0) + (k > 420 ? 6 : 0) - (k > 780 ? 4 : 0);
    const y = x + 0.02 * Math.sin(37 * k) + 0.02 * Math.sin(11.3 * k * k);
    integral += 0.012 * h * (r - y);
    given.push(0.5 * (r - y) + integral);
    x += (1 - Math.exp(-h / T)) * (K * (given[Math.max(0, k - late)] + (k > 600 ? 1.5 : 0)) - x);
    return [k * h, r, y.toFixed(3), given[k].toFixed(3)].join(",");
  });
  return ["time (s),SP,PV,OP", ...samples].join("\n");
}
