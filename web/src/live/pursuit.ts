// Follows a dragged figure with a slider: the slider's next value, from those that are known already.

/** A slider's value, and the figure of its design. */
export interface KnownFigure {
  value: number;
  figure: number;
}

/** The part of the slider's range by which a first step goes, when the figure's slope is unknown. */
const FIRST_STEP = 0.04;
/** One step goes no further: a slope from two close values may be wrong by much. */
const LONGEST_STEP = 0.25;

/**
 * The value for which the figure should be `target`, by interpolation between the two known neighbours (false
 * position), else by the secant through the last two. `now`: the value of the newest design; `rises`: whether the
 * figure grows with the value, which is used until two designs tell. `lo`, `hi`: the slider's ends, with lo < hi.
 */
export function pursue(known: readonly KnownFigure[], target: number, lo: number, hi: number, rises: boolean): number {
  const newest = known.at(-1);
  if (!newest) return lo;
  const inside = (value: number): number => Math.min(hi, Math.max(lo, value));
  const below = nearestOn(known, target, (difference) => difference <= 0);
  const above = nearestOn(known, target, (difference) => difference >= 0);
  if (below && above) {
    if (below.figure === above.figure) return inside(below.value);
    return inside(below.value + ((target - below.figure) / (above.figure - below.figure)) * (above.value - below.value));
  }
  const before = [...known].reverse().find(({ value, figure }) => value !== newest.value && figure !== newest.figure);
  const slope = before ? (newest.figure - before.figure) / (newest.value - before.value) : 0;
  const step = slope === 0 ? Math.sign(target - newest.figure) * (rises ? 1 : -1) * FIRST_STEP * (hi - lo) : (target - newest.figure) / slope;
  const longest = LONGEST_STEP * (hi - lo);
  return inside(newest.value + Math.max(-longest, Math.min(longest, step)));
}

/** The known figure closest to the target among those on one side of it. */
function nearestOn(known: readonly KnownFigure[], target: number, on: (difference: number) => boolean): KnownFigure | undefined {
  return known
    .filter(({ figure }) => on(figure - target))
    .sort((a, b) => Math.abs(a.figure - target) - Math.abs(b.figure - target))[0];
}
