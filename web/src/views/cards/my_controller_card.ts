// "My controller": the product, and the facts about the loop that its formulas need.
import type { FieldError, Need, ProductSummary } from "../../api/types.ts";
import { h, uniqueId } from "../../dom.ts";
import { combobox } from "../../form/combobox.ts";
import type { Choice } from "../../form/combobox.ts";
import { textField } from "../../form/controls.ts";
import type { FormErrors } from "../../form/errors.ts";
import { parseNumber } from "../../form/number.ts";
import { spanFields } from "../../form/span_fields.ts";
import { missingOf, sameImplement } from "../../my_controller.ts";
import type { MyController } from "../../my_controller.ts";
import type { UnitNames } from "../../words/numbers.ts";
import { TEXTBOOK_FORMS, formTitle } from "../../words/settings.ts";
import type { TextbookForm } from "../../words/settings.ts";
import { usualSpan } from "../../words/record_names.ts";
import { evidenceWords, findProducts, needSentence, productTitle } from "../../words/products.ts";

const formChoice = (form: TextbookForm): Choice => ({ id: form, text: formTitle(form), aside: "" });

/** The forms whose title contains the typed text. */
const findForms = (typed: string): Choice[] =>
  TEXTBOOK_FORMS.map(formChoice).filter(({ text }) => text.toLowerCase().includes(typed.trim().toLowerCase()));

export interface MyControllerCard {
  element: HTMLElement;
  /** With `forms` the answer card places these parts: `facts` (what is missing) with `below`, and the folded ranges. */
  notes: HTMLElement[];
  facts: HTMLElement;
  setProducts(products: ProductSummary[]): void;
  setUnits(units: UnitNames): void;
  /** The values of u in the loop's record, which show its range if its unit does not. */
  setOutput(values: readonly (number | null)[]): void;
  /** Without reporting. `form`: the textbook form that stands in place of a product, where forms are offered. */
  /** As if it were chosen in the field: with the usual ranges, and reported. */
  choose(id: string | undefined): void;
  set(mine: MyController | null, form?: TextbookForm): void;
  /** The fields as typed, by names for an address; the product itself is set by `set`. */
  texts(): Record<string, string>;
  setTexts(texts: Record<string, string>): void;
  /** The content of the fields. A missing fact is not a fault: the card names it. */
  read(): { mine: MyController | null; errors: FieldError[] };
}

export interface MyControllerOptions {
  /** Offers the textbook forms as well as the products: the field alone, for the card of the settings. */
  forms: boolean;
  /** Receives the readable part, whether or not something is missing yet; `form`: the textbook form in place of a
      product. */
  onChange(mine: MyController | null, form: TextbookForm): void;
}

