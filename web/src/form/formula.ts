// A plant as a formula: MathML as plain nodes, so that it can be tested and built without markup.
import type { Complex, Plant } from "../api/types.ts";
import { node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";

const mn = (value: number): TreeNode => node("mn", {}, text(value));
const mi = (name: string): TreeNode => node("mi", {}, name);
const mo = (sign: string): TreeNode => node("mo", {}, sign);
const row = (...children: TreeNode[]): TreeNode => node("mrow", {}, ...children);
const fraction = (top: TreeNode, bottom: TreeNode): TreeNode => node("mfrac", {}, top, bottom);
const power = (base: TreeNode, exponent: TreeNode): TreeNode => node("msup", {}, base, exponent);
const brackets = (...inside: TreeNode[]): TreeNode => row(mo("("), ...inside, mo(")"));
const s = mi("s");

const text = (value: number): string => String(Number(Math.abs(value).toPrecision(6)));
const one = (value: number): boolean => Number(Math.abs(value).toPrecision(6)) === 1;

/** A value with its sign; the sign is an operator of its own. */
function signed(value: number): TreeNode[] {
  return value < 0 ? [mo("−"), mn(value)] : [mn(value)];
}

/** A sum of terms of falling powers of s, e.g. [2, 0, 1] as 2 s^2 + 1. */
function polynomial(coefficients: readonly number[]): TreeNode[] {
  const degree = coefficients.length - 1;
  const parts: TreeNode[] = [];
  coefficients.forEach((coefficient, index) => {
    if (coefficient === 0) return;
    const exponent = degree - index;
    if (coefficient < 0) parts.push(mo("−"));
    else if (parts.length > 0) parts.push(mo("+"));
    if (exponent === 0 || !one(coefficient)) parts.push(mn(coefficient));
    if (exponent === 1) parts.push(s);
    if (exponent > 1) parts.push(power(s, mn(exponent)));
  });
  return parts.length > 0 ? parts : [mn(0)];
}

/** T s + 1; nothing for T = 0. */
const lag = (T: number): TreeNode[] => (T === 0 ? [] : [brackets(...polynomial([T, 1]))]);

/** s - r for a real root, s^2 - 2 re s + |r|^2 for a pair given as two, (s - r) for a lone complex one. */
function factors(roots: readonly Complex[]): TreeNode[] {
  const left = roots.map((root): [number, number] => (typeof root === "number" ? [root, 0] : root));
  const parts: TreeNode[] = [];
  while (left.length > 0) {
    const [re, im] = left.shift()!;
    const partner = left.findIndex(([a, b]) => a === re && b === -im);
    if (im !== 0 && partner >= 0) {
      left.splice(partner, 1);
      parts.push(brackets(...polynomial([1, -2 * re, re * re + im * im])));
    } else if (im !== 0) {
      parts.push(brackets(s, mo("−"), brackets(...signed(re), mo(im < 0 ? "−" : "+"), mn(im), mi("i"))));
    } else if (re === 0) {
      parts.push(s);
    } else {
      parts.push(brackets(s, mo(re < 0 ? "+" : "−"), mn(re)));
    }
  }
  return parts;
}

function delay(L: number): TreeNode[] {
  if (!(L > 0)) return [];
  return [power(mi("e"), row(mo("−"), ...(one(L) ? [] : [mn(L)]), s))];
}

/** Numerator times the dead time over the denominator. */
function quotient(sign: number, top: TreeNode[], bottom: TreeNode[], L: number): TreeNode[] {
  const numerator = [...top, ...delay(L)];
  const body =
    bottom.length === 0 ? numerator : [fraction(row(...(numerator.length > 0 ? numerator : [mn(1)])), row(...bottom))];
  return [...(sign < 0 ? [mo("−")] : []), ...body];
}

const gain = (K: number, others: boolean): TreeNode[] => (one(K) && others ? [] : [mn(K)]);

function matrix(rows: readonly (readonly number[])[]): TreeNode {
  return row(
    mo("["),
    node(
      "mtable",
      {},
      ...rows.map((line) => node("mtr", {}, ...line.map((value) => node("mtd", {}, ...signed(value))))),
    ),
    mo("]"),
  );
}

/** The formula's right-hand side, or null where the plant is not complete. */
function body(plant: Plant): TreeNode[] | null {
  const number = (name: string): number | null => (typeof plant[name] === "number" ? (plant[name] as number) : null);
  const list = <T>(name: string): T[] | null => (Array.isArray(plant[name]) ? (plant[name] as T[]) : null);
  const K = number("K");
  const L = number("L") ?? 0;
  switch (plant.type) {
    case "fopdt": {
      const T = number("T");
      return K === null || T === null ? null : quotient(K, gain(K, L > 0), T === 0 ? [] : polynomial([T, 1]), L);
    }
    case "sopdt": {
      const [T1, T2, T, zeta] = [number("T1"), number("T2"), number("T"), number("zeta")];
      if (K === null) return null;
      if (T1 !== null && T2 !== null) return quotient(K, gain(K, L > 0), [...lag(T1), ...lag(T2)], L);
      if (T !== null && zeta !== null) return quotient(K, gain(K, L > 0), polynomial([T * T, 2 * zeta * T, 1]), L);
      return null;
    }
    case "ipdt":
      return K === null ? null : quotient(K, gain(K, L > 0), [s, ...lag(number("T") ?? 0)], L);
    case "transfer_function": {
      const [num, den] = [list<number>("num"), list<number>("den")];
      if (!num || !den) return null;
      const several = num.filter((value) => value !== 0).length > 1 && L > 0;
      return quotient(1, several ? [brackets(...polynomial(num))] : polynomial(num), polynomial(den), L);
    }
    case "zpk": {
      const [zeros, poles] = [list<Complex>("zeros"), list<Complex>("poles")];
      if (K === null || !zeros || !poles) return null;
      return quotient(K, [...gain(K, zeros.length > 0 || L > 0), ...factors(zeros)], factors(poles), L);
    }
    case "state_space": {
      const [A, B, C, D] = [list<number[]>("A"), list<number[]>("B"), list<number[]>("C"), plant["D"]];
      if (!A || !B || !C) return null;
      const d = Array.isArray(D) ? Number((D as unknown[]).flat()[0] ?? 0) : typeof D === "number" ? D : 0;
      const inverse = power(row(brackets(s, mi("I"), mo("−"), matrix(A))), row(mo("−"), mn(1)));
      const main = [matrix(asRows(C)), inverse, matrix(asColumn(B))];
      const sum = d === 0 ? main : [brackets(...main, mo(d < 0 ? "−" : "+"), mn(d))];
      return [...sum, ...delay(L)];
    }
    default:
      return null;
  }
}

const asRows = (value: unknown[]): number[][] =>
  Array.isArray(value[0]) ? (value as number[][]) : [value as number[]];
const asColumn = (value: unknown[]): number[][] =>
  Array.isArray(value[0]) ? (value as number[][]) : (value as number[]).map((item) => [item]);

/** P(s) = ..., or null for a plant that has no such formula or lacks a value. */
export function plantFormula(plant: Plant): TreeNode | null {
  const right = body(plant);
  if (right === null) return null;
  return node("math", { display: "block" }, row(mi("P"), brackets(s), mo("="), ...right));
}
