// Today's settings that the service finds in a record, in words.
import type { ControllerInRecord, IdentifiedController, Product } from "../api/types.ts";
import { formatNumber, formatUncertain } from "./numbers.ts";
import { typedRows } from "./products.ts";

/** "GAIN 0.80 ± 0.02, RESET 150 ± 2 s": in the product's own names; null if they cannot be typed into it. */
function typedWords({ typing }: ControllerInRecord, product: Product | null): string | null {
  const errors = typing?.standard_errors;
  if (!product || !typing || !errors) return null;
  const written = typedRows(product, typing).flatMap(({ name, label, value, unit }) =>
    name in errors ? [`${label} ${value} ± ${formatNumber(errors[name], 2)}${unit ? ` ${unit}` : ""}`] : [],
  );
  return written.length > 0 ? written.join(", ") : null;
}

/** "Kp 0.800 ± 0.010, Ti 150.0 ± 2.0 s": in the ideal form. A part that is zero within its error is left out. */
function idealWords({ controller, standard_errors }: IdentifiedController, time: string): string {
  const written = (["Kp", "Ti", "Td"] as const).flatMap((name) => {
    const value = (controller as Partial<Record<string, unknown>>)[name];
    if (typeof value !== "number" || Math.abs(value) <= 2 * (standard_errors[name] ?? 0)) return [];
    const unit = name !== "Kp" && time ? ` ${time}` : "";
    return [`${name} ${formatUncertain(value, standard_errors[name])}${unit}`];
  });
  return written.join(", ");
}

/** The settings with their standard errors, and remarks about them. `product`: the one that was asked for. */
export function foundWords(
  found: ControllerInRecord & { identified: IdentifiedController },
  product: Product | null,
  time: string,
): string {
  const { identified, not_typed } = found;
  const settings = typedWords(found, product) ?? idealWords(identified, time);
  const remarks = [...identified.warnings.map(({ detail }) => detail), ...(not_typed ? [not_typed] : [])];
  return [`From the record: ${settings}.`, ...remarks].join(" ");
}
