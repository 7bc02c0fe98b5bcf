// A plot as a file: SVG without classes, styles and variables, PNG drawn from it, CSV of its data.
import { node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";
import type { Frame } from "./frame.ts";
import { layoutFrame } from "./layout.ts";
import type { View } from "./layout.ts";
import { drawLayout, lineOf } from "./marks.ts";

/** The colour of a token, e.g. of "--series-1". */
export type Palette = (token: string) => string;

const FONTS = "system-ui, Segoe UI, DejaVu Sans, sans-serif";
const HEADER = 44;

const escapeText = (text: string): string =>
  text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
const escapeValue = (text: string): string => escapeText(text).replaceAll('"', "&quot;");

/** Markup of a node, with colours in place of their tokens. */
export function toMarkup(tree: TreeNode, palette: Palette): string {
  const attributes = Object.entries(tree.attributes ?? {})
    .map(
      ([name, value]) =>
        ` ${name}="${escapeValue(String(value).replace(/var\((--[\w-]+)\)/g, (_, token: string) => palette(token)))}"`,
    )
    .join("");
  const children = (tree.children ?? [])
    .map((child) => (typeof child === "string" ? escapeText(child) : toMarkup(child, palette)))
    .join("");
  return children === "" ? `<${tree.tag}${attributes}/>` : `<${tree.tag}${attributes}>${children}</${tree.tag}>`;
}

function legend(frame: Frame, width: number): TreeNode[] {
  const seen = new Map(frame.panes.flatMap((pane) => pane.traces.filter(({ quiet }) => !quiet).map((trace) => [trace.name, trace] as const)));
  let x = 14;
  const nodes: TreeNode[] = [];
  for (const [name, { look, thin }] of seen) {
    const length = 36 + name.length * 6.6;
    if (x + length > width) break;
    nodes.push(node("path", { d: `M${x} 34H${x + 26}`, fill: "none", ...lineOf(look, thin) }));
    nodes.push(node("text", { x: x + 32, y: 38, fill: "var(--text)", "font-size": 12 }, name));
    x += length + 18;
  }
  return nodes;
}

/** "TIC-101: Set-point step". */
const fullTitle = ({ subject, title }: Frame): string => (subject ? `${subject}: ${title}` : title);

/** The longest name of a subject in the name of a file. */
const LONGEST_NAME = 40;

/** "TIC-101-set-point-step", for a file: only characters that every system takes. */
export function fileNameOf({ subject = "", fileName }: Pick<Frame, "subject" | "fileName">): string {
  const name = subject
    .replace(/[^\p{L}\p{N}_.-]+/gu, "-")
    .replace(/^[-.]+|[-.]+$/g, "")
    .slice(0, LONGEST_NAME);
  return name ? `${name}-${fileName}` : fileName;
}

/** A complete SVG document of the plot with its zoom, title, description, legend and background. */
export function frameToSvg(frame: Frame, view: View, width: number, height: number, palette: Palette): string {
  const layout = layoutFrame(frame, width, height, view);
  const document = node(
    "svg",
    {
      xmlns: "http://www.w3.org/2000/svg",
      width,
      height: height + HEADER,
      viewBox: `0 0 ${width} ${height + HEADER}`,
      "font-family": FONTS,
      role: "img",
    },
    node("title", {}, fullTitle(frame)),
    node("desc", {}, frame.description),
    node("rect", { width, height: height + HEADER, fill: "var(--surface)" }),
    node("text", { x: 14, y: 18, fill: "var(--text)", "font-size": 14, "font-weight": 600 }, fullTitle(frame)),
    ...legend(frame, width),
    node("g", { transform: `translate(0 ${HEADER})` }, ...drawLayout(frame, layout, "pane")),
  );
  return toMarkup(document, palette);
}

/** The points of a pane without traces, as rows of the table. */
const pointRows = (pane: Frame["panes"][number]): (string | number | null)[][] =>
  (pane.marks ?? []).flatMap((mark) => (mark.kind === "point" ? [[mark.label, pane.y.label, mark.x, mark.y]] : []));

/** One table of all traces: x (and the parameter), then y; the first columns identify the trace of a row. */
export function frameToRows(frame: Frame): { header: string[]; rows: (string | number | null)[][] } {
  const parametric = frame.panes.some((pane) => pane.traces.some((trace) => trace.parameter));
  const header = ["trace", "axis", ...(parametric ? [frame.cursorLabel] : []), frame.x.label, "value"];
  const rows = frame.panes.flatMap((pane) =>
    pane.traces.length === 0 ? pointRows(pane) : pane.traces.flatMap((trace) =>
      trace.x.map((x, index) => [
        trace.name,
        pane.y.label,
        ...(parametric ? [trace.parameter?.[index] ?? null] : []),
        x,
        trace.y[index] ?? null,
      ]),
    ),
  );
  return { header, rows };
}

export function frameToCsv(frame: Frame): string {
  const { header, rows } = frameToRows(frame);
  return csvText([header, ...rows]);
}

export function csvText(rows: (string | number | null)[][]): string {
  const quote = (cell: string | number | null): string => {
    const text = cell === null ? "" : String(cell);
    return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return rows.map((row) => row.map(quote).join(",")).join("\r\n") + "\r\n";
}

/** Lets the browser save a file. */
export function download(blob: Blob, fileName: string): void {
  const address = URL.createObjectURL(blob);
  const anchor = document.createElement("a");
  anchor.href = address;
  anchor.download = fileName;
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** The SVG document as a PNG at twice its size. */
export async function svgToPng(svg: string, width: number, height: number): Promise<Blob> {
  const address = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
  try {
    const image = new Image();
    image.src = address;
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = 2 * width;
    canvas.height = 2 * height;
    canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
    return await new Promise((resolve, reject) => {
      canvas.toBlob(
        (blob) => (blob ? resolve(blob) : reject(new Error("The browser could not make a PNG of this plot."))),
        "image/png",
      );
    });
  } finally {
    URL.revokeObjectURL(address);
  }
}

export const exportHeight = (height: number): number => height + HEADER;

/** The light colours, whatever the page shows: exports are for paper. */
export function lightPalette(): Palette {
  const colours = getComputedStyle(document.documentElement);
  const read = new Map<string, string>();
  for (const token of [
    "surface",
    "text",
    "muted",
    "control",
    "grid",
    "bad",
    "setpoint",
    "limit",
    "series-1",
    "series-2",
    "series-3",
    "series-4",
  ]) {
    // A token has the form "light-dark(#2363c5, #5b95f5)".
    const first = /#[0-9a-f]{3,6}/i.exec(colours.getPropertyValue(`--${token}`));
    if (first) read.set(`--${token}`, first[0]);
  }
  return (token) => read.get(token) ?? "#000000";
}
