// Conversion of a product's law from the service's text to MathML: "out = K [ 1 + 1/(Ti s) ] (SP - PV), K = 100/PB". A
// product of symbols has precedence over the slash: Td s/(Tf s + 1) is Td s over Tf s + 1.
import { node } from "../dom.ts";
import type { TreeNode } from "../dom.ts";

type Token = { kind: "number" | "symbol" | "sign"; text: string };

/** null: a character that cannot occur in a law. */
function tokens(text: string): Token[] | null {
  const found: Token[] = [];
  const pattern = /\s*(?:(\d+(?:\.\d+)?)|([A-Za-z][A-Za-z0-9_]*)|([-+/^()[\]=]))/y;
  const tidy = text.trim();
  while (pattern.lastIndex < tidy.length) {
    const match = pattern.exec(tidy);
    if (!match) return null;
    const [, number, symbol, sign] = match;
    if (number !== undefined) found.push({ kind: "number", text: number });
    else if (symbol !== undefined) found.push({ kind: "symbol", text: symbol });
    else found.push({ kind: "sign", text: sign! });
  }
  return found;
}

const CLOSING: Record<string, string> = { "(": ")", "[": "]" };
const mo = (sign: string): TreeNode => node("mo", {}, sign);
/** Between two factors: names of several letters need the space. */
const times = (): TreeNode => node("mo", { lspace: "0", rspace: "0.22em" }, "\u2062");
const row = (children: TreeNode[]): TreeNode => (children.length === 1 ? children[0]! : node("mrow", {}, ...children));

/** The content of two brackets, with the brackets if they must stay. */
interface Factor {
  inside: TreeNode;
  brackets: [string, string] | null;
  /** A fraction groups its content without brackets. */
  holds: boolean;
}

class Parser {
  private at = 0;
  constructor(private readonly tokens: Token[]) {}

  /** left = right; null if this is not an equation. */
  equation(): TreeNode[] | null {
    const left = this.sum();
    if (!left || !this.take("=")) return null;
    const right = this.sum();
    return right && this.at === this.tokens.length ? [...left, mo("="), ...right] : null;
  }

  private take(text: string): boolean {
    const found = this.tokens[this.at]?.text === text;
    if (found) this.at += 1;
    return found;
  }

  private sum(): TreeNode[] | null {
    const parts: TreeNode[] = [];
    for (;;) {
      const sign = this.take("-") ? "−" : this.take("+") ? "+" : "";
      if (sign === "" && parts.length > 0) return parts;
      if (sign !== "") parts.push(mo(sign));
      const term = this.quotient();
      if (!term) return null;
      parts.push(...term);
    }
  }

  /** Factors; each slash divides the preceding factors by the one product that follows. */
  private quotient(): TreeNode[] | null {
    const top = this.factors();
    if (!top) return null;
    if (!this.take("/")) return product(top);
    const bottom = this.factors(1);
    if (!bottom) return null;
    const fraction = node("mfrac", {}, row(bare(top)), row(bare(bottom)));
    const rest = this.factors();
    return rest ? [fraction, times(), ...product(rest)] : [fraction];
  }

  private factors(max = Infinity): Factor[] | null {
    const parts: Factor[] = [];
    while (parts.length < max) {
      const part = this.factor();
      if (!part) break;
      const power = this.take("^") ? this.factor() : null;
      parts.push(power ? raised(part, power) : part);
    }
    return parts.length > 0 ? parts : null;
  }

  private factor(): Factor | null {
    const token = this.tokens[this.at];
    if (!token) return null;
    if (token.kind !== "sign") {
      this.at += 1;
      return { inside: node(token.kind === "number" ? "mn" : "mi", {}, token.text), brackets: null, holds: false };
    }
    const closing = CLOSING[token.text];
    if (!closing) return null;
    const before = this.at;
    this.at += 1;
    const inside = this.sum();
    if (!inside || !this.take(closing)) {
      this.at = before;
      return null;
    }
    const holds = inside.length === 1 && inside[0]!.tag === "mfrac";
    return { inside: row(inside), brackets: [token.text, closing], holds };
  }
}

const shown = ({ inside, brackets, holds }: Factor): TreeNode[] =>
  brackets && !holds ? [mo(brackets[0]), inside, mo(brackets[1])] : [inside];

const product = (factors: Factor[]): TreeNode[] =>
  factors.flatMap((factor, index) => (index === 0 ? shown(factor) : [times(), ...shown(factor)]));

const raised = (base: Factor, power: Factor): Factor => ({
  inside: node("msup", {}, row(shown(base)), row(shown(power))),
  brackets: null,
  holds: false,
});

/** Above or below a fraction's line, which replaces the brackets of a single factor. */
const bare = (factors: Factor[]): TreeNode[] =>
  factors.length === 1 ? [factors[0]!.inside] : product(factors);

/** Commas outside brackets separate equations; a final remark in brackets is words. */
function parts(law: string): string[] {
  const remark = /^(.*\S)\s+\(([a-z][a-z ]{3,})\)$/.exec(law);
  const [text, words] = remark ? [remark[1]!, [remark[2]!]] : [law, []];
  return [...text.split(/,\s+/), ...words];
}

/** The law's equations; words among them stay words. Null if its first part is not an equation: then the text is
    shown. */
export function lawFormulas(law: string): (TreeNode | string)[] | null {
  const list = parts(law).map((part): TreeNode | string => {
    const read = tokens(part);
    const equation = read && new Parser(read).equation();
    return equation ? node("math", { display: "block" }, row(equation)) : part;
  });
  return typeof list[0] === "string" ? null : list;
}
