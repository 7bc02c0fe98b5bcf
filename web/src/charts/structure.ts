// Loops around the loop: every output and u after a step of each input, |S| over frequency with its limits, and the
// choices for a level.
import type { StructureAnswer } from "../api/structure.ts";
import { extent } from "../plot/axis.ts";
import type { Frame, Look, Mark, Pane, Trace } from "../plot/frame.ts";
import { formatNumber, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { nameOfDesign, nameOfInput, nameOfLoop } from "../words/structure.ts";

/** The run of the controllers' program, call by call with limits. */
const PROGRAM = "program";

/** The designs, the one of the answer first; the others are drawn thinner, as far as there are looks. */
const ORDER = ["design", "given", "optimum", PROGRAM, "baseline", "single", "pid", "blt", "none", "inverse", "guzman_hagglund", "detuned", "static"];
const LOOKS: readonly Look[] = [1, 2, 3, 4];

const placeOf = (of: string): number => (ORDER.includes(of) ? ORDER.indexOf(of) : ORDER.length);

function drawnDesigns(all: readonly string[]): string[] {
  return [...new Set(all)].sort((a, b) => placeOf(a) - placeOf(b)).slice(0, LOOKS.length);
}

const isInput = (name: string): boolean => /^(u|outflow)(_|$)/.test(name);

/** A pane for each signal: outputs come first, and are higher. */
function responsePane(name: string, traces: Trace[], units: UnitNames): Pane {
  const label = name.replace("_", " ");
  const unit = name === "u" || name === "outflow" ? units.u : name === "y" || name === "level" ? units.y : "";
  return { y: { kind: "linear", label: withUnit(label, unit) }, traces, weight: isInput(name) ? 1 : 1.4 };
}

type Response = StructureAnswer["responses"][number];

/** The run of the program, as if it were another design. */
const programOf = ({ structure, sampled }: StructureAnswer): Response[] =>
  (sampled?.responses ?? []).map(({ input, t, signals }) => ({
    of: PROGRAM,
    input,
    t,
    signals: signals.map(({ name, values }) => ({ name: structure === "level" && name === "u" ? "outflow" : name, values })),
  }));

/** A frame for each input, by its name. `sizes`: of the steps of the program's run; one that differs has a frame of its own. */
export function structureResponses(answer: StructureAnswer, units: UnitNames, sizes: Record<string, number> = {}): [input: string, frame: Frame][] {
  const program = programOf(answer).map((one) => ((sizes[one.input] ?? 1) === 1 ? one : { ...one, input: `${one.input} of ${sizes[one.input]!}` }));
  const responses = [...answer.responses, ...program];
  const designs = drawnDesigns(responses.map(({ of }) => of));
  const inputs = [...new Set(responses.map(({ input }) => input))];
  return inputs.map((input) => {
    const shown = designs.flatMap((of, index) => {
      const response = responses.find((candidate) => candidate.input === input && candidate.of === of);
      return response ? [{ ...response, index }] : [];
    });
    // The run of the program may go on for much longer.
    const horizon = Math.max(0, ...shown.filter(({ of }) => of !== PROGRAM).map(({ t }) => t.at(-1) ?? 0));
    const names = [...new Set(shown.flatMap(({ signals }) => signals.map(({ name }) => name)))].sort((a, b) => Number(isInput(a)) - Number(isInput(b)));
    const panes = names.map((name) => {
      const traces = shown.flatMap(({ of, t, signals, index }): Trace[] => {
        const signal = signals.find((candidate) => candidate.name === name);
        return signal ? [{ name: nameOfDesign(of), look: LOOKS[index]!, thin: index > 0 && of !== PROGRAM, x: t, y: signal.values }] : [];
      });
      return responsePane(name, traces, units);
    });
    const peaks = shown.map(({ of, signals }) => {
      const first = signals[0]?.values.filter((value) => value !== null) ?? [];
      const far = first.reduce((most, value) => (Math.abs(value) > Math.abs(most) ? value : most), 0);
      return `${nameOfDesign(of)}: ${signals[0]?.name ?? "y"} is farthest from 0 at ${formatNumber(far)}.`;
    });
    const frame: Frame = {
      title: nameOfInput(input),
      description: peaks.join(" "),
      x: { kind: "linear", label: withUnit("time", units.time), ...(horizon > 0 ? { range: [0, horizon] as const } : {}) },
      panes,
      ownLegend: true,
      link: "structure-time",
      cursorLabel: withUnit("time", units.time),
      cursorKind: "linear",
      fileName: `structure-${input.replaceAll("_", "-")}`,
    };
    return [input, frame];
  });
}

/** Null without curves. */
export function structureSensitivities({ sensitivities }: StructureAnswer, units: UnitNames): Frame | null {
  if (sensitivities.curves.length === 0) return null;
  const { omega, curves } = sensitivities;
  const main = drawnDesigns(curves.map(({ of }) => of))[0]!;
  const own = curves.filter(({ of }) => of === main).slice(0, LOOKS.length);
  const others = curves.filter(({ of, loop }) => of !== main && own.some((curve) => curve.loop === loop));
  const trace = ({ of, loop, values }: (typeof curves)[number], thin: boolean): Trace => ({
    name: thin ? `${nameOfDesign(of)}, ${nameOfLoop(loop)}` : nameOfLoop(loop),
    look: LOOKS[own.findIndex((curve) => curve.loop === loop)]!,
    thin,
    x: omega,
    y: values,
  });
  const traces = [...own.map((curve) => trace(curve, false)), ...others.map((curve) => trace(curve, true))];
  const limits = [...new Set(own.flatMap(({ limit }) => (typeof limit === "number" ? [limit] : [])))];
  const [lo, hi] = extent([...traces.map(({ y }) => y), limits], "log");
  const bottom = Math.max(lo, hi / DEPTH);
  const first = omega.findIndex((_, index) => own.some(({ values }) => (values[index] ?? 0) >= bottom));
  const peaks = own.map(({ loop, values, limit }) => {
    const peak = Math.max(...values.map((value) => value ?? 0));
    return `${nameOfLoop(loop)}: peak ${formatNumber(peak)}${limit === undefined ? "" : `, limit ${formatNumber(limit)}`}.`;
  });
  return {
    title: "Sensitivity |S| of each loop",
    description: peaks.join(" "),
    x: { kind: "log", label: `ω (rad/${units.time})`, range: [omega[Math.max(0, first)]!, omega.at(-1)!] },
    panes: [
      {
        y: { kind: "log", label: "|S|", range: [bottom, hi * HEADROOM] },
        traces,
        marks: limits.map((value): Mark => ({ kind: "level", value, role: "limit", label: `limit ${formatNumber(value)}` })),
      },
    ],
    ownLegend: true,
    link: "structure-omega",
    cursorLabel: `ω (rad/${units.time})`,
    cursorKind: "log",
    fileName: "structure-sensitivities",
  };
}

/** Deeper values of |S| do not concern robustness. */
const DEPTH = 20;
/** Room for the name of a limit above its line. */
const HEADROOM = 1.3;

/** What each damping costs: the rate of the outflow against its overshoot. Null for the other structures. */
export function levelChoices(answer: StructureAnswer): Frame | null {
  if (answer.structure !== "level") return null;
  const { design, frontier } = answer;
  const sorted = [...frontier].sort((a, b) => (a.overshoot_percent ?? 0) - (b.overshoot_percent ?? 0));
  const label = "overshoot of the outflow (%)";
  const point = (of: typeof design, name: string, look: Look, quiet: boolean): Mark[] =>
    of.overshoot_percent === null || of.rate_over_bound === null ? [] : [{ kind: "point", x: of.overshoot_percent, y: of.rate_over_bound, label: name, look, quiet }];
  return {
    title: "Rate against overshoot of the outflow",
    description: `The design: ${formatNumber(design.rate_over_bound)} times the lowest rate, overshoot ${formatNumber(design.overshoot_percent)} %.`,
    x: { kind: "linear", label },
    panes: [
      {
        y: { kind: "linear", label: "largest rate over the lowest possible" },
        traces: [{ name: "PI controllers that use all the room", look: 2, x: sorted.map((of) => of.overshoot_percent), y: sorted.map((of) => of.rate_over_bound) }],
        marks: [
          { kind: "level", value: 1, role: "limit", label: "no controller is below" },
          ...frontier.flatMap((of) => point(of, of.zeta === 0 ? "P alone" : `zeta ${formatNumber(of.zeta, 2)}`, 2, true)),
          ...point(design, "design", 1, false),
        ],
      },
    ],
    ownLegend: true,
    link: "structure-level",
    cursorLabel: label,
    cursorKind: "linear",
    fileName: "level-choices",
  };
}
