// The plant's map of periods as data: loops that oscillate together, loops that oscillate alone, and the axis.
import type { CheckContent, ListedLoop, LoopCluster } from "../api/types.ts";
import { secondsPer } from "../words/check.ts";

/** Of a loop's strongest oscillation, in s; 0: it has none. */
export const periodOf = ({ loops, units }: CheckContent, place: number): number => {
  const { shape, oscillation } = loops[place]!;
  return shape?.period ?? secondsPer(units?.time) * (oscillation.period ?? 0);
};

export interface PeriodGroup {
  /** Its place among the answer's clusters; null: loops that oscillate alone. */
  cluster: LoopCluster | null;
  /** Places of loops: of a cluster the likely source first, else by period. */
  places: number[];
}

/** Clusters in the order of the answer, then the other loops that oscillate. */
export function periodGroups(content: CheckContent): PeriodGroup[] {
  const { loops, clusters } = content;
  const together = new Set(clusters.flatMap((cluster) => cluster.loops));
  const alone = loops
    .map((_, place) => place)
    .filter((place) => !together.has(place) && periodOf(content, place) > 0)
    .sort((a, b) => periodOf(content, a) - periodOf(content, b));
  return [
    ...clusters.map((cluster) => ({ cluster, places: cluster.loops })),
    ...(alone.length > 0 ? [{ cluster: null, places: alone }] : []),
  ];
}

const MARGIN = 1.8;

/** From the shortest to the longest period, with a margin, in s; null if nothing oscillates. */
export function periodRange(content: CheckContent): [number, number] | null {
  const periods = content.loops.map((_, place) => periodOf(content, place)).filter((period) => period > 0);
  return periods.length === 0 ? null : [Math.min(...periods) / MARGIN, Math.max(...periods) * MARGIN];
}

/** Places on the axis at which a clock reads a round figure, in s. */
const ROUND: readonly (readonly [number, string])[] = [
  ...[1, 2, 5, 10, 20, 30].map((value) => [value, `${value} s`] as const),
  ...[1, 2, 5, 10, 20, 30].map((value) => [60 * value, `${value} min`] as const),
  ...[1, 2, 5, 10, 20, 50].map((value) => [3600 * value, `${value} h`] as const),
];

/** At most `most` of them within the range, with their names. */
export function periodTicks([from, to]: readonly [number, number], most: number): (readonly [number, string])[] {
  const inside = ROUND.filter(([tick]) => tick >= from && tick <= to);
  const every = Math.ceil(inside.length / most);
  return inside.filter((_, index) => index % every === 0);
}

/** The place of a period on the axis, 0 to 1. */
export const alongAxis = (period: number, [from, to]: readonly [number, number]): number => Math.log(period / from) / Math.log(to / from);

/** As in the contract: the bands of a shape's spectrum are even in the logarithm of the period, in s. */
const BANDS = [1, 100_000] as const;

/** A loop's spectrum along the axis: place from 0 to 1, and power relative to its largest; empty if it is not known. */
export function ridge(shape: ListedLoop["shape"], range: readonly [number, number]): [at: number, power: number][] {
  const { spectrum } = shape ?? { spectrum: [] };
  const highest = Math.max(...spectrum, 0);
  if (highest <= 0) return [];
  return spectrum
    .map((power, band): [number, number] => {
      const middle = BANDS[0] * (BANDS[1] / BANDS[0]) ** ((band + 0.5) / spectrum.length);
      return [alongAxis(middle, range), power / highest];
    })
    .filter(([at]) => at >= 0 && at <= 1);
}

/** The cluster of a loop, or null. */
export const clusterOf = ({ clusters }: CheckContent, place: number): LoopCluster | null =>
  clusters.find((cluster) => cluster.loops.includes(place)) ?? null;
