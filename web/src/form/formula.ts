// Formulas of plants and methods from the service: MathML text is converted to plain nodes, because the page accepts no
// markup from text.
import { formulaText } from "../api/plants.ts";
import type { Plant } from "../api/types.ts";
import { h, mathElement, node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";

const TAGS = new Set("math mrow mi mn mo mtext msub msup msubsup msqrt mfrac mtable mtr mtd".split(" "));
const PIECE = /<(\/?)([a-z]+)((?:\s[^<>]*)?)>|([^<>]+)/y;
const ENTITIES: Record<string, string> = { amp: "&", lt: "<", gt: ">", quot: '"', apos: "'" };

/** Only these attributes are accepted. */
function attributesOf(tag: string, written: string | undefined): Record<string, string> {
  if (tag === "math") return { display: "block" };
  return tag === "mo" && written?.trim() === 'stretchy="false"' ? { stretchy: "false" } : {};
}

/** The tree of a formula; null if the text contains anything other than elements of formulas and their texts. */
export function parseMathml(text: string): TreeNode | null {
  const open: TreeNode[] = [node("formula")];
  PIECE.lastIndex = 0;
  while (PIECE.lastIndex < text.length) {
    const piece = PIECE.exec(text);
    if (!piece) return null;
    const [, slash, tag, attributes, words] = piece;
    const inside = open[open.length - 1]!;
    if (words !== undefined) {
      inside.children!.push(words.replace(/&(\w+);/g, (all, name: string) => ENTITIES[name] ?? all));
    } else if (!TAGS.has(tag!)) {
      return null;
    } else if (slash) {
      if (open.pop()!.tag !== tag) return null;
    } else {
      const element = node(tag!, attributesOf(tag!, attributes));
      inside.children!.push(element);
      open.push(element);
    }
  }
  const [math, ...others] = open[0]!.children!;
  return open.length === 1 && others.length === 0 && typeof math === "object" ? math : null;
}

/** Empty if the text is not a formula. */
export function formulaNodes(mathml: string | undefined): MathMLElement[] {
  const tree = mathml ? parseMathml(mathml) : null;
  return tree ? [mathElement(tree)] : [];
}

const round = (value: unknown): unknown =>
  typeof value === "number" ? Number(value.toPrecision(4)) : Array.isArray(value) ? value.map(round) : value;

/** Identified numbers are known to a few digits only; the formula shows only these. */
export const rounded = (plant: Plant): Plant =>
  Object.fromEntries(Object.entries(plant).map(([name, value]) => [name, round(value)])) as Plant;

/** A container for the formula, which is filled by the service's answer; it stays empty if the plant has none. */
export function plantFormula(plant: Plant, tag: "div" | "span" = "div", small = false): HTMLElement {
  const element = h(tag, { class: small ? "formula small" : "formula" });
  formulaText(plant).then(
    (formula) => element.replaceChildren(...formulaNodes(formula)),
    () => undefined,
  );
  return element;
}
