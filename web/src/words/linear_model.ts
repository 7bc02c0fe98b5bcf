// The linear model of a nonlinear plant in the usual notation: a transfer function from its state-space form, with
// poles and zeros.
import type { Plant } from "../api/types.ts";
import { formatParameter } from "./numbers.ts";

export interface TransferFunction {
  /** In descending powers of s. */
  num: number[];
  den: number[];
}

/** A result that is smaller than this, relative to its terms, is rounding. */
const ROUNDING = 1e-11;
/** With more states there is no readable formula. */
const MAX_STATES = 5;
const MAX_PASSES = 500;
/** Relative to a root's size: rounding splits a double real root by its square root. */
const NO_ANGLE = 1e-7;

/** C (sI - A)^-1 B by Faddeev and LeVerrier's recursion; null for another plant or one of many states. */
export function transferFunction(plant: Plant | undefined): TransferFunction | null {
  const A = plant?.["A"] as number[][] | undefined;
  if (plant?.type !== "state_space" || !Array.isArray(A) || A.length === 0 || A.length > MAX_STATES) return null;
  const B = (plant["B"] as number[] | number[][]).flat();
  const C = (plant["C"] as number[] | number[][]).flat();
  const n = A.length;
  const identity = A.map((row, i) => row.map((_, j): number => (i === j ? 1 : 0)));
  const num: number[] = [];
  const den: number[] = [1];
  let M = identity;
  for (let k = 1; k <= n; k += 1) {
    const terms = C.flatMap((c, i) => B.map((b, j) => c * M[i]![j]! * b));
    num.push(cleanSum(terms));
    const product = A.map((row) => identity.map((_, j) => sum(row.map((a, l) => a * M[l]![j]!))));
    const coefficient = -cleanSum(product.map((row, i) => row[i]!)) / k;
    den.push(coefficient);
    M = product.map((row, i) => row.map((value, j) => value + (i === j ? coefficient : 0)));
  }
  while (num.length > 1 && num[0] === 0) num.shift();
  return { num, den };
}

const sum = (values: number[]): number => values.reduce((total, value) => total + value, 0);

function cleanSum(terms: number[]): number {
  const total = sum(terms);
  return Math.abs(total) <= ROUNDING * sum(terms.map(Math.abs)) ? 0 : total;
}

/** All roots at once (Weierstrass, Durand and Kerner), the rightmost first. */
export function rootsOf(coefficients: number[]): [number, number][] {
  const first = coefficients.findIndex((value) => value !== 0);
  if (first < 0) return [];
  const atZero = [...coefficients].reverse().findIndex((value) => value !== 0);
  const monic = coefficients.slice(first, coefficients.length - atZero).map((value) => value / coefficients[first]!);
  const degree = monic.length - 1;
  const scale = Math.max(...monic.slice(1).map((value, k) => Math.abs(value) ** (1 / (k + 1))));
  let roots = Array.from({ length: degree }, (_, k): Pair => {
    const angle = (2 * Math.PI * k) / degree + 0.4;
    return [scale * Math.cos(angle), scale * Math.sin(angle)];
  });
  for (let pass = 0; pass < MAX_PASSES; pass += 1) {
    const next = roots.map((root, k) => minus(root, over(valueAt(monic, root), others(roots, k))));
    const moved = Math.max(0, ...next.map((root, k) => size(minus(root, roots[k]!)) / (size(root) || scale)));
    roots = next;
    if (moved < 1e-14) break;
  }
  const real = roots.map((root): Pair => (Math.abs(root[1]) < NO_ANGLE * size(root) ? [root[0], 0] : root));
  const zeros = Array.from({ length: atZero }, (): Pair => [0, 0]);
  return [...real, ...zeros].sort((a, b) => b[0] - a[0] || b[1] - a[1]);
}

type Pair = [number, number];
const size = (a: Pair): number => Math.hypot(a[0], a[1]);
const minus = (a: Pair, b: Pair): Pair => [a[0] - b[0], a[1] - b[1]];
const times = (a: Pair, b: Pair): Pair => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
const over = (a: Pair, b: Pair): Pair => {
  const square = b[0] * b[0] + b[1] * b[1] || Number.MIN_VALUE;
  return [(a[0] * b[0] + a[1] * b[1]) / square, (a[1] * b[0] - a[0] * b[1]) / square];
};
const valueAt = (monic: number[], at: Pair): Pair =>
  monic.slice(1).reduce(
    (value: Pair, c) => {
      const [re, im] = times(value, at);
      return [re + c, im];
    },
    [monic[0]!, 0],
  );
const others = (roots: Pair[], k: number): Pair =>
  roots.reduce((product: Pair, root, j) => (j === k ? product : times(product, minus(roots[k]!, root))), [1, 0]);

/** "−1.14, −7.604" or "−2 ± 1i"; "none". */
export function rootWords(roots: readonly (number | readonly [number, number])[]): string {
  const pairs = roots.map((root): Pair => (typeof root === "number" ? [root, 0] : [root[0], root[1]]));
  const words = pairs.flatMap(([re, im]) => {
    if (im < 0) return [];
    return [im === 0 ? formatParameter(re) : `${formatParameter(re)} ± ${formatParameter(im)}i`];
  });
  return words.join(", ") || "none";
}
