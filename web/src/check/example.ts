// The plant of the example: six loops of one hour and a half, simulated, so that a check can be tried without a file.
// FIC101 has a sticking valve; its flow disturbs the temperature TIC102. TIC103 is tuned too slow and gives FIC104 its set
// point. PIC105 is close to its stability limit, and the valve of PIC106 is too small.
import type { CheckRequest } from "../api/types.ts";

const STEP_S = 1;
/** The historian stores every third value. */
const EVERY = 3;
const ROWS = 1800;
const START = "2026-03-02T06:00:00Z";

/** Deterministic noise with about the distribution of a sensor's: the sum of four even ones. */
function noise(seed: number): () => number {
  let state = seed;
  const next = (): number => {
    state = (Math.imul(state, 1_664_525) + 1_013_904_223) >>> 0;
    return state / 2 ** 32 - 0.5;
  };
  return () => 1.7 * (next() + next() + next() + next());
}

interface Made {
  set: number;
  measured: number;
  output: number;
}

interface LoopModel {
  /** Gain, lag and dead time in s. */
  K: number;
  T: number;
  L: number;
  Kp: number;
  Ti: number;
  noise: number;
  start: { y: number; u: number };
  /** Band in which the valve sticks, in %. */
  stick?: number;
  /** Output at most. */
  most?: number;
}

/** One loop in automatic: a PI controller, a valve, a plant of first order with dead time, a sensor. */
function loop(model: LoopModel, seed: number) {
  const sensor = noise(seed);
  const late: number[] = Array.from({ length: Math.round(model.L / STEP_S) + 1 }, () => model.start.u);
  let { y } = model.start;
  let integral = model.start.u;
  let valve = model.start.u;

  return (set: number, disturbance: number): Made => {
    const measured = y + model.noise * sensor();
    const error = set - measured;
    const wanted = integral + model.Kp * error;
    const output = Math.min(model.most ?? 100, Math.max(0, wanted));
    if (output === wanted) integral += (model.Kp * error * STEP_S) / model.Ti;
    if (Math.abs(output - valve) > (model.stick ?? 0)) valve = output;
    late.push(valve);
    const u = late.shift()! - model.start.u + disturbance;
    y += ((model.start.y - y + model.K * u) * STEP_S) / model.T;
    return { set, measured, output };
  };
}

const MODELS: Record<string, LoopModel> = {
  FIC101: { K: 1.2, T: 6, L: 2, Kp: 0.4, Ti: 9, noise: 0.12, start: { y: 60, u: 45 }, stick: 4 },
  TIC102: { K: 0.5, T: 150, L: 20, Kp: 3, Ti: 300, noise: 0.1, start: { y: 85, u: 55 } },
  TIC103: { K: 0.8, T: 90, L: 12, Kp: 0.6, Ti: 90, noise: 0.06, start: { y: 140, u: 40 } },
  FIC104: { K: 1, T: 5, L: 2, Kp: 0.5, Ti: 7, noise: 0.1, start: { y: 40, u: 38 } },
  PIC105: { K: 1.5, T: 20, L: 6, Kp: 2.7, Ti: 30, noise: 0.02, start: { y: 6, u: 50 } },
  PIC106: { K: 0.6, T: 25, L: 4, Kp: 1.6, Ti: 30, noise: 0.08, start: { y: 12, u: 82 } },
};

/** A load that jumps to another level after about `hold` s. */
function steps(seed: number, size: number, hold: number): () => number {
  const next = noise(seed);
  let value = 0;
  let left = hold;
  return () => {
    left -= STEP_S;
    if (left <= 0) {
      value = size * next();
      left = hold * Math.max(0.3, 1 + 0.6 * next());
    }
    return value;
  };
}

/** Slow changes of the load: a walk that returns to zero. */
function walk(seed: number, size: number, lag: number): () => number {
  const step = noise(seed);
  let value = 0;
  return () => (value += -value / lag + size * Math.sqrt(2 / lag) * step());
}

function lines(): Record<string, string[]> {
  const [flow, heated, temperature, inner, tight, small] = Object.values(MODELS).map((model, index) => loop(model, 11 + index));
  const [heat, header, demand] = [steps(3, 3, 400), walk(5, 0.3, 40), walk(7, 10, 700)];
  const written: Record<string, string[]> = Object.fromEntries(Object.keys(MODELS).map((tag) => [tag, ["time [s],SP,PV,OP,MODE"]]));
  for (let at = 0; at < ROWS * EVERY; at += 1) {
    const pressure = header();
    const first = flow!(61.5, 0.2 * pressure);
    const master = temperature!(at % 2700 < 1350 ? 140 : 146, heat());
    const made: Record<string, Made> = {
      FIC101: first,
      // A larger flow of the first loop cools what the second one heats.
      TIC102: heated!(85, pressure - (first.measured - 61.5)),
      TIC103: master,
      FIC104: inner!(Math.round(master.output), 0.6 * pressure),
      PIC105: tight!(at < 1800 ? 6 : 6.5, pressure),
      PIC106: small!(12, -14 + demand()),
    };
    if (at % EVERY !== 0) continue;
    for (const [tag, { set, measured, output }] of Object.entries(made))
      written[tag]!.push([at, set.toFixed(2), measured.toFixed(3), output.toFixed(2), "AUTO"].join(","));
  }
  return written;
}

const KINDS = { F: "flow", T: "temperature", P: "pressure" } as const;

export function examplePlant(): CheckRequest {
  return {
    name: "Example plant",
    loops: Object.entries(lines()).map(([tag, rows]) => ({
      tag,
      kind: KINDS[tag[0] as keyof typeof KINDS],
      start: START,
      csv: `${rows.join("\n")}\n`,
    })),
  };
}
