// Revised IMC: the effect of the parameter lambda. The load response's peak and Ms over lambda/tau, with the current
// design marked.
import type { Entry, Response, Rimc } from "../api/types.ts";
import type { Frame, Mark, Trace } from "../plot/frame.ts";
import { formatNumber, product, quotient, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";

/** `tau`: of the model of the design. `lambda`: the marked value. Null without a curve. */
export function rimcFrame(rimc: Rimc, tau: number, lambda: number, units: UnitNames): Frame | null {
  const curve = rimc.disturbance_peak_curve;
  if (!curve || curve.lambda_over_tau.length < 2 || !(tau > 0)) return null;
  const at = lambda / tau;
  const peak = interpolate(curve.lambda_over_tau, curve.DP_over_kp, at);
  const Ms = interpolate(curve.lambda_over_tau, curve.Ms, at);
  const limit: Mark[] =
    typeof rimc.stability_limit === "number" && rimc.stability_limit > 0
      ? [{ kind: "upright", value: rimc.stability_limit / tau, role: "limit" }]
      : [];
  const marks = (y: number | null, quantity: string): Mark[] => [
    ...limit,
    { kind: "upright", value: at, role: "setpoint" },
    ...(y === null ? [] : [{ kind: "point" as const, x: at, y, label: `${quantity} ${formatNumber(y)}` }]),
  ];
  const name = withUnit("λ", units.time);
  return {
    title: "Effect of λ: load peak and Ms",
    description: `At ${name} ${formatNumber(lambda)} a load step moves y by ${formatNumber(peak)} times its response without control; Ms is ${formatNumber(Ms)}.`,
    x: { kind: "log", label: "λ/τ" },
    panes: [
      {
        y: { kind: "linear", label: "DP/k_p" },
        traces: [{ name: "load peak divided by the gain", look: 1, x: curve.lambda_over_tau, y: curve.DP_over_kp }],
        marks: marks(peak, "DP/k_p"),
        weight: 1.2,
      },
      {
        y: { kind: "log", label: "Ms" },
        traces: [{ name: "Ms", look: 1, x: curve.lambda_over_tau, y: curve.Ms }],
        marks: marks(Ms, "Ms"),
      },
    ],
    link: "lambda",
    cursorLabel: "λ/τ",
    cursorKind: "log",
    fileName: "rimc-lambda",
  };
}

/** The load response of the PID and that of the controller it approximates; null if one of them is missing. */
export function fullControllerFrame(rimc: Rimc, pid: Response | undefined, units: UnitNames): Frame | null {
  const full = rimc.full_controller?.responses?.load;
  if (!full || !pid) return null;
  const traces = (signal: "y" | "u"): Trace[] => [
    { name: "PID", look: 1, x: pid.t, y: pid[signal] },
    { name: "full controller", look: 4, x: full.t, y: full[signal] },
  ];
  return {
    title: "Load step: PID and full controller",
    description: "The PID compared with the full controller.",
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes: [
      { y: { kind: "linear", label: withUnit("y", units.y) }, traces: traces("y"), weight: 1.5 },
      { y: { kind: "linear", label: withUnit("u", units.u) }, traces: traces("u") },
    ],
    ownLegend: true,
    link: "time",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: "rimc-load-step",
  };
}

/** Interpolates between the samples that are numbers; null outside them. `x` increases. */
export function interpolate(x: readonly number[], y: readonly (number | null)[], at: number): number | null {
  for (let index = 1; index < x.length; index += 1) {
    const [x0, x1] = [x[index - 1]!, x[index]!];
    const [y0, y1] = [y[index - 1], y[index]];
    if (at < x0 || at > x1 || typeof y0 !== "number" || typeof y1 !== "number") continue;
    return x1 === x0 ? y0 : y0 + ((at - x0) / (x1 - x0)) * (y1 - y0);
  }
  return null;
}

export interface RimcRow {
  label: string;
  meaning: string;
  pid: number | null;
  full: number | null;
  /** The reason why the PID has no figure, or "". */
  why: string;
}

/** Figures of the PID and of the full controller, in columns. */
export function rimcRows(entry: Entry, units: UnitNames): RimcRow[] {
  const rimc = entry.rimc;
  if (!rimc) return [];
  const robustness = rimc.full_controller?.robustness;
  const load = rimc.full_controller?.load;
  const row = (label: string, meaning: string, name: keyof Rimc, full: unknown): RimcRow => ({
    label,
    meaning,
    pid: numberOf(rimc[name]),
    full: numberOf(full),
    why: rimc.why_null?.[name] ?? "",
  });
  return [
    row(withUnit("λ", units.time), "time constant of the closed loop", "lambda", rimc.lambda),
    row("Ms", "peak of |S|", "Ms", robustness?.Ms),
    row(
      withUnit("Load peak", quotient(units.y, units.u)),
      "of y, a unit load step",
      "disturbance_peak",
      load?.["peak"],
    ),
    row(withUnit("Dead time error", units.time), "tolerated with certainty", "dead_time_error", null),
    row(withUnit("Unstable below λ", units.time), "stability limit", "stability_limit", null),
    {
      label: withUnit("Load IAE", product(units.y, units.time)),
      meaning: "on the plant as given",
      pid: numberOf(entry.performance?.load?.["IAE"]),
      full: numberOf(load?.["IAE"]),
      why: entry.performance?.load?.why_null?.["IAE"] ?? "",
    },
  ];
}

const numberOf = (value: unknown): number | null => (typeof value === "number" ? value : null);
