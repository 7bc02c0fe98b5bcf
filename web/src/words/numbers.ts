// Numbers and units for display: three digits, a true minus, a dash for a missing value.

export const DASH = "–";
const MINUS = "−";

/** As figure_text() of the service: `digits` significant digits; powers of ten outside 0.001 to 99999. Trailing zeros
    stay: they show the accuracy of the figure. */
export function formatNumber(value: number | null | undefined, digits = 3): string {
  if (typeof value !== "number" || !Number.isFinite(value)) return DASH;
  if (value === 0) return "0";
  const fixed = value.toPrecision(digits);
  const size = Math.abs(Number(fixed));
  if (size < 1e-3 || size >= 1e5) {
    const [mantissa = "", exponent = ""] = value.toExponential(digits - 1).split("e");
    return `${mantissa}e${exponent.replace("+", "")}`.replaceAll("-", MINUS);
  }
  return (fixed.includes("e") ? String(Number(fixed)) : fixed).replaceAll("-", MINUS);
}

/** A smaller share is rounding. */
const NO_PERCENT = 0.005;

export const formatPercent = (value: number): string => formatNumber(Math.abs(value) < NO_PERCENT ? 0 : value);

/** A fraction as percent: never 100 for less than all, never 0 for more than none. */
export const formatShare = (fraction: number): string =>
  String(fraction > 0 ? Math.max(0.1, Math.floor(1000 * fraction + 1e-9) / 10) : 0);

/** A sentence of the service, whose hyphens become minus signs. */
export const withMinus = (sentence: string): string => sentence.replace(/(^|[\s(])-(?=\d)/g, `$1${MINUS}`);

/** A parameter in running text: four digits at most, no trailing zeros. */
export function formatParameter(value: number): string {
  const short = Number(value.toPrecision(4));
  const size = Math.abs(short);
  return short !== 0 && (size < 1e-3 || size >= 1e5) ? formatNumber(short, 4) : String(short).replaceAll("-", MINUS);
}

/** A number for a field or an address, as typed: without rounding errors in the 16th digit. */
export const exactText = (value: number): string => String(Number(value.toPrecision(15)));

/** An error below this share of the value is not shown. */
const NEGLIGIBLE = 1e-6;

const isNegligible = (error: number, value: number): boolean => !(error > NEGLIGIBLE * Math.abs(value));

/** A standard error by itself: "exact" if no digit of the value shows it. */
export const formatError = (error: number | null | undefined, value: number): string =>
  isUndetermined(error, value) ? "not determined" :
  typeof error === "number" && isNegligible(error, value) ? "exact" : formatNumber(error, 2);

/** An error beyond the value: the record does not say what the value is. */
export const isUndetermined = (error: number | null | undefined, value: number): boolean =>
  typeof error === "number" && value !== 0 && error > Math.abs(value);

/** "2.00003 ± 0.00048": the error with two digits, the value with as many decimals. */
export function formatUncertain(value: number, error: number | null | undefined): string {
  if (typeof error !== "number" || !Number.isFinite(error) || isNegligible(error, value))
    return formatParameter(value);
  const decimals = 1 - Math.floor(Math.log10(error));
  const size = Math.max(Math.abs(value), error);
  if (decimals < 0 || decimals > 7 || size < 1e-3 || size >= 1e5)
    return `${formatParameter(value)} ± ${formatNumber(error, 2)}`;
  return `${value.toFixed(decimals)} ± ${error.toFixed(decimals)}`.replaceAll("-", MINUS);
}

/** A figure to enter into a controller: five digits at most, no trailing zeros. */
export function formatSetting(value: number | null | undefined): string {
  if (typeof value !== "number" || !Number.isFinite(value)) return DASH;
  return String(Number(value.toPrecision(5))).replaceAll("-", MINUS);
}

/** For machines and clipboards: ASCII minus. */
export const plainSetting = (value: number): string => String(Number(value.toPrecision(5)));

export interface UnitNames {
  time: string;
  u: string;
  y: string;
}

export function unitNames(units: { time?: string; u?: string; y?: string } | undefined): UnitNames {
  return { time: units?.time || "s", u: pretty(units?.u ?? ""), y: pretty(units?.y ?? "") };
}

/** degC and degF in their printed form. */
function pretty(unit: string): string {
  return unit.replace(/^deg([CF])$/, "°$1");
}

/** A unit of the contract in the user's names: "time" and "u/y"; "" where a needed name is unknown. */
export function namedUnit(unit: string, units: UnitNames): string {
  const names: Record<string, string> = { time: units.time, u: units.u, y: units.y };
  const parts = unit.split(/([/ ])/);
  return parts.some((part) => part in names && names[part] === "")
    ? ""
    : parts.map((part) => names[part] ?? part).join("");
}

/** "Ti (s)"; the name alone if there is no unit. */
export const withUnit = (name: string, unit: string): string => (unit ? `${name} (${unit})` : name);

/** "%/°C"; empty unless at least one is known. */
export function quotient(top: string, bottom: string): string {
  if (!top && !bottom) return "";
  if (top === bottom) return "";
  return `${top || "1"}${bottom ? `/${bottom}` : ""}`;
}

export function product(a: string, b: string): string {
  return [a, b].filter(Boolean).join(" ");
}

const DURATIONS = [
  ["day", 86_400],
  ["hour", 3600],
  ["minute", 60],
  ["second", 1],
] as const;

/** "7 days", "36 hours": in the largest unit of which it is a whole number. */
export function durationWords(seconds: number): string {
  const [name, size] = DURATIONS.find(([, length]) => seconds >= length && seconds % length === 0) ?? DURATIONS[3];
  const count = Math.round(seconds / size);
  return `${count} ${name}${count === 1 ? "" : "s"}`;
}
