// A nonlinear plant's operating point and its linear model there, which methods and robustness use.
import type { Plant, Result, TuningRequest } from "../../api/types.ts";
import { h } from "../../dom.ts";
import { plantFormula } from "../../form/formula.ts";
import { rootsOf, rootWords, transferFunction } from "../../words/linear_model.ts";
import { formatNumber, unitNames, withUnit } from "../../words/numbers.ts";
import { inputOf, outputName } from "../../words/plant.ts";

/** Digits that show the difference of a given state from the steady one. */
const DIGITS = 6;

/** Null if the result is not of a nonlinear plant. */
export function operatingCard(result: Result, request: TuningRequest | undefined): HTMLElement | null {
  const point = result.operating_point;
  if (!point) return null;
  const units = unitNames(request?.units);
  const plant = request?.plant;
  const given = (plant?.["states"] ?? {}) as Record<string, number>;
  const row = (name: string, value: number, near = ""): HTMLElement =>
    h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, formatNumber(value, DIGITS)), h("td", {}, near));
  const input = inputOf(plant)?.name ?? "u";
  return h(
    "section",
    { class: "card operating", "aria-labelledby": "operating-title" },
    h("h2", { id: "operating-title" }, "Operating point"),
    h(
      "table",
      { class: "figures" },
      h("caption", { class: "visually-hidden" }, "Steady state from which all responses start"),
      h("thead", {}, h("tr", {}, h("td", {}), h("th", { scope: "col" }, "steady"), h("th", { scope: "col" }, "given"))),
      h(
        "tbody",
        {},
        Object.entries(point.states).map(([name, value]) =>
          row(name, value, typeof given[name] === "number" ? formatNumber(given[name], DIGITS) : ""),
        ),
        row(withUnit(named("u", input), units.u), point.u),
        row(withUnit(named("y", outputName(plant)), units.y), point.y),
      ),
    ),
    ...linearModel(result.linear_model, units.time),
    equationsOf(plant),
  );
}

/** "u: Tj"; only "u" if it has no other name. */
const named = (symbol: string, name: string): string => (name === symbol ? symbol : `${symbol}: ${name}`);

function linearModel(model: Plant | undefined, time: string): HTMLElement[] {
  const transfer = transferFunction(model);
  if (!transfer) return [];
  const four = (values: number[]): number[] => values.map((value) => Number(value.toPrecision(4)));
  const formula = plantFormula(
    { type: "transfer_function", num: four(transfer.num), den: four(transfer.den), L: model?.L ?? 0 },
    "div",
    true,
  );
  const [poles, zeros] = [rootsOf(transfer.den), rootsOf(transfer.num)];
  const last = transfer.den[transfer.den.length - 1]!;
  const gain = last === 0 ? null : transfer.num[transfer.num.length - 1]! / last;
  const facts: [string, string][] = [
    [`Poles (1/${time})`, rootWords(poles)],
    [`Zeros (1/${time})`, rootWords(zeros)],
    ["Gain", formatNumber(gain, 4)],
  ];
  return [
    h("h2", {}, "Linear model there"),
    formula,
    h(
      "dl",
      {},
      facts.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]),
    ),
  ];
}

function equationsOf(plant: Plant | undefined): HTMLElement | null {
  const equations = Object.entries((plant?.["equations"] ?? {}) as Record<string, string>);
  if (equations.length === 0) return null;
  const parameters = Object.entries((plant?.["parameters"] ?? {}) as Record<string, number | string>);
  const lines = [
    ...equations.map(([name, text]) => `d${name}/dt = ${text}`),
    `y = ${String(plant?.["output"] ?? "")}`,
    ...parameters.map(([name, value]) => `${name} = ${value}`),
  ];
  return h(
    "details",
    {},
    h("summary", {}, "Equations"),
    h(
      "ul",
      { class: "plain equation-lines" },
      lines.map((line) => h("li", {}, h("code", {}, line))),
    ),
  );
}
