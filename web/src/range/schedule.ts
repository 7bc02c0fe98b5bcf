// A schedule moved by hand: allowed places of its rows, requests during a move, and sentences. No DOM.
import type { RangeContent, ScheduleRow } from "../api/types.ts";
import type { RangeRequest } from "../api/range.ts";
import { formatNumber } from "../words/numbers.ts";
import { placeWords } from "../words/range.ts";

/** The smallest distance of two rows, as a part of the range. */
const APART = 0.005;

export interface Extent {
  from: number;
  to: number;
}

/** The allowed places of a row: within the range, between its neighbours. */
export function reachOf(rows: readonly ScheduleRow[], index: number, { from, to }: Extent): [number, number] {
  const gap = APART * (to - from);
  const before = rows[index - 1];
  const after = rows[index + 1];
  return [before ? before.at + gap : from, after ? after.at - gap : to];
}

/** Only the digits that a drag can set. */
const settable = (at: number, { from, to }: Extent): number => {
  const decimals = Math.max(0, Math.min(12, 3 - Math.floor(Math.log10(to - from))));
  return Number(at.toFixed(decimals));
};

/** The rows with one of them at another place, or as near to it as its neighbours allow; its settings stay. */
export function movedRow(rows: readonly ScheduleRow[], index: number, at: number, extent: Extent): ScheduleRow[] {
  const [lo, hi] = reachOf(rows, index, extent);
  const place = Math.min(hi, Math.max(lo, settable(at, extent)));
  return rows.map((row, other) => (other === index ? { ...row, at: place } : row));
}

/** Steps of the keys: an arrow, and Shift with it or a page. */
const STEP = 0.005;
const FAR_STEP = 0.05;

/** The place to which a key moves a handle; null for another key. */
export function keyedPlace(
  key: string,
  shift: boolean,
  at: number,
  reach: [number, number],
  { from, to }: Extent,
): number | null {
  const arrow = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[key];
  const page = { PageUp: 1, PageDown: -1 }[key];
  if (key === "Home") return reach[0];
  if (key === "End") return reach[1];
  if (page) return at + page * FAR_STEP * (to - from);
  return arrow ? at + arrow * (shift ? FAR_STEP : STEP) * (to - from) : null;
}

export const sameRows = (a: readonly ScheduleRow[], b: readonly ScheduleRow[]): boolean =>
  JSON.stringify(a) === JSON.stringify(b);

/** True if two requests ask for the same design, apart from names, units and given rows. */
export function sameDesign(a: RangeRequest, b: RangeRequest): boolean {
  const bare = (request: RangeRequest): string => {
    const { name: _name, units: _units, scheduling: _scheduling, schedule = {}, ...others } = request;
    const { given: _given, ...terms } = schedule;
    return JSON.stringify({ ...others, schedule: terms });
  };
  return bare(a) === bare(b);
}

/** True if limits hold over the region of each record, which takes too long for a drag. */
export const overRegion = ({ points, uncertainty }: RangeRequest): boolean =>
  uncertainty !== "none" && Boolean(points?.some((point) => point.record));

/** The request about given rows. `quick`: replaces records by the models identified from them, which is fast enough
    for a drag. */
export function givenRequest(
  request: RangeRequest,
  designed: RangeContent,
  rows: ScheduleRow[],
  { runs, quick }: { runs: boolean; quick: boolean },
): RangeRequest {
  const { rows: _rows, ...schedule } = request.schedule ?? {};
  const asked: RangeRequest = { ...request, schedule: { ...schedule, given: rows }, runs };
  if (!request.points || (overRegion(request) && !quick)) return asked;
  const { identify: _identify, uncertainty: _uncertainty, ...known } = asked;
  const points = request.points.map((point, index) =>
    point.record ? { at: point.at, plant: designed.points[index]!.plant } : point,
  );
  return { ...known, points };
}

/** The design's result for one setting stays; the schedule and its curves are those of the current rows. */
export interface ShownRange {
  designed: RangeContent;
  /** The content for the moved rows; null: none was moved. */
  moved: RangeContent | null;
}

/** The spoken text of a handle. */
export function handleWords(row: ScheduleRow, index: number, { designed, moved }: ShownRange): string {
  const worst = (moved ?? designed).worst.schedule?.find((place) => place.quantity === "Ms");
  const Ms = worst ? `, largest Ms ${formatNumber(worst.value)}` : "";
  return `Row ${index + 1} at ${placeWords(row.at, designed.scheduling, 5)}, Kp ${formatNumber(row.Kp)}${Ms}`;
}
