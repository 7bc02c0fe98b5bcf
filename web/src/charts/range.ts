// Plots of an operating range over its scheduling variable: Ms and IAE, the settings, the plant; and the runs over
// time.
import type { Column, RangeContent, RangePassage, RangeRun, RangeTraces, ScheduleRow } from "../api/types.ts";
import type { Range } from "../plot/axis.ts";
import type { Frame, Mark, Pane, Trace } from "../plot/frame.ts";
import { formatNumber, quotient, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";

/** The drawn data: the design, the current rows, and the curves of these if they were moved. */
export interface RangeShown {
  designed: RangeContent;
  moved: RangeContent | null;
  rows: readonly ScheduleRow[];
  /** The limit; null: not known. */
  Ms: number | null;
  /** The limit on the IAE, over each place's own optimum; null: not known. */
  IAE: number | null;
  units: UnitNames;
}

const LINK = "range";
/** Factor of the limit beyond which curves may leave the picture. */
const MAX_OVER_LIMIT = 2.5;

const scheduledCurves = ({ designed, moved }: RangeShown) => (moved ?? designed).curves;

function traceOf(shown: RangeShown, quantity: "Ms" | "relative_IAE"): Trace[] {
  const { at, one } = shown.designed.curves;
  const scheduled = scheduledCurves(shown);
  return [
    ...(scheduled.schedule
      ? [{ name: "schedule", look: 1 as const, x: scheduled.at, y: scheduled.schedule[quantity] }]
      : []),
    ...(one ? [{ name: "one setting", look: 2 as const, x: at, y: one[quantity] }] : []),
  ];
}

/** From the smallest possible value to the drawn ones, with the limit in view. */
function rangeOfMs(traces: Trace[], limit: number | null): Range {
  const values = traces.flatMap(({ y }) => y.filter((value): value is number => typeof value === "number"));
  const over = 1 + MAX_OVER_LIMIT * ((limit ?? 1) - 1);
  const top = Math.min(Math.max(limit ?? 1, ...values), Math.max(over, 2));
  return [1 - 0.06 * (top - 1), top + 0.12 * (top - 1)];
}

const limitLine = (limit: number | null, label = `limit ${formatNumber(limit)}`): Mark[] =>
  limit === null ? [] : [{ kind: "level", value: limit, role: "limit", label }];

/** One setting may have many times the IAE of the schedule: a logarithmic axis shows both. */
const MAX_IAE = 100;

function rangeOfIAE(traces: Trace[]): Range {
  const values = traces.flatMap(({ y }) => y.filter((value): value is number => typeof value === "number"));
  return [Math.max(0.3, 0.95 * Math.min(1, ...values)), 1.15 * Math.min(MAX_IAE, Math.max(1.3, ...values))];
}

const uprights = (rows: readonly ScheduleRow[]): Mark[] =>
  rows.map((row) => ({ kind: "upright", value: row.at, role: "zero" }));

function over(shown: RangeShown): Pick<Frame, "x" | "link" | "cursorLabel" | "cursorKind" | "ownLegend"> {
  const { name, unit, from, to } = shown.designed.scheduling;
  const label = withUnit(name, unit ?? "");
  return {
    x: { kind: "linear", label, range: [from, to] },
    link: LINK,
    cursorLabel: label,
    cursorKind: "linear",
    ownLegend: true,
  };
}

const largest = (traces: RangeTraces | null | undefined, quantity: "Ms" | "relative_IAE"): string => {
  const values = (traces?.[quantity] ?? []).filter((value): value is number => typeof value === "number");
  return formatNumber(values.length > 0 ? Math.max(...values) : null);
};

/** Ms over IAE; the rows are marked in both. */
export function robustnessFrame(shown: RangeShown): Frame {
  const [Ms, IAE] = [traceOf(shown, "Ms"), traceOf(shown, "relative_IAE")];
  const scheduled = scheduledCurves(shown).schedule;
  const { one } = shown.designed.curves;
  const said = [
    ...(scheduled
      ? [
          `With the schedule Ms is at most ${largest(scheduled, "Ms")} and the IAE ${largest(scheduled, "relative_IAE")} times each operating point's own optimum.`,
        ]
      : []),
    ...(one
      ? [`With one setting Ms is at most ${largest(one, "Ms")} and the IAE ${largest(one, "relative_IAE")} times.`]
      : []),
  ];
  return {
    ...over(shown),
    title: "Ms and IAE over the range",
    description: said.join(" "),
    panes: [
      {
        y: { kind: "linear", label: "Ms", range: rangeOfMs(Ms, shown.Ms) },
        traces: Ms,
        marks: [
          ...uprights(shown.rows),
          ...limitLine(shown.Ms),
        ],
      },
      {
        y: { kind: "log", label: "IAE over optimum", range: rangeOfIAE(IAE) },
        traces: IAE,
        marks: [
          ...uprights(shown.rows),
          ...limitLine(shown.IAE, "allowance"),
        ],
      },
    ],
    fileName: "range-robustness",
  };
}

/** Kp, Ti and Td in use; null if there is neither a schedule nor one setting. */
export function settingsFrame(shown: RangeShown): Frame | null {
  const scheduled = scheduledCurves(shown);
  const { designed, units } = shown;
  const controller = designed.one?.controller;
  const panes = (["Kp", "Ti", "Td"] as const).flatMap((name): Pane[] => {
    const values = scheduled.schedule?.[name];
    const fixed = controller?.[name];
    const nothing = name === "Td" && !fixed && (values ?? []).every((value) => !value);
    if (nothing || (!values && typeof fixed !== "number")) return [];
    const traces: Trace[] = [
      ...(values ? [{ name: "schedule", look: 1 as const, x: scheduled.at, y: values }] : []),
      ...(typeof fixed === "number"
        ? [{ name: "one setting", look: 2 as const, x: designed.curves.at, y: designed.curves.at.map(() => fixed) }]
        : []),
    ];
    const unit = name === "Kp" ? quotient(units.u, units.y) : units.time;
    return [{ y: { kind: "linear", label: withUnit(name, unit) }, traces, marks: uprights(shown.rows) }];
  });
  if (panes.length === 0) return null;
  return {
    ...over(shown),
    title: "Settings",
    description: `${shown.rows.length} rows.`,
    panes,
    fileName: "range-settings",
  };
}

const known = (values: Column): boolean => values.some((value) => typeof value === "number" && value !== 0);

/** Gain, lags and dead time of the plant; a parameter that is unknown or 0 everywhere is not drawn. */
export function plantFrame(shown: RangeShown): Frame | null {
  const { curves } = shown.designed;
  const { units } = shown;
  const pane = (name: "K" | "T" | "L", label: string): Pane[] =>
    known(curves[name])
      ? [{ y: { kind: "linear", label }, traces: [{ name, look: "data", x: curves.at, y: curves[name] }] }]
      : [];
  const panes = [
    ...pane("K", withUnit("K", quotient(units.y, units.u))),
    ...pane("T", withUnit("T", units.time)),
    ...pane("L", withUnit("L", units.time)),
  ];
  if (panes.length === 0) return null;
  return {
    ...over(shown),
    title: "The plant",
    description: shown.designed.stated,
    panes,
    ownLegend: false,
    fileName: "range-plant",
  };
}

/** The runs of a passage, each with its name and look; a nonlinear controller has no gain. */
export function runsOf(passage: RangePassage): { name: string; look: 1 | 2 | 3; run: Partial<RangeRun> }[] {
  const runs = [
    { name: "schedule", look: 1 as const, run: passage.schedule },
    { name: "one setting", look: 2 as const, run: passage.one },
    { name: "nonlinear", look: 3 as const, run: passage.nonlinear },
  ];
  return runs.flatMap(({ name, look, run }) => (run ? [{ name, look, run }] : []));
}

/** A passage across the range: the output with its target, the input, the gain in use. `parameter`: a parameter
    moves instead of the set point. */
export function passageFrame(passage: RangePassage, parameter: string | null, units: UnitNames): Frame {
  const traces = (signal: "y" | "u" | "Kp"): Trace[] =>
    runsOf(passage).flatMap(({ name, look, run }) => {
      const values = run[signal];
      return values ? [{ name, look, x: passage.t.slice(0, values.length), y: values }] : [];
    });
  const target: Trace = { name: parameter ?? "set point", look: "data", x: passage.t, y: passage.target };
  return {
    title: `Run: ${passage.name}`,
    description: `Run on the equations over ${formatNumber(passage.horizon)} ${units.time}, with scheduled settings.`,
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes: [
      {
        y: { kind: "linear", label: withUnit("y", units.y) },
        traces: [...traces("y"), ...(parameter === null ? [target] : [])],
        weight: 1.6,
      },
      ...(parameter === null
        ? []
        : [{ y: { kind: "linear" as const, label: parameter }, traces: [target], weight: 0.7 }]),
      { y: { kind: "linear", label: withUnit("u", units.u) }, traces: traces("u") },
      { y: { kind: "linear", label: withUnit("Kp", quotient(units.u, units.y)) }, traces: traces("Kp"), weight: 0.8 },
    ],
    ownLegend: true,
    link: "range-run",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: `range-${passage.name.replaceAll(" ", "-")}`,
  };
}
