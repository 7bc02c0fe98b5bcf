// How a figure stands beside an axis.

const MINUS = "−";

/** A tick's text: no dust, true minus, powers of ten where plain digits would be long. */
export function tickText(value: number): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text =
    size >= 1e5 || size < 1e-3 ? value.toExponential().replace("e+", "e") : String(Number(value.toPrecision(10)));
  return text.replaceAll("-", MINUS);
}
