// The five structures: the fields of each question, its sliders, and examples. A field's key is its path in the request.
import type { StructureId, StructureRequest } from "../api/structure.ts";
import { nameOfInput } from "../words/structure.ts";

/** Typed texts by the keys of their fields. */
export type Texts = Record<string, string>;

type Choices = readonly (readonly [value: string, text: string])[];

export interface FieldSpec {
  key: string;
  kind: "plant" | "controller" | "number" | "numbers" | "fraction" | "choice" | "text";
  label: string;
  /** In the contract's words, such as "u time/y". */
  unit?: string;
  hint?: string;
  placeholder?: string;
  /** The values "given" and "design" are not part of a request. */
  choices?: Choices;
  /** The choice "given" belongs to a request in which this is an object or a list. */
  givenAt?: string;
  /** An empty text leaves it out. */
  optional?: boolean;
  /** It is moved by a slider. `low` and `high`: the meaning of its ends; `relative`: they are factors of its first value. */
  slider?: { from: number; to: number; log?: boolean; step?: number; low: string; high: string; relative?: boolean };
  /** Part of the request only then. */
  active?: (texts: Texts) => boolean;
  /** The controller's parameters, if they are not those of a PID. */
  parameters?: readonly string[];
}

/** A block of the diagram by its name there, and the fields that stand in it. */
export interface BlockSpec {
  id: string;
  title: string;
  fields: string[];
}

export interface StructureSpec {
  title: string;
  /** What it is for, in one sentence. */
  purpose: string;
  /** Its section in the document on structures. */
  section: string;
  fields(texts: Texts): FieldSpec[];
  blocks(texts: Texts): BlockSpec[];
  /** Members that are always sent. */
  fixed: StructureRequest;
  examples: Record<string, StructureRequest>;
}

type More = Partial<FieldSpec>;
const DESIGNS: Choices = [["PI", "design a PI"], ["PID", "design a PID"], ["given", "given settings"]];
const MS_SLIDER = { from: 1.1, to: 2, step: 0.01, low: "calm", high: "fast" };
const AROUND = { from: 0.25, to: 4, log: true, step: 0.02, relative: true };

const isGiven = (key: string) => ({ active: (texts: Texts): boolean => texts[key] === "given" });
const isDesigned = (key: string) => ({ active: (texts: Texts): boolean => texts[key] !== "given" });
const choice = (key: string, label: string, choices: Choices, givenAt?: string): FieldSpec => ({ key, kind: "choice", label, choices, ...(givenAt ? { givenAt } : {}) });
const number = (key: string, label: string, more: More = {}): FieldSpec => ({ key, kind: "number", label, ...more });
const plant = (key: string, label: string, more: More = {}): FieldSpec => ({ key, kind: "plant", label, ...more });
const settings = (key: string, label: string, by: string, more: More = {}): FieldSpec => ({ key, kind: "controller", label, placeholder: "Kp 0.65, Ti 2.8", ...isGiven(by), ...more });
const today = (key: string, label: string): FieldSpec => ({ key, kind: "controller", label, placeholder: "Kp 0.5, Ti 10", optional: true });
const ms = (key: string, label: string, more: More = {}): FieldSpec => number(key, label, { optional: true, slider: MS_SLIDER, ...more });

const mt = (key: string, words: string, by: string): FieldSpec => number(key, words, { optional: true, placeholder: "default", ...isDesigned(by) });

const cascadeFields = (): FieldSpec[] => [
  ...(["outer", "inner"] as const).flatMap((loop) => [
    choice(`${loop}.tune.controller`, `${loop === "inner" ? "Inner" : "Outer"} controller`, DESIGNS, `${loop}.controller`),
    settings(`${loop}.controller`, `Settings of the ${loop} controller`, `${loop}.tune.controller`),
  ]),
  plant("inner.plant", "Inner plant, from the valve to y2"),
  plant("outer.plant", "Outer plant, to y1"),
  choice("arrangement", "Arrangement", [["series", "series: y2 drives y1"], ["parallel", "parallel: the valve drives both"]]),
  choice("search", "Search", [["sequential", "inner loop first"], ["joint", "both loops at once"]]),
  ms("inner.tune.Ms", "Ms, inner loop", isDesigned("inner.tune.controller")),
  ms("outer.tune.Ms", "Ms, outer loop", isDesigned("outer.tune.controller")),
  ms("limits.Ms_valve", "Ms at the valve", { slider: { ...MS_SLIDER, to: 2.5 } }),
  mt("inner.tune.Mt", "Mt, inner loop", "inner.tune.controller"),
  mt("outer.tune.Mt", "Mt, outer loop", "outer.tune.controller"),
  today("baseline.inner", "Inner controller today"),
  today("baseline.outer", "Outer controller today"),
];

