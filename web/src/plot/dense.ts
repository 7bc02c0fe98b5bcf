// Reduction of long traces to the points that a screen can show.

/** Index runs of consecutive samples that can be drawn, as [first, last]. */
export function drawableRuns(
  x: readonly (number | null)[],
  y: readonly (number | null)[],
  positiveX: boolean,
  positiveY: boolean,
): [number, number][] {
  const runs: [number, number][] = [];
  let start = -1;
  const length = Math.min(x.length, y.length);
  for (let index = 0; index <= length; index += 1) {
    const a = index < length ? x[index] : null;
    const b = index < length ? y[index] : null;
    const good =
      typeof a === "number" &&
      typeof b === "number" &&
      Number.isFinite(a) &&
      Number.isFinite(b) &&
      (!positiveX || a > 0) &&
      (!positiveY || b > 0);
    if (good && start < 0) start = index;
    if (!good && start >= 0) {
      runs.push([start, index - 1]);
      start = -1;
    }
  }
  return runs;
}

/**
 * The relevant samples if many fall on one pixel column: first, minimum, maximum and last of each column. `columns`
 * holds the pixel column of each sample of the run, not decreasing. Returns indices in order.
 */
export function columnExtremes(columns: readonly number[], values: readonly number[]): number[] {
  const kept: number[] = [];
  let start = 0;
  while (start < columns.length) {
    let end = start;
    let min = start;
    let greatest = start;
    while (end + 1 < columns.length && columns[end + 1] === columns[start]) {
      end += 1;
      if (values[end]! < values[min]!) min = end;
      if (values[end]! > values[greatest]!) greatest = end;
    }
    for (const index of [...new Set([start, Math.min(min, greatest), Math.max(min, greatest), end])])
      kept.push(index);
    start = end + 1;
  }
  return kept;
}
