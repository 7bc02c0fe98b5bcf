// The known facts about a product: its law as a formula, its computation, typical mistakes, and the sources.
import type { Product, ProductParameter } from "../../api/types.ts";
import { breakable, h, mathElement, uniqueId } from "../../dom.ts";
import { lawFormulas } from "../../form/law.ts";
import { evidenceSentence, productTitle, rangeWords } from "../../words/products.ts";

export interface ProductCard {
  element: HTMLElement;
  show(product: Product | null): void;
}

export function productCard(): ProductCard {
  let shown: string | null = null;
  const title = h("h2", { id: uniqueId("product") });
  const body = h("div", { class: "product-body" });
  const element = h("section", { class: "card product-card", "aria-labelledby": title.id, hidden: true }, title, body);
  return {
    element,
    show(product) {
      element.hidden = !product;
      if (!product || product.id === shown) return;
      shown = product.id;
      title.textContent = `How ${productTitle(product)} computes`;
      body.replaceChildren(
        law(product),
        h(
          "div",
          { class: "product-columns" },
          h("div", {}, facts(product), ...traps(product), evidence(product)),
          h("div", {}, parameterTable(product)),
        ),
      );
    },
  };
}

/** The formula, or its text if there is no formula, with its sources. */
function law({ law, evidence }: Product): HTMLElement {
  const formulas = lawFormulas(law) ?? [law];
  const { sources } = evidence;
  return h(
    "figure",
    { class: "law" },
    h(
      "div",
      { class: "law-formulas", tabindex: 0, role: "group", "aria-label": `Its law: ${law}` },
      formulas.map((formula) =>
        typeof formula === "string" ? h("span", { class: "words" }, formula) : mathElement(formula),
      ),
    ),
    h(
      "figcaption",
      { class: "hint" },
      sources.length === 0 ? "No source is known." : `${sources.length === 1 ? "Source" : "Sources"}: ${sources.join("; ")}.`,
    ),
  );
}

function facts(product: Product): HTMLElement {
  const { algorithm, setpoint_weights: weights } = product;
  const rules = `${algorithm.form} form; integral ${algorithm.integral}, derivative ${algorithm.derivative}${algorithm.published ? "" : " (assumed)"}`;
  const clock =
    algorithm.sample_time_text ??
    (algorithm.sample_time === null ? "" : `${algorithm.sample_time} s${algorithm.clock_fixed ? ", fixed" : " by default"}`);
  const rows: [string, string | undefined][] = [
    ["Gain counts in", product.gain_basis],
    ["Filter", product.filter],
    ["Set-point weights", weights.text ?? `b ${weights.b ?? "?"}, c ${weights.c ?? "?"}`],
    ["Direction", product.action.text],
    ["Algorithm", [rules, algorithm.text].filter(Boolean).join("; ")],
    ["Sample time", clock],
    ["At limits", algorithm.anti_windup],
  ];
  return h(
    "dl",
    {},
    rows.flatMap(([name, value]) => (value ? [h("dt", {}, name), h("dd", {}, value)] : [])),
  );
}

const traps = ({ traps }: Product): HTMLElement[] =>
  traps.length === 0
    ? []
    : [
        h("h3", {}, "Pitfalls"),
        h(
          "ul",
          { class: "notes" },
          traps.map((trap) => h("li", {}, trap)),
        ),
      ];

function evidence({ evidence }: Product): HTMLElement {
  const { read } = evidence;
  return h(
    "div",
    { class: "evidence" },
    h("h3", {}, "Evidence"),
    h("p", {}, evidenceSentence(evidence)),
    read.length > 0 ? h("p", { class: "hint" }, `Read: ${read.join("; ")}.`) : null,
  );
}

function parameterTable({ parameters }: Product): HTMLElement {
  const cell = (parameter: ProductParameter): string =>
    [rangeWords(parameter), parameter.choices?.map((choice) => String(choice.value)).join(", ")].filter(Boolean).join("; ");
  const head = (text: string): HTMLElement => h("th", { scope: "col" }, text);
  return h(
    "div",
    { class: "scroll", tabindex: 0, role: "region", "aria-label": "Parameters" },
    h(
      "table",
      { class: "figures parameters" },
      h("thead", {}, h("tr", {}, head("Parameter"), head("From the law"), head("Unit"), head("Takes"))),
      h(
        "tbody",
        {},
        parameters.map((parameter) =>
          h(
            "tr",
            { title: parameter.remark ?? null },
            h("th", { scope: "row" }, breakable(parameter.label || parameter.name)),
            h("td", {}, parameter.formula),
            h("td", {}, parameter.unit),
            h("td", {}, cell(parameter)),
          ),
        ),
      ),
    ),
    h("p", { class: "hint" }, "Kp, Ti, Td, Tf of the law in seconds; Kc, ti, td of the series form; Sy, Su the ranges; Ts the sample time."),
  );
}