const feedforwardFields = (): FieldSpec[] => [
  choice("feedback.tune.controller", "Feedback controller", DESIGNS, "feedback"),
  settings("feedback", "Settings of the feedback", "feedback.tune.controller"),
  choice("feedforward.by", "Compensator", [["design", "least IAE"], ["given", "given settings"]], "controller"),
  settings("controller", "Settings of the compensator", "feedforward.by", { parameters: ["Kf", "Tz", "Tp", "Lf"], placeholder: "Kf 0.6, Tz 60, Tp 6" }),
  plant("plant", "Plant, from u to y"),
  plant("disturbance", "Disturbance, from d to y"),
  ms("feedback.tune.Ms", "Ms of the feedback loop", isDesigned("feedback.tune.controller")),
  mt("feedback.tune.Mt", "Mt of the feedback loop", "feedback.tune.controller"),
  number("feedforward.jump", "First move of u", {
    unit: "u",
    hint: "after a unit step of d",
    placeholder: "no limit",
    optional: true,
    slider: { ...AROUND, low: "gentle", high: "sharp" },
    ...isDesigned("feedforward.by"),
  }),
  number("uncertainty", "The model may be wrong by", { hint: "share of a gain or a dead time", optional: true, slider: { from: 0, to: 0.5, step: 0.01, low: "exact", high: "half" } }),
];

const AIMS: Choices = [["rate", "slowest outflow"], ["no_outflow_overshoot", "no overshoot: P only"], ["zeta", "damping of my own"], ["given", "given settings"]];

const levelFields = (): FieldSpec[] => [
  choice("aim", "Level controller", AIMS, "controller"),
  settings("controller", "Settings of the level controller", "aim", { parameters: ["Kc", "Ti"], placeholder: "Kc 1.1, Ti 7.2" }),
  number("flow_loop.T", "Lag T", { unit: "time", optional: true, placeholder: "0" }),
  number("flow_loop.L", "Dead time L", { unit: "time", optional: true, placeholder: "0" }),
  number("volume", "Volume per unit of level", { unit: "u time/y" }),
  number("largest_step", "Largest step of the inflow", { unit: "u", slider: { ...AROUND, low: "small", high: "large" } }),
  number("allowed", "Allowed deviation of the level", { unit: "y", slider: { ...AROUND, low: "tight", high: "smooth" } }),
  number("zeta", "Damping zeta", { slider: { from: 0.3, to: 2, step: 0.01, low: "slow outflow", high: "little overshoot" }, active: ({ aim }) => aim === "zeta" }),
  number("gap", "Gap", { unit: "y", hint: "within it u rests", optional: true, placeholder: "0", active: ({ aim }) => aim === "no_outflow_overshoot" }),
];

export const loopsOf = (texts: Texts): number[] => (texts["size"] === "3" ? [0, 1, 2] : [0, 1]);

const PAIRINGS = { 2: ["1 2", "2 1"], 3: ["1 2 3", "1 3 2", "2 1 3", "2 3 1", "3 1 2", "3 2 1"] } as const;

function interactionFields(texts: Texts): FieldSpec[] {
  const loops = loopsOf(texts);
  const pairWords = (inputs: string): string => inputs.split(" ").map((input, output) => `y${output + 1} by u${input}`).join(", ");
  return [
    choice("size", "Loops", [["2", "2"], ["3", "3"]]),
    choice("pairing", "Pairing", [["", "the best"], ...PAIRINGS[loops.length as 2 | 3].map((inputs) => [inputs, pairWords(inputs)] as const)]),
    choice("controllers", "Controllers", DESIGNS, "controllers"),
    choice("decoupler", "Decoupler", [["none", "none"], ["static", "static: gains"], ["simplified", "simplified: lead, lag, delay"]]),
    ...loops.map((loop) => settings(`controllers.${loop}`, `Settings of controller ${loop + 1}`, "controllers")),
    ...loops.flatMap((y) => loops.map((u) => plant(`plant.${y}.${u}`, `y${y + 1} from u${u + 1}`))),
    number("limit.mu", "Peak mu of all loops", { optional: true, slider: { ...MS_SLIDER, from: 1.2, to: 2.5 } }),
    { key: "weights.y", kind: "numbers", label: "Weights of the outputs", hint: "one over the range of each, such as 0.01 0.2", optional: true, placeholder: loops.map(() => "1").join(" ") },
    ...loops.map((loop) => today(`baseline.${loop}`, `Controller ${loop + 1} today`)),
  ];
}

const KINDS: Choices = [["smith", "Smith predictor"], ["filtered_smith", "filtered Smith predictor"], ["predictive_pi", "predictive PI"], ["given", "given C and F"]];

