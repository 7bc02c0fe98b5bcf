// The user's own step in figures and findings.
import type { Entry, Finding, OwnStep, WhyNull } from "../api/types.ts";
import type { ExplainedName } from "./explained.ts";
import { numeric, NOT_GIVEN } from "./figures.ts";
import type { FigureGroup, FigureRow } from "./figures.ts";
import { figureUnit } from "./figure_units.ts";
import type { MeasuredType } from "./figure_units.ts";
import { withUnit } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

type Step = NonNullable<Entry["own_step"]>;
type Named = [label: string, name: string, meaning: string, about: ExplainedName | null];

const NO_PART = "This part of the step is not there.";

/** The groups whose parts the step has; times at the limits that it gives. */
export function ownStepGroups(step: OwnStep, units: UnitNames): FigureGroup[] {
  const row = (
    type: MeasuredType,
    part: (own: Step | undefined) => { why_null?: WhyNull } | undefined,
    ...[label, name, meaning, about]: Named
  ): FigureRow => ({
    label: withUnit(label, figureUnit(type, name, units)),
    meaning,
    about,
    value: ({ own_step }) => numeric(part(own_step), name, own_step?.refused?.text ?? (part(own_step) ? NOT_GIVEN : NO_PART)),
  });
  const setpoint = (...named: Named): FigureRow => row("OwnSetpointFigures", (own) => own?.setpoint, ...named);
  const load = (...named: Named): FigureRow => row("OwnLoadFigures", (own) => own?.load, ...named);
  const whole = (...named: Named): FigureRow => row("OwnStepEntry", (own) => own, ...named);
  const moves = step.target !== (step.y ?? 0);
  return [
    {
      title: "Set point",
      main: true,
      rows: moves
        ? [
            setpoint("IAE", "IAE", "integral of |r − y| up to the load", "IAE"),
            setpoint("Overshoot", "overshoot", "over the new set point", "overshoot_percent"),
            setpoint("Overshoot", "overshoot_percent", "in percent of the step", "overshoot_percent"),
            setpoint("Settling", "settling_time", "last time before the load outside 2 % of the step", "settling_time"),
          ]
        : [],
    },
    {
      title: "Load",
      main: true,
      rows: step.load
        ? [
            load("IAE", "IAE", "integral of |r − y| from the load on", "IAE"),
            load("Peak", "peak", "largest deviation from the set point, with its sign", "peak"),
            load("Recovery", "recovery_time", "last time outside 2 % of the peak", "recovery_time"),
          ]
        : [],
    },
    {
      title: "Controller output",
      main: true,
      rows: [
        whole("Smallest u", "u_min", "of the whole course", null),
        whole("Largest u", "u_max", "of the whole course", null),
        whole("TV of u", "travel", "total movement of the controller's output", "TV"),
        ...(step.u_min === undefined ? [] : [whole("Time at the lower limit", "time_at_min", "of u", null)]),
        ...(step.u_max === undefined ? [] : [whole("Time at the upper limit", "time_at_max", "of u", null)]),
        whole("u needed", "u_needed", "to hold the set point in the end", null),
        whole("y in the end", "y_final", "at rest", null),
      ],
    },
  ].filter(({ rows }) => rows.length > 0);
}

/** The findings about the step in a verdict. */
export const stepFindings = (verdict: readonly Finding[]): Finding[] => verdict.filter(({ code }) => code.startsWith("own-step"));

/** `verdict` with the findings of `about` about another step in place of its own: warnings follow its head, notes end it. */
export function withStepFindings(verdict: readonly Finding[], about: readonly Finding[]): Finding[] {
  const [head, ...kept] = verdict.filter(({ code }) => !code.startsWith("own-step"));
  const said = stepFindings(about);
  const notes = said.filter(({ level }) => level === "note");
  return [...(head ? [head] : []), ...said.filter(({ level }) => level !== "note"), ...kept, ...notes];
}
