// The pictures of explanations, as drawings: a usual loop, computed here from closed forms.
import { node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";
import type { PictureName } from "../words/explained.ts";

const WIDTH = 260;
const HEIGHT = 130;

type Point = readonly [x: number, y: number];

const round = (value: number): number => Math.round(value * 10) / 10;
const path = (points: readonly Point[]): string => points.map(([x, y], index) => `${index === 0 ? "M" : "L"}${round(x)} ${round(y)}`).join("");
const sampled = (count: number, point: (part: number) => Point): Point[] => Array.from({ length: count + 1 }, (_, index) => point(index / count));

const curve = (points: readonly Point[]): TreeNode => node("path", { d: path(points), fill: "none", stroke: "var(--series-1)", "stroke-width": 2 });
const rule = (d: string, stroke = "var(--control)"): TreeNode => node("path", { d, fill: "none", stroke });
const dashed = (d: string): TreeNode => node("path", { d, fill: "none", stroke: "var(--setpoint)", "stroke-dasharray": "4 3" });
const mark = (d: string): TreeNode => node("path", { d, fill: "none", stroke: "var(--bad)", "stroke-width": 2 });
const text = (x: number, y: number, words: string): TreeNode => node("text", { x, y, fill: "var(--text)", "font-size": 12 }, words);

/** Damped by half: y = 1 − e^(−ζωt) (cos ω't + ζ/√(1 − ζ²) sin ω't), ζ = 0.45, ω = 1. */
function stepResponse(t: number): number {
  const [zeta, damped] = [0.45, Math.sqrt(1 - 0.45 ** 2)];
  return 1 - Math.exp(-zeta * t) * (Math.cos(damped * t) + (zeta / damped) * Math.sin(damped * t));
}
const END = 12;
const stepAt = (part: number): Point => [10 + 240 * part, 110 - 70 * stepResponse(END * part)];

/** L(jω) = e^(−0.5jω)/(jω(1 + 0.5jω)), on 60 px for one unit, with −1 at x = 90. */
const ORIGIN: Point = [150, 50];
function loopAt(omega: number): Point {
  const gain = 1 / (omega * Math.hypot(1, 0.5 * omega));
  const phase = -Math.PI / 2 - Math.atan(0.5 * omega) - 0.5 * omega;
  return [ORIGIN[0] + 60 * gain * Math.cos(phase), ORIGIN[1] - 60 * gain * Math.sin(phase)];
}
const nyquist = sampled(80, (part) => loopAt(0.72 * (20 / 0.72) ** part));
const MINUS_ONE: Point = [ORIGIN[0] - 60, ORIGIN[1]];

const plane = (): TreeNode[] => [
  rule(`M20 ${ORIGIN[1]}H240M${ORIGIN[0]} 5V125`),
  curve(nyquist),
  node("circle", { cx: MINUS_ONE[0], cy: MINUS_ONE[1], r: 3.5, fill: "var(--bad)" }),
  text(MINUS_ONE[0] - 12, MINUS_ONE[1] - 8, "−1"),
];

function distance(): TreeNode[] {
  const away = ([x, y]: Point): number => Math.hypot(x - MINUS_ONE[0], y - MINUS_ONE[1]);
  const [x, y] = nyquist.reduce((best, point) => (away(point) < away(best) ? point : best));
  const radius = round(away([x, y]));
  return [
    ...plane(),
    node("circle", { cx: MINUS_ONE[0], cy: MINUS_ONE[1], r: radius, fill: "var(--limit)", "fill-opacity": 0.1, stroke: "var(--limit)", "stroke-dasharray": "3 3" }),
    mark(`M${MINUS_ONE[0]} ${MINUS_ONE[1]}L${round(x)} ${round(y)}`),
    text(24, 120, "distance 1/Ms"),
  ];
}

function margins(): TreeNode[] {
  const crossing = nyquist.find(([, y]) => y <= ORIGIN[1])!;
  const unit = nyquist.reduce((best, point) => (Math.abs(away0(point) - 60) < Math.abs(away0(best) - 60) ? point : best));
  return [
    ...plane(),
    node("circle", { cx: ORIGIN[0], cy: ORIGIN[1], r: 60, fill: "none", stroke: "var(--control)", "stroke-dasharray": "3 3" }),
    mark(`M${ORIGIN[0]} ${ORIGIN[1]}H${round(crossing[0])}`),
    rule(`M${ORIGIN[0]} ${ORIGIN[1]}L${round(unit[0])} ${round(unit[1])}`, "var(--series-3)"),
    text(160, 44, "1/gain margin"),
    text(160, 120, "|L| = 1: phase margin"),
  ];
}
const away0 = ([x, y]: Point): number => Math.hypot(x - ORIGIN[0], y - ORIGIN[1]);

const PICTURES: Record<PictureName, () => TreeNode[]> = {
  distance,
  margins,
  area: () => {
    const points = sampled(80, stepAt);
    return [node("path", { d: `${path(points)}L250 40L10 40Z`, fill: "var(--series-1)", "fill-opacity": 0.2, "fill-rule": "evenodd" }), dashed("M10 40H250"), curve(points), text(60, 124, "IAE: the filled area")];
  },
  step: () => {
    const top = sampled(80, stepAt).reduce((best, point) => (point[1] < best[1] ? point : best));
    return [dashed("M10 40H250"), curve(sampled(80, stepAt)), mark(`M${round(top[0])} 40V${round(top[1])}`), text(round(top[0]) + 8, 18, "overshoot"), text(160, 60, "settled ±2 %"), rule("M10 38.6H250M10 41.4H250", "var(--limit)")];
  },
  load: () => {
    const points = sampled(80, (part): Point => [10 + 240 * part, 105 - 250 * Math.max(0, part - 0.08) * Math.exp(-7 * Math.max(0, part - 0.08)) * 4]);
    const top = points.reduce((best, point) => (point[1] < best[1] ? point : best));
    return [dashed("M10 105H250"), curve(points), mark(`M${round(top[0])} 105V${round(top[1])}`), text(round(top[0]) + 8, 40, "peak"), text(170, 96, "recovered")];
  },
  travel: () => [
    curve([[10, 105], [40, 105], [40, 25], [110, 85], [170, 60], [250, 66]]),
    mark("M34 105V25"),
    mark("M116 25V85"),
    mark("M176 85V60"),
    text(120, 124, "TV: all red pieces together"),
  ],
  weight: () => [
    dashed("M10 40H250"),
    curve(sampled(80, stepAt)),
    node("path", { d: path(sampled(80, (part): Point => [10 + 240 * part, 110 - 70 * (1 - Math.exp(-0.55 * END * part) * (1 + 0.55 * END * part))])), fill: "none", stroke: "var(--series-2)", "stroke-width": 2, "stroke-dasharray": "6 4" }),
    text(75, 22, "b = 1"),
    text(96, 88, "b = 0"),
  ],
  samples: () => {
    const at = (part: number): Point => [10 + 240 * part, 105 - 70 * stepResponse(END * part)];
    const held = Array.from({ length: 12 }, (_, index): Point[] => [at(index / 12), [at((index + 1) / 12)[0], at(index / 12)[1]]]).flat();
    return [rule(path(sampled(80, at)), "var(--muted)"), curve(held), text(60, 124, "held for one sample time")];
  },
};

/** An SVG element's description. */
export const picture = (name: PictureName, title: string): TreeNode =>
  node("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, width: WIDTH, height: HEIGHT, role: "img", "aria-label": `Picture: ${title}` }, ...PICTURES[name]());
