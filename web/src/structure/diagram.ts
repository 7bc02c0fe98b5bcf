// Block diagrams: the places of the blocks, in which the form stands, and the drawing around them. The signal runs along
// the main axis: to the right, or downwards where the page is narrow.
import type { StructureId } from "../api/structure.ts";
import { node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";
import { loopsOf } from "./structures.ts";
import type { Texts } from "./structures.ts";

export interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

export interface Diagram {
  width: number;
  height: number;
  boxes: Record<string, Box>;
  drawing: TreeNode[];
}

/** Centre and half sizes along the main axis and across it. */
interface Spot {
  m: number;
  c: number;
  hm: number;
  hc: number;
}

type Place = [m: number, c: number];

interface Wire {
  way: Place[];
  label: string;
  sign: string;
  arrow: boolean;
}

const BLOCK_HEIGHT = 128;
const WIDE_BLOCK = 190;
/** In a turned diagram, where the blocks share the width. */
const NARROW_BLOCK = 120;
const MAX_TURNED_BLOCK = 260;
const TURNED_GAP = 28;
/** A matrix of plants: its columns and rows. */
const CELL: Place = [206, 120];
const SUM = 11;
const MAX_GAP = 46;
const MIN_GAP = 25;
const LANE = 30;

const after = ({ m, c, hm }: Spot): Place => [m + hm, c];
const before = ({ m, c, hm }: Spot): Place => [m - hm, c];
const over = ({ m, c, hc }: Spot): Place => [m, c - hc];
const under = ({ m, c, hc }: Spot): Place => [m, c + hc];

/** A part's name says what it is: "C1" is a block, "+s1" a sum, ".y" a branch, ">r" an end of the diagram. */
const halfOf = (name: string, block: number): number => (name.startsWith("+") ? SUM : /^[.>]/.test(name) ? 0 : block / 2);

/** The parts and wires of one diagram. */
class Plan {
  readonly parts = new Map<string, Spot>();
  readonly wires: Wire[] = [];

  constructor(
    readonly gap: number,
    readonly block: Place,
  ) {}

  put(name: string, m: number, c: number): Spot {
    const spot = { m, c, hm: halfOf(name, this.block[0]), hc: halfOf(name, this.block[1]) };
    this.parts.set(name, spot);
    return spot;
  }

  at(name: string): Spot {
    return this.parts.get(name)!;
  }

  /** One after another, joined by wires. `labels`: what the wire after that part carries. */
  row(names: string[], labels: Record<string, string> = {}): void {
    let m = 0;
    names.forEach((name, index) => {
      const half = halfOf(name, this.block[0]);
      const spot = this.put(name, m + half, 0);
      m += 2 * half + this.gap;
      const last = names[index - 1];
      if (last !== undefined) this.wire([after(this.at(last)), before(spot)], labels[last] ?? "", "", !name.startsWith("."));
    });
  }

  wire(way: Place[], label = "", sign = "", arrow = true): void {
    this.wires.push({ way, label, sign, arrow });
  }

  /** Back from a branch to a sum, at that distance from the row. */
  feedback(from: string, to: string, c: number, sign = "−"): void {
    const [start, end] = [this.at(from), this.at(to)];
    this.wire([under(start), [start.m, c], [end.m, c], under(end)], "", sign);
  }

  /** A signal from outside. */
  input(to: string, label: string): void {
    const { m, c, hc } = this.at(to);
    this.wire([[m, c - hc - LANE], [m, c - hc]], label);
  }
}

function cascade(plan: Plan, parallel: boolean): void {
  const half = plan.block[1] / 2;
  const parts = [">r1", "+s1", "C1", "+s2", "C2"];
  const labels = { ">r1": "r1", C1: "r2", C2: "u", P2: "y2", P1: "y1" };
  if (!parallel) plan.row([...parts, "+s3", "P2", ".y2", "+s4", "P1", ".y1", ">"], labels);
  else {
    plan.row([...parts, ".u", "+s3", "P2", ".y2", ">"], labels);
    const up = -plan.block[1] - LANE - 6;
    const s4 = plan.put("+s4", plan.at("+s3").m, up);
    const P1 = plan.put("P1", plan.at("P2").m, up);
    const y1 = plan.put(".y1", plan.at(".y2").m + plan.gap, up);
    const u = plan.at(".u");
    plan.wire([over(u), [u.m, up], before(s4)]);
    plan.wire([after(s4), before(P1)]);
    plan.wire([after(P1), [y1.m + plan.gap, up]], "y1");
  }
  plan.input("+s3", "d2");
  plan.input("+s4", "d1");
  plan.feedback(".y2", "+s2", half + 20);
  plan.feedback(".y1", "+s1", half + 20 + LANE);
}

function feedforward(plan: Plan): void {
  const up = -plan.block[1] - LANE;
  plan.row([">r", "+s1", "C", "+s2"], { ">r": "r" });
  const s2 = plan.at("+s2");
  const F = plan.put("F", s2.m + plan.gap + plan.block[0] / 2, up);
  const d = plan.put(".d", after(F)[0] + plan.gap, up);
  const Pd = plan.put("Pd", d.m + plan.gap + plan.block[0] / 2, up);
  const s3 = plan.put("+s3", after(Pd)[0] + plan.gap, 0);
  const P = plan.put("P", (s2.m + s3.m) / 2, 0);
  const y = plan.put(".y", after(s3)[0] + plan.gap, 0);
  plan.wire([after(s2), before(P)], "u");
  plan.wire([after(P), before(s3)]);
  plan.wire([after(s3), [y.m + plan.gap, 0]], "y");
  plan.wire([before(F), [s2.m, up], over(s2)], "", "−");
  plan.wire([after(Pd), [s3.m, up], over(s3)]);
  plan.wire([before(d), after(F)]);
  plan.wire([after(d), before(Pd)]);
  plan.wire([[d.m, up - LANE], over(d)], "d", "", false);
  plan.feedback(".y", "+s1", plan.block[1] / 2 + 20);
}

function level(plan: Plan): void {
  plan.row([">r", "+s1", "C", "Q", "+s2", "V", ".h", ">"], { ">r": "h set", C: "q set", Q: "q out", V: "h" });
  for (const wire of plan.wires) if (wire.label === "h set" || wire.label === "q out") wire.sign = "−";
  plan.input("+s2", "q in");
  plan.feedback(".h", "+s1", plan.block[1] / 2 + 20, "");
}

function predictor(plan: Plan): void {
  plan.row([">r", "+s1", "C", ".u", "+s2", "P", ".y", ">"], { ">r": "r", C: "u", P: "y" });
  const [s1, u, y] = [plan.at("+s1"), plan.at(".u"), plan.at(".y")];
  const lane = plan.block[1] + LANE;
  const M = plan.put("M", u.m, lane);
  const s3 = plan.put("+s3", s1.m, lane);
  const s4 = plan.put("+s4", y.m, lane);
  const F = plan.put("F", u.m, lane + plan.block[1] + LANE - 10);
  plan.input("+s2", "d");
  plan.wire([under(u), over(M)]);
  plan.wire([before(M), after(s3)], "without dead time");
  plan.wire([over(s3), under(s1)], "", "−");
  plan.wire([under(y), over(s4)]);
  plan.wire([after(M), before(s4)], "predicted y", "−");
  plan.wire([under(s4), [s4.m, F.c], after(F)]);
  plan.wire([before(F), [s3.m, F.c], under(s3)]);
}

function interaction(plan: Plan, texts: Texts): void {
  const loops = loopsOf(texts);
  const pairing = (texts["pairing"] || loops.map((loop) => loop + 1).join(" ")).split(" ");
  const step = Math.max(CELL[1], plan.block[1] + 10);
  const left = 24 + LANE * (loops.length + 1);
  const half: Place = [(loops.length * CELL[0]) / 2, (loops.length * step) / 2];
  const matrix = { m: left + plan.block[0] + plan.gap + half[0], c: half[1] - step / 2, hm: half[0], hc: half[1] };
  plan.parts.set("matrix", matrix);
  const [top, bottom, right] = [over(matrix)[1] - 14, under(matrix)[1] + 12, after(matrix)[0]];
  for (const loop of loops) {
    const c = loop * step;
    const sum = plan.put(`+s${loop}`, 30 + LANE * (loop + 1) - SUM, c);
    const C = plan.put(`C${loop + 1}`, left + plan.block[0] / 2, c);
    const y = plan.put(`.y${loop}`, right + 22 + LANE * (loops.length - loop), c);
    plan.wire([[0, c], before(sum)], `r${loop + 1}`);
    plan.wire([after(sum), before(C)]);
    plan.wire([after(C), [before(matrix)[0], c]], `u${pairing[loop]}`);
    plan.wire([[right, c], [right + 30 + LANE * (loops.length + 1), c]], `y${loop + 1}`);
    if (loop === 0) plan.wire([over(y), [y.m, top], [sum.m, top], over(sum)], "", "−");
    else plan.feedback(`.y${loop}`, `+s${loop}`, bottom + 16 * (loops.length - 1 - loop));
  }
}

function planOf(id: StructureId, texts: Texts, gap: number, block: Place): Plan {
  const plan = new Plan(gap, block);
  if (id === "cascade") cascade(plan, texts["arrangement"] === "parallel");
  if (id === "feedforward") feedforward(plan);
  if (id === "level") level(plan);
  if (id === "predictor") predictor(plan);
  if (id === "interaction") interaction(plan, texts);
  return plan;
}

/** The parts of a diagram that the main axis can be turned down for. */
const TURNS: readonly StructureId[] = ["cascade", "level", "feedforward"];

interface Extent {
  low: Place;
  high: Place;
}

function extentOf(plan: Plan): Extent {
  const places = [
    ...plan.wires.flatMap(({ way }) => way),
    ...[...plan.parts.values()].flatMap((spot) => [before(spot), after(spot), over(spot), under(spot)]),
  ];
  const along = (axis: 0 | 1): number[] => places.map((place) => place[axis]);
  return { low: [Math.min(...along(0)), Math.min(...along(1))], high: [Math.max(...along(0)), Math.max(...along(1))] };
}

const MARGIN: Place = [4, 6];

/** Null: there is no room for a drawing, and the blocks stand one below another. */
export function layoutDiagram(id: StructureId, texts: Texts, width: number): Diagram | null {
  const flat = (gap: number): Plan => planOf(id, texts, gap, [WIDE_BLOCK, BLOCK_HEIGHT]);
  const widthOf = ({ low, high }: Extent): number => high[0] - low[0] + 2 * MARGIN[0];
  const least = widthOf(extentOf(flat(MIN_GAP)));
  if (least <= width) {
    const perGap = widthOf(extentOf(flat(MIN_GAP + 1))) - least;
    return drawn(flat(Math.min(MAX_GAP, MIN_GAP + (width - least) / Math.max(1, perGap))), false);
  }
  if (!TURNS.includes(id)) return null;
  // Turned: the blocks share the width with the wires beside them.
  const across = (block: number): number => {
    const { low, high } = extentOf(planOf(id, texts, TURNED_GAP, [BLOCK_HEIGHT, block]));
    return high[1] - low[1] + 2 * MARGIN[1];
  };
  const share = (across(2 * NARROW_BLOCK) - across(NARROW_BLOCK)) / NARROW_BLOCK;
  const block = NARROW_BLOCK + (width - across(NARROW_BLOCK)) / share;
  return block < NARROW_BLOCK ? null : drawn(planOf(id, texts, TURNED_GAP, [BLOCK_HEIGHT, Math.min(MAX_TURNED_BLOCK, block)]), true);
}

function drawn(plan: Plan, turned: boolean): Diagram {
  const { low, high } = extentOf(plan);
  const at = ([m, c]: Place): Place => {
    const [along, across] = [m - low[0], c - low[1]];
    return turned ? [across + MARGIN[1], along + MARGIN[0]] : [along + MARGIN[0], across + MARGIN[1]];
  };
  const named = (kind: string): Spot[] => [...plan.parts].flatMap(([name, spot]) => (name.startsWith(kind) ? [spot] : []));
  const [right, bottom] = at(high);
  const boxes = Object.fromEntries(
    [...plan.parts].filter(([name]) => /^\w/.test(name)).map(([name, spot]) => {
      const [left, top] = at([spot.m - spot.hm, spot.c - spot.hc]);
      const size: Place = turned ? [2 * spot.hc, 2 * spot.hm] : [2 * spot.hm, 2 * spot.hc];
      return [name, { left, top, width: size[0], height: size[1] }];
    }),
  );
  return {
    width: right + MARGIN[turned ? 1 : 0],
    height: bottom + MARGIN[turned ? 0 : 1],
    boxes,
    drawing: [
      ...plan.wires.flatMap((wire) => wireNodes(wire, at)),
      ...named("+").map((sum) => {
        const [cx, cy] = at([sum.m, sum.c]);
        return node("circle", { cx, cy, r: SUM, fill: "var(--surface)", stroke: "var(--text)", "stroke-width": 1.4 });
      }),
      ...named(".").map((dot) => {
        const [cx, cy] = at([dot.m, dot.c]);
        return node("circle", { cx, cy, r: 2.6, fill: "var(--text)" });
      }),
    ],
  };
}

const round = (value: number): number => Math.round(value * 10) / 10;

function wireNodes({ way, label, sign, arrow }: Wire, at: (place: Place) => Place): TreeNode[] {
  const points = way.map(at);
  const [last, previous] = [points.at(-1)!, points.at(-2)!];
  const ahead = [Math.sign(last[0] - previous[0]), Math.sign(last[1] - previous[1])] as const;
  const path = points.map(([x, y], index) => `${index === 0 ? "M" : "L"}${round(x)} ${round(y)}`).join("");
  const nodes = [node("path", { d: path, fill: "none", stroke: "var(--text)", "stroke-width": 1.4 })];
  const text = (content: string, x: number, y: number, anchor: string): TreeNode =>
    node("text", { x: round(x), y: round(y), "text-anchor": anchor, "font-size": 13, fill: "var(--text)", stroke: "var(--surface)", "stroke-width": 4, "paint-order": "stroke" }, content);
  if (arrow) {
    const [ax, ay] = ahead;
    const corner = (side: number): string => `L${round(last[0] - 8 * ax + 4 * side * ay)} ${round(last[1] - 8 * ay + 4 * side * ax)}`;
    nodes.push(node("path", { d: `M${round(last[0])} ${round(last[1])}${corner(1)}${corner(-1)}Z`, fill: "var(--text)" }));
  }
  if (sign) nodes.push(text(sign, last[0] + (ahead[0] ? -12 * ahead[0] : 9), last[1] + (ahead[0] ? 15 : -7 * ahead[1] + 4), "middle"));
  if (label) {
    const [from, to] = [points[0]!, points[1]!];
    const level = from[1] === to[1];
    // An input from outside is named at its beginning.
    if (level) nodes.push(text(label, (from[0] + to[0]) / 2 - (arrow ? 3 : 0), from[1] - 6, "middle"));
    else nodes.push(text(label, from[0] + 7, (from[1] + to[1]) / 2 + 2, "start"));
  }
  return nodes;
}