const predictorFields = (): FieldSpec[] => [
  choice("kind", "Predictor", KINDS, "controller"),
  { key: "controller.C", kind: "fraction", label: "C: coefficients of s", placeholder: "40.2 1 / 349 0", ...isGiven("kind") },
  { key: "controller.F", kind: "fraction", label: "F: coefficients of s", placeholder: "1 / 20 1", ...isGiven("kind") },
  plant("plant", "Plant, from u to y"),
  plant("model", "Model in the controller", { optional: true, placeholder: "the plant" }),
  ms("Ms", "Ms", isDesigned("kind")),
  number("dead_time_error", "Dead time may be wrong by", {
    hint: "share of the dead time",
    placeholder: "not set",
    optional: true,
    slider: { from: 0, to: 0.9, step: 0.01, low: "known", high: "varies" },
    ...isDesigned("kind"),
  }),
];

const WOOD_BERRY = [
  ["12.8 e^(-s)/(16.7s+1)", "-18.9 e^(-3s)/(21s+1)"],
  ["6.6 e^(-7s)/(10.9s+1)", "-19.4 e^(-3s)/(14.4s+1)"],
];
const VINANTE_LUYBEN = [
  ["-2.2 e^(-s)/(7s+1)", "1.3 e^(-0.3s)/(7s+1)"],
  ["-2.8 e^(-1.8s)/(9.5s+1)", "4.3 e^(-0.35s)/(9.2s+1)"],
];
const OGUNNAIKE_RAY = [
  ["0.66 e^(-2.6s)/(6.7s+1)", "-0.61 e^(-3.5s)/(8.64s+1)", "-0.0049 e^(-s)/(9.06s+1)"],
  ["1.11 e^(-6.5s)/(3.25s+1)", "-2.36 e^(-3s)/(5s+1)", "-0.01 e^(-1.2s)/(7.09s+1)"],
  ["-34.68 e^(-9.2s)/(8.15s+1)", "46.2 e^(-9.4s)/(10.9s+1)", "0.87 (11.61s+1) e^(-s)/((3.89s+1)(18.8s+1))"],
];
const SECONDS = { units: { time: "s" } };
const column = (matrix: string[][], more: StructureRequest): StructureRequest => ({ units: { time: "min" }, plant: matrix, controllers: "PI", limit: { mu: 1.8 }, ...more });

