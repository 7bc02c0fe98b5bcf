// Answers of a check with every kind of cause, made by hand: what the page shows of them must not depend on the service's
// judgement of a record.

const ROWS = 60;
const count = (length, of) => Array.from({ length }, (_, index) => of(index));

/** A wave about a set point, as a record is drawn. */
function trend(period, { y = 50, amplitude = 2, r = true } = {}) {
  const t = count(ROWS, (index) => 10 * index);
  const wave = t.map((at) => Math.sin((2 * Math.PI * at) / period));
  return {
    t,
    y: wave.map((value) => y + amplitude * value),
    ...(r ? { r: t.map(() => y) } : {}),
    u: wave.map((value) => 40 - value),
  };
}

const NO_VALVE = { size: "Only a sticking valve or a backlash has one.", jump: "Only a sticking valve or a backlash has one." };

const ACTIONS = {
  healthy: ["none", "nobody"],
  stiction: ["repair-valve", "instruments"],
  tight: ["retune", "control"],
  sluggish: ["retune", "control"],
  external: ["find-source", "process"],
  manual: ["return-to-automatic", "operations"],
  undetermined: ["test", "control"],
  "insufficient-data": ["record-again", "control"],
};

const isOpen = (verdict) => verdict === "undetermined" || verdict === "insufficient-data";

/** The answer about one loop; `period` 0: it does not oscillate. */
export function madeLoop(tag, verdict, { period = 100, confidence = "sure", automatic = 0.98, more = {} } = {}) {
  const [code, owner] = ACTIONS[verdict];
  const drawn = period > 0 ? trend(period) : trend(1e9);
  return {
    tag,
    quality: {
      rows: 8640,
      sample_time: 10,
      duration: 86400,
      missing: 0.01,
      held: 0.2,
      longest_gap: 60,
      noise: 0.04,
      y_step: 0.01,
      u_step: 0,
      compressed: false,
      enough: verdict !== "insufficient-data",
      remarks: verdict === "insufficient-data" ? [{ code: "short-record", level: "bad", detail: "The record has 40 usable rows; a check needs at least 200." }] : [],
      readings: [],
    },
    service: {
      automatic,
      manual: automatic === null ? null : 1 - automatic,
      saturated_low: 0,
      saturated_high: 0.125,
      output_still: 0,
      measurement_still: 0,
      ...(automatic === null ? { why_null: { automatic: "The record has no column of the mode.", manual: "The record has no column of the mode." } } : {}),
    },
    oscillation:
      period > 0
        ? { found: true, period, regularity: 12, periods: [{ period, period_error: period / 50, regularity: 12, share: 0.8, amplitude: 2 }] }
        : { found: false, period: null, regularity: null, periods: [] },
    cause: {
      verdict,
      confidence: isOpen(verdict) ? "open" : confidence,
      evidence: isOpen(verdict) ? [] : [{ code: "made", value: -0.5, limit: 0.3, detail: `The figure for ${verdict} is -0.5.` }],
      alternatives: verdict === "stiction" ? ["tight"] : [],
      size: verdict === "stiction" ? 3.2 : null,
      jump: verdict === "stiction" ? 1.5 : null,
      period: null,
      ...(isOpen(verdict) ? { why_open: "The record does not show the cause." } : {}),
      why_null: NO_VALVE,
    },
    performance: {
      harris: { low: 0.1, high: 0.45, delays: [10, 90] },
      idle_index: -0.25,
      variability: 1.4,
      variability_share: 0.014,
      mean_error: 1.25,
      following: null,
      travel: 2.5,
      reversals: 40,
      why_null: { following: "The set point hardly moves." },
    },
    action: { code, owner, detail: `What to do about ${verdict}.` },
    trend: drawn,
    excerpt: drawn,
    spectrum: { x: count(20, (index) => 20 * 1.3 ** index), y: count(20, (index) => (index === 6 ? 0.8 : 0.01)) },
    autocorrelation: { x: count(40, (index) => 10 * index), y: count(40, (index) => Math.cos((2 * Math.PI * 10 * index) / (period || 1e9))) },
    shape: {
      from: 0,
      to: 86400,
      dated: false,
      period,
      spectrum: count(96, (band) => (Math.abs(1e5 ** ((band + 0.5) / 96) / (period || 1) - 1) < 0.1 ? 0.8 : 0.001)),
      wave: [],
      wave_from: 0,
      wave_step: 0,
      set_point: [],
      output: [],
    },
    ...more,
  };
}

const WHY_NO_GAIN = "The cause is open.";

/** A place in the work list; `share` null: the gain is not known. */
export const madeRank = (loop, share, { money = null, effort = 1, ...more } = {}) => ({
  loop,
  gain: share === null ? null : share * 1.25,
  share,
  money,
  effort,
  ...(share === null ? { why_null: { gain: WHY_NO_GAIN, share: WHY_NO_GAIN, money: WHY_NO_GAIN } } : {}),
  ...more,
});

/** Eight loops: two groups with common periods, one cascade. The ranking differs from the order of the loops. */
export function madeAnswer() {
  const loops = [
    madeLoop("FIC-101", "healthy", { period: 0 }),
    madeLoop("FIC-102", "stiction", { period: 100 }),
    madeLoop("LIC-103", "external", { period: 101, confidence: "likely" }),
    madeLoop("TIC-104", "sluggish", { period: 0, confidence: "likely" }),
    madeLoop("PIC-105", "tight", { period: 30 }),
    madeLoop("PIC-106", "manual", { period: 0, automatic: 0 }),
    madeLoop("AIC-107", "undetermined", { period: 31, automatic: null }),
    madeLoop("TIC-108", "insufficient-data", { period: 0, automatic: null, more: { trend: { t: [], y: [], u: [] }, excerpt: { t: [], y: [], u: [] }, spectrum: { x: [], y: [] }, autocorrelation: { x: [], y: [] } } }),
  ];
  return {
    loops,
    clusters: [
      { period: 100.5, loops: [1, 2], source: 1, detail: "The oscillation with a period of 100 s is made in FIC-102 itself." },
      { period: 30.5, loops: [4, 6], detail: "No loop stands out as the source." },
    ],
    cascades: [{ master: 3, slave: 0 }],
    ranking: [
      madeRank(1, 0.5, { effort: 3, money: 40 }),
      madeRank(4, 0.4, { money: 60 }),
      madeRank(3, 0.3),
      madeRank(5, null, { effort: 1 }),
      madeRank(2, null, { effort: 3, after: 1 }),
      madeRank(6, null, { effort: 2 }),
      madeRank(7, null, { effort: 2 }),
      madeRank(0, 0, { effort: 0 }),
    ],
    partial: false,
    version: "test",
    request_hash: "0",
  };
}

/** The request for that answer. */
export const madeRequest = ({ loops }) => ({
  name: "Unit 21",
  loops: loops.map(({ tag }) => ({ tag, csv: "t,sp,pv,op\n0,50,49,40\n10,50,51,39\n" })),
});

/** A job with that answer. */
export const madeJob = (id, result, more = {}) => ({
  id,
  name: "Unit 21",
  status: "succeeded",
  progress: null,
  created_at: "2026-05-04T06:00:00Z",
  started_at: "2026-05-04T06:00:00Z",
  finished_at: "2026-05-04T06:00:01Z",
  attempts: 1,
  request: madeRequest(result),
  result,
  ...more,
});
