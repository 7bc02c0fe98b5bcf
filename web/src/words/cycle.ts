// The figures of a relay test's oscillation, in display order.
import type { LimitCycle, UltimatePoint } from "../api/types.ts";
import { formatNumber, quotient, withUnit } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

export interface CycleRow {
  label: string;
  meaning: string;
  text: string;
}

/** `ultimate`: the plant's own ultimate point, which the describing function only approximates. */
export function cycleRows(cycle: LimitCycle, ultimate: UltimatePoint | null | undefined, units: UnitNames): CycleRow[] {
  const gain = quotient(units.y, units.u);
  const inverse = quotient(units.u, units.y);
  const rows: CycleRow[] = [
    { label: withUnit("Pu", units.time), meaning: "period of the oscillation", text: formatNumber(cycle.Pu, 5) },
    { label: withUnit("Au", gain), meaning: "|G| at that frequency", text: formatNumber(cycle.Au, 4) },
    {
      label: "φu (rad)",
      meaning: `its angle; ${formatNumber((180 / Math.PI) * cycle.phi_u)}°`,
      text: formatNumber(cycle.phi_u, 4),
    },
    { label: "Periods", meaning: "whole steady periods", text: String(cycle.periods) },
  ];
  const add = (label: string, meaning: string, value: number | null | undefined, digits = 4): void => {
    if (typeof value === "number" && Number.isFinite(value))
      rows.push({ label, meaning, text: formatNumber(value, digits) });
  };
  add(withUnit("Ku", inverse), "ultimate gain, of the plant itself", ultimate?.Ku);
  // The same text twice would say nothing.
  if (ultimate && formatNumber(ultimate.Pu, 4) !== formatNumber(cycle.Pu, 4))
    add(withUnit("Pu at Ku", units.time), "ultimate period, of the plant itself", ultimate.Pu);
  add(
    withUnit("Ku, estimated", inverse),
    "4 d/(π a), from the two amplitudes alone (describing function)",
    cycle.describing_function?.Ku,
  );
  if (cycle.shift) {
    add(`A at σ ${formatNumber(cycle.shift.sigma)}`, "|G(σ + j 2π/Pu)|", cycle.shift.A);
    add(`φ at σ ${formatNumber(cycle.shift.sigma)}`, "its angle, rad", cycle.shift.phi);
  }
  add(withUnit("Model − record, rms", units.y), "over the steady periods", cycle.fit_rms, 3);
  return rows;
}
