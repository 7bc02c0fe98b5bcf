// The proposed relay test in sentences.
import type { RelayPlan } from "../api/types.ts";
import { formatNumber, formatParameter } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

const given = (value: unknown): value is number => typeof value === "number" && Number.isFinite(value);

export function planSentences(plan: RelayPlan, units: UnitNames): string[] {
  const u = units.u ? ` ${units.u}` : "";
  const y = units.y ? ` ${units.y}` : "";
  const sentences: string[] = [];
  if (given(plan.u_plus) && given(plan.u_minus)) {
    const dead = given(plan.hysteresis)
      ? plan.hysteresis > 0
        ? `, switching when y leaves ±${formatNumber(plan.hysteresis)}${y}`
        : ", without hysteresis"
      : "";
    sentences.push(
      `Let the relay move u between ${signed(plan.u_plus)} and ${signed(plan.u_minus)}${u} around its operating point${dead}.`,
    );
  }
  if (given(plan.amplitude) && given(plan.expected_period))
    sentences.push(
      `Expect y to swing by ±${formatNumber(plan.amplitude)}${y} with a period of ${formatNumber(plan.expected_period)} ${units.time}.`,
    );
  if (given(plan.cycles) && given(plan.duration))
    sentences.push(`${plan.cycles} cycles take about ${formatNumber(plan.duration)} ${units.time}.`);
  if (given(plan.record_interval))
    sentences.push(`Record a sample every ${formatNumber(plan.record_interval)} ${units.time} or more often.`);
  return sentences;
}

const signed = (value: number): string => (value > 0 ? `+${formatParameter(value)}` : formatParameter(value));
