// A method's formula as the service writes it, a table of lines, laid out so that a narrow window breaks it between its
// equations: MathML itself has no line breaks.
import { h, mathElement, node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";
import { parseMathml } from "./formula.ts";

/** What stands in a cell, in order: words, and formulas as nodes. */
export type CellPart = string | TreeNode;

export interface FormulaLine {
  label: CellPart[];
  cells: CellPart[][];
}

const inside = (tree: TreeNode): TreeNode[] =>
  (tree.children ?? []).filter((child): child is TreeNode => typeof child !== "string");

/** Words lose the spaces that hold them off in a lone MathML document; here the page's layout does that. */
const cellParts = (cell: TreeNode): CellPart[] =>
  inside(cell).map((part) =>
    part.tag === "mtext" ? (part.children ?? []).join("").replaceAll("\u00a0", " ").trim() : part,
  );

/** Null where the text is no such table. */
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

/** Null where there is no MathML to show: then the text is. */
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