export function myControllerCard(
  errors: FormErrors,
  { forms, onChange }: MyControllerOptions,
  ...below: HTMLElement[]
): MyControllerCard {
  let products: ProductSummary[] = [];
  let units: UnitNames | null = null;
  let recorded: readonly (number | null)[] = [];
  let chosen: Pick<MyController, "product" | "name" | "needs"> | null = null;
  let form: TextbookForm = "ideal";
  const title = h("h2", { id: uniqueId("mine") }, "My controller ", h("span", { class: "optional" }, "optional"));
  const search = combobox(
    {
      label: "Maker and product",
      bare: forms,
      placeholder: "type a maker or a name, such as DeltaV",
      pointer: () => "/implement/product",
      find: (typed) => [...(forms ? findForms(typed) : []), ...findProducts(products, typed).map(choiceOf)],
      onChoose: (choice) => choose(choice?.id),
      onLeft: change,
    },
    errors,
  );
  const measurement = spanFields(
    { label: "Measurement range", pointer: "/implement/y_span", onChange: change },
    errors,
  );
  const output = spanFields(
    { label: "Output range", pointer: "/implement/u_span", onChange: change },
    errors,
  );
  const sampling = textField(
    {
      label: "Sample time",
      hint: "Empty: the product's default, if known.",
      pointer: () => "/implement/sample_time",
    },
    errors,
  );
  sampling.input.addEventListener("change", change);
  const needed = h("p", { class: forms ? "trouble" : "hint", role: "status", hidden: true });
  const fields = h("div", { class: "needs", hidden: true }, measurement.element, output.element, sampling.element);
  const forget = h("button", { type: "button", class: "quiet", hidden: true, onclick: () => choose(undefined) }, "No controller");
  const facts = h("details", { class: "facts", hidden: true }, h("summary", {}, "Ranges and sample time"));
  if (forms) facts.append(fields);
  const notes = [needed, ...below];
  const element = forms
    ? h("div", { class: "my-controller" }, search.element)
    : h(
        "section",
        { class: "card my-controller", "aria-labelledby": title.id },
        h("div", { class: "head" }, title, forget),
        search.element,
        fields,
        notes,
      );

  const choiceOf = (product: ProductSummary): Choice => ({
    id: product.id,
    text: productTitle(product),
    aside: evidenceWords(product.evidence),
  });

  /** `id`: of a product or a textbook form; undefined: none. */
  function choose(id: string | undefined): void {
    form = TEXTBOOK_FORMS.find((name) => name === id) ?? form;
    const product = products.find((item) => item.id === id);
    chosen = product ? { product: product.id, name: productTitle(product), needs: product.needs as Need[] } : null;
    propose();
    show();
    change();
  }

  /** The usual ranges, where none is given. They are seen before they are used. True if there was one. */
  function propose(): boolean {
    let proposed = false;
    for (const [need, field, usual] of [
      ["y_span", measurement, usualSpan(units?.y ?? "")],
      ["u_span", output, usualSpan(units?.u ?? "", recorded)],
    ] as const) {
      if (!chosen?.needs.includes(need) || !usual || !field.isEmpty()) continue;
      field.set(usual);
      facts.open = proposed = true;
    }
    return proposed;
  }

  /** Shows the fields that the chosen product needs, and no others. */
  function show(): void {
    search.set(chosen ? { id: chosen.product, text: chosen.name, aside: "" } : forms ? formChoice(form) : null);
    const needs = (need: Need): boolean => chosen?.needs.includes(need) ?? false;
    fields.hidden = facts.hidden = !chosen;
    forget.hidden = !chosen;
    measurement.element.hidden = !needs("y_span");
    output.element.hidden = !needs("u_span");
  }

  /** A typed name that is not in the list. */
  function readUnmatched(): FieldError[] {
    const typed = search.unmatched();
    if (typed === "") return [];
    const kept = chosen?.name ?? (forms ? formTitle(form) : "");
    const next = kept ? `${kept} is still chosen: choose another one from the list, or press Escape` : "Choose one from the list, or clear the field";
    return [{ pointer: "/implement/product", detail: `There is no controller "${typed}" in the list. ${next}.` }];
  }

  function read(): { mine: MyController | null; errors: FieldError[] } {
    const unmatched = readUnmatched();
    if (!chosen) return { mine: null, errors: unmatched };
    const [y, u] = [measurement.read(), output.read()];
    const typed = sampling.input.value.trim();
    const period = typed === "" ? null : parseNumber(typed, "Sample time");
    const faults = [...unmatched, ...(measurement.element.hidden ? [] : y.errors), ...(output.element.hidden ? [] : u.errors)];
    if (period && !period.ok) faults.push({ pointer: "/implement/sample_time", detail: period.sentence });
    else if (period?.ok && !(period.value > 0))
      faults.push({
        pointer: "/implement/sample_time",
        detail: `Sample time is ${typed}; it is the time from one sample to the next and must be above 0.`,
      });
    const mine: MyController = {
      ...chosen,
      ...(y.span ? { y_span: y.span } : {}),
      ...(u.span ? { u_span: u.span } : {}),
      ...(period?.ok && period.value > 0 ? { sample_time: period.value } : {}),
      ...(units ? { units } : {}),
    };
    return { mine, errors: faults };
  }

  function write(mine: MyController | null): void {
    measurement.set(mine?.y_span);
    output.set(mine?.u_span);
    sampling.input.value = mine?.sample_time === undefined ? "" : String(mine.sample_time);
  }

  function sayMissing(mine: MyController | null): void {
    needed.textContent = mine ? needSentence(missingOf(mine)) : "";
    if (needed.textContent !== "") facts.open = true;
    needed.hidden = needed.textContent === "";
  }

  function change(): void {
    const { mine, errors: faults } = read();
    errors.mark("/implement", faults);
    sayMissing(mine);
    onChange(mine, form);
  }

  return {
    element,
    notes,
    facts,
    setProducts(list) {
      products = list;
      search.refresh();
    },
    setUnits(next) {
      units = next;
      measurement.setUnit(units.y);
      output.setUnit(units.u);
      sampling.setUnit(units.time);
      if (chosen && propose()) change();
    },
    setOutput(values) {
      recorded = values;
    },
    choose,
    set(mine, given) {
      // Half a range, or a name that no product has yet, stays as typed.
      const same = forms ? false : sameImplement(read().mine, mine);
      form = given ?? form;
      chosen = mine ? { product: mine.product, name: mine.name, needs: mine.needs } : null;
      if (!same) write(mine);
      if (!same || mine) show();
      sayMissing(mine);
    },
    texts: () => ({
      controller: chosen?.product ?? "",
      "controller.y": measurement.text(),
      "controller.u": output.text(),
      "controller.sample_time": sampling.input.value.trim(),
    }),
    setTexts(texts) {
      measurement.setText(texts["controller.y"] ?? "");
      output.setText(texts["controller.u"] ?? "");
      sampling.input.value = texts["controller.sample_time"] ?? "";
    },
    read,
  };
}
