// The figures of a structure next to those of what it is compared with. No DOM.
import type { AnswerOf, StructureAnswer } from "../api/structure.ts";
import type { ExplainedName } from "../words/explained.ts";
import type { FigureGroup } from "../words/figures.ts";
import { formatNumber, product, quotient, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { nameOfDesign, nameOfInput, nameOfLoop } from "../words/structure.ts";

/** Figures by name, and the reasons for those that are missing; "": the reason for the others. */
export interface StructureColumn {
  title: string;
  figures: Record<string, number | null | undefined>;
  why: Record<string, string>;
}

export interface StructureTable {
  caption: string;
  columns: StructureColumn[];
  groups: FigureGroup<StructureColumn>[];
}

/** Collects the parts of an answer. The names of a part's figures begin with its key; lists are numbered from 1. */
function column(title: string, parts: Record<string, object | null | undefined>, none = "The service gave no figure."): StructureColumn {
  const made: StructureColumn = { title, figures: {}, why: { "": none } };
  for (const [prefix, part] of Object.entries(parts)) {
    const { why_null = {}, ...others } = (part ?? {}) as Record<string, unknown> & { why_null?: Record<string, string> };
    for (const [name, value] of Object.entries(others)) {
      if (typeof value === "number" || value === null) made.figures[prefix + name] = value;
      if (Array.isArray(value)) value.flat().forEach((item, index) => (made.figures[`${prefix}${name}_${index + 1}`] = item as number | null));
    }
    for (const [name, sentence] of Object.entries(why_null)) made.why[prefix + name] = sentence;
  }
  return made;
}

type Row = readonly [key: string, label: string, unit?: string, about?: ExplainedName];

const group = (title: string, rows: readonly Row[]): FigureGroup<StructureColumn> => ({
  title,
  main: true,
  rows: rows.map(([key, label, unit = "", about = null]) => ({
    label: withUnit(label, unit),
    meaning: "",
    about,
    value: ({ figures, why }) => (typeof figures[key] === "number" ? { text: formatNumber(figures[key]), why: "" } : { text: "", why: why[key] ?? why[""]! }),
  })),
});

const LOADS = [
  ["inner_load", "after a load at the valve"],
  ["outer_load", "after a load on the outer plant"],
] as const;
const STEPS = [...LOADS, ["setpoint", "after a set-point step"]] as const;

const steps = (inputs: readonly (readonly [string, string])[], figure: string, name: string, unit = "", about?: ExplainedName): Row[] =>
  inputs.map(([input, words]) => [`${input}.${figure}`, `${name} ${words}`, unit, ...(about ? [about] : [])] as unknown as Row);

function cascadeTable({ inner, outer, performance, single, baseline, speed_ratio }: AnswerOf<"cascade">, IAE: string): StructureTable {
  const stepsOf = (from: typeof performance): Record<string, object> => ({ "inner_load.": from.inner_load, "outer_load.": from.outer_load, "setpoint.": from.setpoint });
  const { Ms, Mt, ...margins } = outer.robustness;
  return {
    caption: "Figures of the cascade",
    columns: [
      column("design", { inner_: inner.robustness, outer_: { Ms, Mt }, "": { ...margins, speed_ratio }, ...stepsOf(performance) }),
      ...(single ? [column(nameOfDesign("single"), { Ms_: { valve: single.Ms }, ...stepsOf(single.performance) }, "Not a figure of a single loop.")] : []),
      ...(baseline
        ? [column(nameOfDesign("baseline"), { inner_: { Ms: baseline.robustness.Ms_inner }, outer_: { Ms: baseline.robustness.Ms_outer }, "": baseline.robustness, ...stepsOf(baseline.performance) }, "Not computed for today's settings.")]
        : []),
    ],
    groups: [
      group("Robustness", [
        ["inner_Ms", "Ms, inner loop", "", "Ms"],
        ["outer_Ms", "Ms, outer loop", "", "Ms"],
        ["Ms_valve", "Ms at the valve", "", "Ms"],
        ["gain_margin", "Gain margin, outer loop", "", "gain_margin"],
        ["phase_margin_deg", "Phase margin, outer loop", "°", "phase_margin_deg"],
        ["speed_ratio", "Speed of the inner loop over the outer one"],
      ]),
      group("y1 after unit steps", [...steps(STEPS, "IAE", "IAE", IAE, "IAE"), ...steps(LOADS, "peak", "Peak")]),
      group("Movement of u", steps(STEPS, "TV", "TV")),
    ],
  };
}

const feedforwardTable = ({ variants }: AnswerOf<"feedforward">, { time, u, y }: UnitNames, IAE: string): StructureTable => ({
  caption: "Figures with each compensator",
  columns: variants.map(({ kind, compensator, IAE_if_wrong, why_not, ...figures }) =>
    column(nameOfDesign(kind), { "": figures, "F.": compensator, "wrong.": IAE_if_wrong }, why_not ?? "There is no compensator."),
  ),
  groups: [
    group("After a unit step of the disturbance", [["IAE", "IAE", IAE, "IAE"], ["peak", "Peak of y", y], ["u_start", "First move of u", u], ["TV", "TV of u", u]]),
    group("IAE if the model is wrong", [
      ["wrong.disturbance_gain_low", "Disturbance gain lower", IAE],
      ["wrong.disturbance_gain_high", "Disturbance gain higher", IAE],
      ["wrong.plant_dead_time_short", "Dead time shorter", IAE],
      ["wrong.plant_dead_time_long", "Dead time longer", IAE],
    ]),
    group("Compensator", [["F.Kf", "Kf"], ["F.Tz", "Tz", time], ["F.Tp", "Tp", time], ["F.Lf", "Lf", time]]),
  ],
});

function levelTable({ design, frontier, robustness, bound }: AnswerOf<"level">, { time, u, y }: UnitNames): StructureTable {
  const why = {
    "": "Computed for the design alone.",
    Ti: "There is no integral action.",
    time_of_highest: "The level approaches its highest value without end.",
    ...robustness.why_null,
  };
  const choices = frontier.map((other) => column(other.zeta === 0 ? "P alone" : `zeta ${formatNumber(other.zeta, 2)}`, { "": other }));
  return {
    caption: "Figures of the level",
    columns: [column("design", { "": { ...design, bound, Ms: robustness.Ms } }), ...choices].map((made) => ({ ...made, why })),
    groups: [
      group("Controller", [["zeta", "Damping zeta"], ["Kc", "Kc", quotient(u, y)], ["Ti", "Ti", time], ["Ms", "Ms with the flow loop", "", "Ms"]]),
      group("After the largest step of the inflow", [
        ["highest", "Highest level", y],
        ["time_of_highest", "Time of the highest level", time],
        ["largest_rate", "Largest rate of the outflow", quotient(u, time)],
        ["bound", "Lowest rate that any controller can reach", quotient(u, time)],
        ["rate_over_bound", "Largest rate over that"],
        ["overshoot_percent", "Overshoot of the outflow", "%"],
      ]),
    ],
  };
}

type Decoupling = NonNullable<AnswerOf<"interaction">["decoupling"]>;

/** Its figures and its elements, as "D.1.2.Kf". */
const decouplerParts = (decoupling: Decoupling | null | undefined): Record<string, object | null> =>
  decoupling
    ? {
        "decoupler.": { gain: decoupling.gain, why_null: decoupling.why_null },
        "wrong.": decoupling.wrong_gains,
        ...Object.fromEntries(decoupling.D.flatMap((row, to) => row.map((element, from) => [`D.${to + 1}.${from + 1}.`, element] as const))),
      }
    : {};

function decouplerRows(all: readonly (Decoupling | null | undefined)[], time: string): Row[] {
  const decouplers = all.flatMap((one) => (one ? [one] : []));
  const elements = decouplers[0]?.D.flatMap((row, to) => row.flatMap((_, from) => (decouplers.some(({ D }) => D[to]?.[from]) ? [[to + 1, from + 1] as const] : []))) ?? [];
  return [
    ["decoupler.gain", "Weighted IAE without it over that with it"],
    ["wrong.mu", "Peak mu with a gain that is 20 % wrong"],
    ...elements.flatMap(([to, from]): Row[] => (["Kf", "Tz", "Tp", "Lf"] as const).map((name) => [`D.${to}.${from}.${name}`, `${name}, from loop ${from} to loop ${to}`, name === "Kf" ? "" : time])),
  ];
}

function interactionTables({ compared, rga, pairings, decoupling, ...design }: AnswerOf<"interaction">, time: string): StructureTable[] {
  const loops = rga.map((_, index) => index + 1);
  const decouplers = [decoupling, ...compared.map((other) => other.decoupling)];
  const each = (figure: string, name: (loop: number) => string, about?: ExplainedName): Row[] =>
    loops.map((loop) => [`${figure}_${loop}`, name(loop), "", ...(about ? [about] : [])] as unknown as Row);
  const pairs = (figure: string, words: (output: number, input: number) => string): Row[] =>
    loops.flatMap((output) => loops.map((input): Row => [`${figure}_${(output - 1) * loops.length + input}`, words(output, input), time]));
  return [
    {
      caption: "Figures of the loops together",
      columns: [column("design", { "": design, ...decouplerParts(decoupling) }), ...compared.map(({ name, why_not, decoupling: other, ...others }) => column(nameOfDesign(name), { "": others, ...decouplerParts(other) }, why_not ?? (others.stable ? "There is no decoupler." : "The loops are not stable.")))],
      groups: [
        group("Robustness", [
          ["mu", "Peak mu"],
          ["Lcm_dB", "Log modulus", "dB"],
          ...each("Ms_others_closed", (loop) => `Ms of loop ${loop}, the others closed`, "Ms"),
          ...each("Ms_alone", (loop) => `Ms of loop ${loop} alone`, "Ms"),
        ]),
        group("After unit loads", [["cost", "Weighted IAE"], ...pairs("IAE_load", (y, u) => `IAE of y${y} after a load at u${u}`)]),
        group("After unit set-point steps", pairs("IAE_setpoint", (y, r) => `IAE of y${y} after a step of r${r}`)),
        ...(decouplers.some(Boolean) ? [group("Decoupler", decouplerRows(decouplers, time))] : []),
      ],
    },
    {
      caption: "Relative gains at steady state",
      columns: loops.map((input) => column(`u${input}`, { y: { "": rga.map((row) => row[input - 1]) } })),
      groups: [group("Relative gain", each("y", (output) => `y${output}`))],
    },
    {
      caption: "Pairings, the best first",
      columns: pairings.map((pairing) => column(`${pairing.inputs.map((input, output) => `y${output + 1}–u${input}`).join(", ")}${pairing.possible ? "" : " (impossible)"}`, { "": pairing })),
      groups: [
        group("Pairing", [
          ["niederlinski", "Niederlinski index"],
          ...each("relative_gains", (loop) => `Relative gain of y${loop}`),
          ...each("relative_gains_at_crossover", (loop) => `The same near the crossover of y${loop}`),
        ]),
      ],
    },
  ];
}

const predictorTable = ({ robustness, load, setpoint, pid_IAE, why_null }: AnswerOf<"predictor">, { time, y }: UnitNames, IAE: string): StructureTable => ({
  caption: "Figures of the predictor and of the PID",
  columns: [
    column("design", { "": robustness, "load.": load, "setpoint.": setpoint }),
    column(nameOfDesign("pid"), { "load.": { IAE: pid_IAE, why_null: { IAE: why_null?.["pid_IAE"] } } }, "Not computed for the PID."),
  ],
  groups: [
    group("Robustness", [["Ms", "Ms", "", "Ms"], ["Mt", "Mt", "", "Mt"], ["dead_time_up", "Dead time may rise by", time], ["dead_time_down", "Dead time may fall by", time]]),
    group("After a unit load", [["load.IAE", "IAE", IAE, "IAE"], ["load.peak", "Peak of y"], ["load.TV", "TV of u"]]),
    group("After a unit set-point step", [["setpoint.IAE", "IAE", product(y, time), "IAE"], ["setpoint.peak", "Overshoot, share of the step"], ["setpoint.TV", "TV of u"]]),
  ],
});

/** The run of the program. */
function sampledTable({ Ms, responses }: NonNullable<StructureAnswer["sampled"]>, { time, u }: UnitNames, IAE: string): StructureTable {
  const parts = responses.flatMap(({ input, figures, largest_rate }) => [
    [`${input}.`, { largest_rate }] as const,
    ...figures.map((figure, index) => [`${input}.${index}.`, figure] as const),
  ]);
  const ofOutput = (index: number, count: number): string => (count > 1 ? ` of y${index + 1}` : "");
  return {
    caption: "Call by call, with limits",
    columns: [column(nameOfDesign("program"), { "Ms.": Ms, ...Object.fromEntries(parts) })],
    groups: [
      group("Ms without limits", Object.keys(Ms).filter((place) => place !== "why_null").map((place): Row => [`Ms.${place}`, nameOfLoop(place), "", "Ms"])),
      ...responses.map(({ input, figures }) =>
        group(nameOfInput(input), [
          ...figures.flatMap((_, index): Row[] => [
            [`${input}.${index}.IAE`, `IAE${ofOutput(index, figures.length)}`, IAE, "IAE"],
            [`${input}.${index}.peak`, `Peak${ofOutput(index, figures.length)}`],
          ]),
          [`${input}.0.TV`, "TV of u", u],
          [`${input}.largest_rate`, "Largest rate of u", quotient(u, time)],
        ]),
      ),
    ],
  };
}

export function structureTables(answer: StructureAnswer, units: UnitNames): StructureTable[] {
  const run = answer.sampled ? [sampledTable(answer.sampled, units, product(units.y, units.time))] : [];
  return [...tablesOf(answer, units), ...run];
}

function tablesOf(answer: StructureAnswer, units: UnitNames): StructureTable[] {
  const IAE = product(units.y, units.time);
  switch (answer.structure) {
    case "cascade":
      return [cascadeTable(answer, IAE)];
    case "feedforward":
      return [feedforwardTable(answer, units, IAE)];
    case "level":
      return [levelTable(answer, units)];
    case "interaction":
      return interactionTables(answer, units.time);
    case "predictor":
      return [predictorTable(answer, units, IAE)];
  }
}
