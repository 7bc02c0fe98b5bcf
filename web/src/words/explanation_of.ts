// The explanation of a slider, a setting or a parameter of a product: their names differ from those of the figures.
import type { ProductParameter } from "../api/types.ts";
import type { ExplainedName } from "./explained.ts";

/** By the slider's option, or by the setting's name in a textbook form. */
const SETTINGS: Readonly<Record<string, ExplainedName>> = {
  Ms: "Ms",
  Mt: "Mt",
  Mks: "Mks",
  "filter.Tf": "Tf",
  "filter.Tf_over_Td": "Tf_over_Td",
  "setpoint.weight": "b",
  "setpoint.overshoot": "overshoot_percent",
  lambda: "closed_loop_time",
  tau_c: "closed_loop_time",
  gain_margin: "gain_margin",
  phase_margin_deg: "phase_margin_deg",
  degradation: "degradation",
  Kp: "Kp",
  Ti: "Ti",
  Td: "Td",
  Ki: "Ki",
  Kd: "Kd",
  Tf: "Tf",
  b: "b",
  delta_r: "delta_r",
  "Set-point filter": "setpoint_filter",
};

const ROLES: Readonly<Record<string, ExplainedName>> = {
  gain: "Kp",
  integral: "Ti",
  derivative: "Td",
  filter: "Tf",
  weight_b: "b",
  weight_c: "c",
  sample_time: "longest_sample_time",
};

/** Undefined: it has none. */
export const explanationOf = (name: string): ExplainedName | undefined => SETTINGS[name];

/** By what the parameter does in the product's law, whatever the maker calls it. */
export const explanationOfParameter = ({ role }: Pick<ProductParameter, "role">): ExplainedName | undefined => ROLES[role];