export const STRUCTURE_SPECS: Record<StructureId, StructureSpec> = {
  cascade: {
    title: "Cascade",
    purpose: "An inner loop, such as a flow, takes up loads before the outer loop feels them.",
    section: "a-cascade",
    fields: cascadeFields,
    blocks: () => [
      { id: "C1", title: "C1, outer", fields: ["outer.tune.controller", "outer.controller"] },
      { id: "C2", title: "C2, inner", fields: ["inner.tune.controller", "inner.controller"] },
      { id: "P2", title: "P2, inner plant", fields: ["inner.plant"] },
      { id: "P1", title: "P1, outer plant", fields: ["outer.plant"] },
    ],
    fixed: {},
    examples: {
      "Furnace with fuel flow": {
        name: "Furnace outlet over fuel flow",
        ...SECONDS,
        inner: { plant: "2 e^(-s)/(4s+1)", tune: { controller: "PI" } },
        outer: { plant: "1.5 e^(-8s)/(30s+1)", tune: { controller: "PID" } },
        limits: { Ms_valve: 1.6 },
      },
    },
  },
  feedforward: {
    title: "Feedforward",
    purpose: "A measured disturbance moves the valve before the measurement does.",
    section: "feedforward",
    fields: feedforwardFields,
    blocks: () => [
      { id: "F", title: "F, compensator", fields: ["feedforward.by", "controller"] },
      { id: "Pd", title: "Pd, disturbance", fields: ["disturbance"] },
      { id: "C", title: "C, feedback", fields: ["feedback.tune.controller", "feedback"] },
      { id: "P", title: "P, plant", fields: ["plant"] },
    ],
    fixed: {},
    examples: {
      "Heat exchanger with feed flow": {
        name: "Heat exchanger, feed flow measured",
        ...SECONDS,
        plant: "1.5 e^(-15s)/(60s+1)",
        disturbance: "1/(15s+1)",
        feedback: { tune: { controller: "PI" } },
        feedforward: { jump: 12 },
        uncertainty: 0.2,
      },
    },
  },
  level: {
    title: "Level",
    purpose: "A vessel takes up steps of its inflow, and its outflow moves slowly.",
    section: "a-level-that-smooths-flows",
    fields: levelFields,
    blocks: () => [
      { id: "C", title: "Level controller", fields: ["aim", "controller"] },
      { id: "Q", title: "Flow loop", fields: ["flow_loop.T", "flow_loop.L"] },
      { id: "V", title: "Vessel", fields: ["volume"] },
    ],
    fixed: {},
    examples: {
      "Boiler feed water tank": { name: "Feed water tank", units: { time: "min", u: "m³/min", y: "m" }, volume: 12, largest_step: 4, allowed: 1.8, flow_loop: { T: 0.4, L: 0.05 } },
    },
  },
  interaction: {
    title: "Interaction",
    purpose: "Two or three loops that disturb each other are designed together. Write 0 for a path that is not there.",
    section: "interacting-loops",
    fields: interactionFields,
    blocks: (texts) => [
      ...loopsOf(texts).map((loop) => ({ id: `C${loop + 1}`, title: `C${loop + 1}, of y${loop + 1}`, fields: [`controllers.${loop}`] })),
      { id: "matrix", title: "Plants", fields: loopsOf(texts).flatMap((y) => loopsOf(texts).map((u) => `plant.${y}.${u}`)) },
    ],
    fixed: { compare: ["blt"] },
    examples: {
      "Wood and Berry's column": column(WOOD_BERRY, { name: "Methanol column of Wood and Berry" }),
      "Vinante and Luyben's column": column(VINANTE_LUYBEN, { name: "Column of Vinante and Luyben" }),
      "Ogunnaike and Ray's column, 3 loops": column(OGUNNAIKE_RAY, { name: "Column of Ogunnaike and Ray", weights: { y: [1, 1, 0.02] } }),
    },
  },
  predictor: {
    title: "Predictor",
    purpose: "A model predicts past a long dead time; a PID with the same Ms stands next to it.",
    section: "predictors",
    fields: predictorFields,
    blocks: () => [
      { id: "C", title: "C", fields: ["kind", "controller.C"] },
      { id: "P", title: "P, plant", fields: ["plant"] },
      { id: "M", title: "Model", fields: ["model"] },
      { id: "F", title: "F, filter", fields: ["controller.F"] },
    ],
    fixed: {},
    examples: { "Long pipe": { name: "Long pipe", ...SECONDS, plant: "5.6 e^(-93.9s)/(40.2s+1)", kind: "smith", Ms: 1.6, dead_time_error: 0.25 } },
  },
};

export const firstExample = (id: StructureId): StructureRequest => Object.values(STRUCTURE_SPECS[id].examples)[0]!;

const label = (key: string, words: string, placeholder: string): FieldSpec => ({ key, kind: "text", label: words, optional: true, placeholder });

/** Name and units, of every structure. */
export const LABEL_FIELDS: readonly FieldSpec[] = [label("name", "Name", "TIC-101"), label("units.time", "Time in", "s"), label("units.u", "u in", "%"), label("units.y", "y in", "degC")];

const INPUTS: Record<StructureId, (texts: Texts) => string[]> = {
  cascade: () => ["setpoint", "outer_load", "inner_load"],
  feedforward: () => ["disturbance"],
  level: () => ["inflow"],
  interaction: (texts) => loopsOf(texts).flatMap((loop) => [`setpoint_${loop + 1}`, `load_${loop + 1}`]),
  predictor: () => ["setpoint", "load"],
};

/** The beginning of the keys of a run of the program, call by call. */
export const SAMPLED = "sampled.";

/** A run of the program with its limits: without a sample time there is none. */
function sampledFields(id: StructureId, texts: Texts): FieldSpec[] {
  const part = (name: string, words: string, unit: string): FieldSpec =>
    number(SAMPLED + name, words, { unit, optional: true, placeholder: "no limit", active: (all) => Boolean(all["sampled.sample_time"]?.trim()) });
  return [
    number("sampled.sample_time", "Sample time", { unit: "time", hint: "empty: no run", optional: true }),
    part("u_min", "Least u", "u"),
    part("u_max", "Largest u", "u"),
    part("rate_limit", "Largest rate of u", "u/time"),
    ...(id === "cascade" ? [part("r2_min", "Least r2", ""), part("r2_max", "Largest r2", "")] : []),
    ...INPUTS[id](texts).map((input) => ({ ...part(`steps.${input}`, `Size: ${nameOfInput(input).toLowerCase()}`, ""), placeholder: id === "level" ? "the largest" : "1" })),
  ];
}

export const fieldsOf = (id: StructureId, texts: Texts): FieldSpec[] => [...STRUCTURE_SPECS[id].fields(texts), ...sampledFields(id, texts), ...LABEL_FIELDS];

export const isActive = ({ active }: FieldSpec, texts: Texts): boolean => active?.(texts) ?? true;
