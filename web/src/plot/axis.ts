// Ranges, scales, ticks and their texts, linear and logarithmic. Every function returns for every input: no data, one
// value, or values that are not valid.

export type ScaleKind = "linear" | "log";
export type Range = readonly [number, number];

export interface Scale {
  kind: ScaleKind;
  /** In data units, lo < hi. */
  range: Range;
  /** Data to pixels. */
  toPixel(value: number): number;
  /** Pixels to data. */
  toValue(pixel: number): number;
}

const EMPTY: Record<ScaleKind, Range> = { linear: [0, 1], log: [0.1, 10] };

/** A range that can be drawn: finite, ordered, not empty; positive for a log axis. */
export function usableRange(lo: number, hi: number, kind: ScaleKind): Range {
  if (kind === "log") {
    if (!(lo > 0) || !(hi > 0) || !Number.isFinite(lo) || !Number.isFinite(hi)) return EMPTY.log;
    return lo < hi ? [lo, hi] : [lo / 2, lo * 2];
  }
  if (!Number.isFinite(lo) || !Number.isFinite(hi) || lo > hi) return EMPTY.linear;
  if (hi - lo <= 1e-12 * Math.max(Math.abs(lo), Math.abs(hi))) {
    const half = lo === 0 ? 1 : Math.abs(lo) / 2;
    return [lo - half, hi + half];
  }
  return [lo, hi];
}

/** The extent of all values that can be drawn, widened by `margin` of itself at both ends (in decades on a log axis). */
export function extent(lists: readonly (readonly (number | null)[])[], kind: ScaleKind, margin = 0): Range {
  let lo = Infinity;
  let hi = -Infinity;
  for (const list of lists) {
    for (const value of list) {
      if (value === null || !Number.isFinite(value) || (kind === "log" && value <= 0)) continue;
      if (value < lo) lo = value;
      if (value > hi) hi = value;
    }
  }
  const [a, b] = usableRange(lo, hi, kind);
  if (kind === "log") {
    const factor = (b / a) ** margin;
    return [a / factor, b * factor];
  }
  return [a - margin * (b - a), b + margin * (b - a)];
}

export function makeScale(kind: ScaleKind, range: Range, pixels: Range): Scale {
  const [lo, hi] = usableRange(range[0], range[1], kind);
  const [p0, p1] = pixels;
  if (kind === "log") {
    const a = Math.log(lo);
    const width = Math.log(hi) - a;
    return {
      kind,
      range: [lo, hi],
      toPixel: (value) => p0 + ((Math.log(value) - a) / width) * (p1 - p0),
      toValue: (pixel) => Math.exp(a + ((pixel - p0) / (p1 - p0)) * width),
    };
  }
  return {
    kind,
    range: [lo, hi],
    toPixel: (value) => p0 + ((value - lo) / (hi - lo)) * (p1 - p0),
    toValue: (pixel) => lo + ((pixel - p0) / (p1 - p0)) * (hi - lo),
  };
}

/** Tick values inside the range, about `count` of them, at least three if the numbers allow it. */
export function ticks(kind: ScaleKind, range: Range, count: number): number[] {
  const [lo, hi] = usableRange(range[0], range[1], kind);
  const wanted = Math.max(3, Math.min(20, Math.round(count) || 3));
  if (kind === "linear") return linearTicks(lo, hi, wanted);
  const decades = logTicks(lo, hi, wanted, count);
  return decades.length >= 3 ? decades : linearTicks(lo, hi, wanted).filter((value) => value > 0);
}

function linearTicks(lo: number, hi: number, wanted: number): number[] {
  let chosen: number[] = [];
  const rough = (hi - lo) / wanted;
  const decade = 10 ** Math.floor(Math.log10(rough));
  // From coarse to fine: the first step that gives enough ticks wins.
  for (const factor of [10, 5, 2, 1, 0.5, 0.2, 0.1]) {
    const step = decade * factor;
    const first = Math.ceil(lo / step - 1e-9);
    const last = Math.floor(hi / step + 1e-9);
    if (last - first > 40) break;
    chosen = [];
    for (let index = first; index <= last; index += 1) chosen.push(clean(index, step));
    if (chosen.length >= Math.min(wanted, 3) && step <= rough * 2.001) break;
  }
  return chosen;
}

/** index * step without the rounding error of a decimal step. */
function clean(index: number, step: number): number {
  return Number((index * step).toPrecision(12));
}

/** Every `every`-th decade: the exponents that are multiples of it, if there are three of them. */
function thinned(decades: number[], every: number): number[] {
  const round = decades.filter((value) => Math.round(Math.log10(value)) % every === 0);
  if (round.length >= 3) return round;
  return every > 2 ? thinned(decades, every - 1) : decades.filter((_, index) => index % 2 === 0);
}

/** With this number of ticks of room per decade, 1, 2 and 5 do not overlap. */
const FINE_PER_DECADE = 1.3;

/** `room`: how many ticks fit; `wanted`: the same, and at least three. */
function logTicks(lo: number, hi: number, wanted: number, room: number): number[] {
  const first = Math.floor(Math.log10(lo));
  const last = Math.ceil(Math.log10(hi));
  const inside = (mantissas: number[]): number[] => {
    const list: number[] = [];
    for (let exponent = first; exponent <= last; exponent += 1) {
      for (const mantissa of mantissas) {
        const value = Number(`${mantissa}e${exponent}`);
        if (value >= lo * (1 - 1e-9) && value <= hi * (1 + 1e-9)) list.push(value);
      }
    }
    return list;
  };
  const fine = inside([1, 2, 5]);
  if (fine.length >= 3 && Math.log10(hi / lo) * FINE_PER_DECADE <= room) return fine;
  for (const mantissas of [[1], [1, 3]]) {
    const list = inside(mantissas);
    if (list.length > wanted + 2 && mantissas.length === 1) return thinned(list, Math.ceil(list.length / wanted));
    if (list.length >= 3) return list;
  }
  return fine;
}

const MINUS = "−";

const isLong = (size: number): boolean => size !== 0 && (size >= 1e5 || size < 1e-3);
const written = (text: string): string => text.replaceAll("-", MINUS);

/** The text of a number: no rounding errors, true minus, powers of ten if plain digits would be long. */
export function tickText(value: number): string {
  if (value === 0) return "0";
  const text = isLong(Math.abs(value)) ? value.toExponential().replace("e+", "e") : String(Number(value.toPrecision(10)));
  return written(text);
}

/** The texts of an axis's ticks, in one notation. */
export function tickTexts(values: readonly number[]): string[] {
  if (!values.some((value) => isLong(Math.abs(value)))) return values.map(tickText);
  return values.map((value) => (value === 0 ? "0" : value === 1 ? "1" : written(value.toExponential().replace("e+", "e"))));
}
