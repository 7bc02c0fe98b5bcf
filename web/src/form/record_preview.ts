// The preview of a file before anything is computed: its columns with their contents, its times, the skipped lines.
import type { Preview, PreviewColumn } from "../api/types.ts";
import { h, svgElement } from "../dom.ts";
import { extent } from "../plot/axis.ts";
import { spark } from "../plot/spark.ts";
import { formatNumber, formatParameter } from "../words/numbers.ts";

const ROLES: Record<PreviewColumn["guess"], string> = {
  t: "time",
  u: "u, controller output",
  y: "y, measurement",
  r: "set point",
  mode: "mode of the loop",
  "-": "not used",
};

const SEPARATORS: Record<string, string> = { tab: "tabs", blanks: "blanks", ",": "commas", ";": "semicolons", "|": "bars" };

const mebibytes = (bytes: number): string => (bytes / 1024 / 1024).toFixed(1);

/** The reason why a file cannot be sent to a service that accepts bodies of at most `maxBytes`; "" if it can. */
export const tooLarge = ({ name, size }: { name: string; size: number }, maxBytes: number): string =>
  size > maxBytes
    ? `${name} has ${mebibytes(size)} MiB; at most ${mebibytes(maxBytes)} MiB can be sent. Cut the record to the test itself.`
    : "";

/** One sentence: rows, form, encoding, times. */
export function formWords(preview: Preview): string {
  const form =
    preview.separator === "pairs"
      ? "each line names its values"
      : `columns separated by ${SEPARATORS[preview.separator] ?? preview.separator}`;
  const decimal = preview.decimal === "," ? ", decimal comma" : "";
  return `${preview.rows} rows, ${form}${decimal}, ${preview.encoding.toUpperCase()}.`;
}

/** The times as read; "" if there are none yet. */
export function timeWords({ time }: Preview): string {
  if (!time) return "";
  const parts = [`One row every ${formatParameter(time.dt)} ${time.unit}, over ${formatParameter(time.to - time.from)} ${time.unit}`];
  if (time.gaps > 0) parts.push(counted(time.gaps, "gap"));
  if (time.duplicates > 0) parts.push(counted(time.duplicates, "duplicate time stamp"));
  const assumed = time.assumed ? " The file does not say that these are seconds: choose the unit if they are not." : "";
  return `${parts.join(", ")}.${assumed}`;
}

const counted = (count: number, name: string): string => `${count} ${name}${count === 1 ? "" : "s"}`;

export function previewPanel(preview: Preview): HTMLElement {
  const skipped = preview.skipped.map(({ line, reason }) => h("li", {}, `Line ${line}: ${reason}`));
  return h(
    "div",
    { class: "preview" },
    h("p", { class: "hint" }, formWords(preview), " ", timeWords(preview)),
    h(
      "ul",
      { class: "preview-columns" },
      preview.columns.map((column, index) =>
        h(
          "li",
          { class: column.guess === "-" ? "unused" : null },
          h("strong", {}, column.heading || `column ${index + 1}`),
          h("span", { class: "hint" }, ROLES[column.guess]),
          drawn(column),
          h("span", { class: "hint" }, held(column)),
        ),
      ),
    ),
    skipped.length > 0
      ? h("details", {}, h("summary", {}, `${counted(skipped.length, "line")} ignored`), h("ul", {}, skipped))
      : null,
  );
}

const held = ({ first, min, max, unit }: PreviewColumn): string => {
  if (min === undefined || max === undefined) return first;
  const range = min === max ? formatNumber(min) : `${formatNumber(min)} to ${formatNumber(max)}`;
  return unit ? `${range} ${unit}` : range;
};

function drawn({ thumbnail }: PreviewColumn): SVGElement | null {
  if (thumbnail.length < 2) return null;
  const [low, high] = extent([thumbnail], "linear");
  const margin = high > low ? 0 : 1;
  const x = thumbnail.map((_, index) => index);
  return svgElement(
    spark(
      { name: "", look: "data", x, y: thumbnail },
      { x: [0, thumbnail.length - 1], y: [low - margin, high + margin], level: low - margin },
    ),
  );
}
