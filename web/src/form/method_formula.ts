// A method's formula from the service, a table of lines, in a layout that a narrow window can break between equations:
// MathML itself has no line breaks.
import { h, mathElement, node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";
import { parseMathml } from "./formula.ts";

/** The content of a cell, in order: words, and formulas as nodes. */
export type CellPart = string | TreeNode;

export interface FormulaLine {
  label: CellPart[];
  cells: CellPart[][];
}

const inside = (tree: TreeNode): TreeNode[] =>
  (tree.children ?? []).filter((child): child is TreeNode => typeof child !== "string");

/** Words lose the spaces that separate them in a MathML document; the page's layout replaces these. */
const cellParts = (cell: TreeNode): CellPart[] =>
  inside(cell).map((part) =>
    part.tag === "mtext" ? (part.children ?? []).join("").replaceAll("\u00a0", " ").trim() : part,
  );

/** Null if the text is not such a table. */
export function formulaLines(mathml: string | undefined): FormulaLine[] | null {
  const tree = mathml ? parseMathml(mathml) : null;
  const [table, ...others] = tree ? inside(tree) : [];
  if (table?.tag !== "mtable" || others.length > 0) return null;
  return inside(table).map((line) => {
    const [label = [], ...cells] = inside(line).map(cellParts);
    return { label, cells };
  });
}

const shown = (parts: CellPart[]): (HTMLElement | MathMLElement | string)[] =>
  parts.flatMap((part, index) => [
    index > 0 && part !== ":" ? " " : "",
    typeof part === "string"
      ? h("span", { class: "words" }, part)
      : mathElement(node("math", { displaystyle: "true" }, part)),
  ]);

/** Null if there is no MathML: then the text is shown. */
export function methodFormula(mathml: string | undefined): HTMLElement[] | null {
  const lines = formulaLines(mathml);
  if (!lines) return null;
  return lines.map(({ label, cells }) =>
    h(
      "div",
      { class: "formula-line" },
      label.length > 0 ? h("span", { class: "label" }, shown(label)) : null,
      cells.map((cell) => h("span", {}, shown(cell))),
    ),
  );
}
