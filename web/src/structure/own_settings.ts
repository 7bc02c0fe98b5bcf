// The settings to type into the user's own controller, for each controller of a structure, as the answer has them.
import { getProduct } from "../api/products.ts";
import type { StructureAnswer } from "../api/structure.ts";
import type { Implement, Product } from "../api/types.ts";
import { h } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { implementOf, inUnits, rememberMine } from "../my_controller.ts";
import type { MyController } from "../my_controller.ts";
import type { Store } from "../store.ts";
import { myControllerCard } from "../views/cards/my_controller_card.ts";
import { copyButton } from "../views/copy.ts";
import type { UnitNames } from "../words/numbers.ts";
import { productTitle, typedRows, typedText } from "../words/products.ts";
import { nameOfLoop } from "../words/structure.ts";

export interface OwnSettings {
  element: HTMLElement;
  /** The member of a request; null: no product is chosen. */
  implement(): Implement | null;
  setUnits(units: UnitNames): void;
  show(answer: StructureAnswer): void;
  dispose(): void;
}

const ONE_RANGE = "The ranges above are used for every controller of the structure.";

export function ownSettings(store: Store, announce: (sentence: string) => void, onChange: () => void): OwnSettings {
  let mine: MyController | null = store.get().mine;
  let shown: StructureAnswer | null = null;
  const typed = h("div", { class: "structure-settings" });
  const hint = h("p", { class: "hint", hidden: true }, ONE_RANGE);
  const picker = myControllerCard(new FormErrors(), { forms: false, onChange: choose }, hint, typed);
  picker.setProducts(store.get().products);
  picker.set(mine);

  function choose(next: MyController | null): void {
    mine = next;
    rememberMine(next);
    store.set((workspace) => ({ ...workspace, mine: next }));
    onChange();
  }

  const leave = store.subscribe((workspace, previous) => {
    if (workspace.products !== previous.products) picker.setProducts(workspace.products);
    if (workspace.mine === previous.mine || workspace.mine === mine) return;
    mine = workspace.mine;
    picker.set(mine);
  });

  function draw({ settings = [] }: StructureAnswer, product: Product): void {
    typed.replaceChildren(
      ...settings.map(({ loop, typing, why }) => {
        const name = nameOfLoop(loop);
        const rows = typing ? typedRows(product, typing) : [];
        const text = (): string => typedText(`${productTitle(product)}, ${name}`, rows);
        return h(
          "div",
          { class: "block-typing" },
          h("h3", {}, name, rows.length > 0 ? copyButton({ label: "Copy", spoken: `Copy ${name}`, look: "quiet", text }, announce) : null),
          h("dl", {}, rows.map(({ label, value, unit }) => h("div", {}, h("dt", {}, unit ? `${label} (${unit})` : label), h("dd", {}, value)))),
          why ? h("p", {}, why) : null,
          typing && typing.notes.length > 0 ? h("ul", { class: "notes" }, typing.notes.map(({ detail }) => h("li", {}, detail))) : null,
        );
      }),
    );
  }

  return {
    element: picker.element,
    implement: () => implementOf(mine),
    setUnits(units) {
      picker.setUnits(units);
      mine = inUnits(mine, units);
      picker.set(mine);
    },
    show(answer) {
      shown = answer;
      const product = answer.settings?.find(({ typing }) => typing)?.typing?.product;
      hint.hidden = !product || (mine?.needs.length ?? 0) === 0 || answer.settings!.length < 2;
      if (product === undefined) return typed.replaceChildren();
      getProduct(product).then(
        (known) => shown === answer && draw(answer, known),
        () => typed.replaceChildren(),
      );
    },
    dispose: leave,
  };
}
