// Today's settings in the user's own controller, for a comparison with the design.
import type { Product, SettingValue, TypedSettings } from "../../api/types.ts";
import { h } from "../../dom.ts";
import type { FormErrors } from "../../form/errors.ts";
import { productFields } from "../../form/product_fields.ts";

export interface OwnTodayCard {
  element: HTMLElement;
  /** The button that compares the design with them. */
  button: HTMLButtonElement;
  setProduct(product: Product | null): void;
  load(baseline: TypedSettings): void;
}

/** `onSet`: undefined if nothing is typed. */
export function ownTodayCard(
  errors: FormErrors,
  onSet: (settings: Record<string, SettingValue> | undefined) => void,
): OwnTodayCard {
  const fields = productFields(errors, () => true);
  const button = h("button", { type: "button", onclick: read }, "Compare the design with these");
  const element = h(
    "details",
    { class: "own-today", hidden: true },
    h("summary", {}, "Today's settings in this controller"),
    h("p", { class: "hint" }, "The present settings; an empty field means the maker's default."),
    fields.element,
    h("div", { class: "actions" }, button),
  );

  function read(): void {
    const { settings, errors: faults } = fields.read();
    errors.mark("/baseline", faults);
    if (faults.length === 0) onSet(settings);
  }

  return {
    element,
    button,
    setProduct(product) {
      element.hidden = !product;
      fields.setProduct(product);
    },
    load: (baseline) => fields.load(baseline.settings),
  };
}
