// The unit of a figure: as the contract states it, in the user's names.
import { UNITS } from "../api/units.gen.ts";
import { quotient } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";

export type MeasuredType = keyof typeof UNITS;

const isName = (text: string): text is keyof UnitNames => text === "time" || text === "u" || text === "y";

/** "°C²" for "y^2"; a unit of several parts is put in brackets; "" if the name is not known. */
function named(part: string, names: UnitNames): string {
  const [base = part, power] = part.split("^");
  if (!isName(base)) return part === "deg" ? "°" : part;
  const name = names[base];
  if (power !== "2" || name === "") return name;
  return /[\s/·*]/.test(name) ? `(${name})²` : `${name}²`;
}

/** A unit of the contract, such as "y time" or "u/y", in the user's names. Unknown names are left out: their quantity
    may have none. */
export function unitIn(unit: string, names: UnitNames): string {
  const [top = "", bottom = ""] = unit.split("/").map((side) =>
    side
      .split(" ")
      .map((part) => named(part, names))
      .filter(Boolean)
      .join(" "),
  );
  return quotient(top, bottom);
}

/** "°C s" for the IAE of a load step; "" if the figure has no unit. */
export const figureUnit = (type: MeasuredType, figure: string, names: UnitNames): string =>
  unitIn((UNITS[type] as Record<string, string>)[figure] ?? "", names);
