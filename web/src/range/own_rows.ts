// The schedule in the form of the user's own controller: the settings to type for each row, and the product's
// interpolation.
import { ApiError, sentenceOf } from "../api/client.ts";
import { latest } from "../api/latest.ts";
import { getProduct, scheduleSettingsFor } from "../api/products.ts";
import type { Implement, Product, RangeContent, ScheduleRow, TypedSchedule } from "../api/types.ts";
import { breakable, h } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { implementOf, inUnits, rememberMine } from "../my_controller.ts";
import type { MyController } from "../my_controller.ts";
import type { Store } from "../store.ts";
import { myControllerCard } from "../views/cards/my_controller_card.ts";
import { copyButton } from "../views/copy.ts";
import { plainSetting, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { noteTimes, productTitle, splitNotes, typedRows } from "../words/products.ts";
import { placeWords } from "../words/range.ts";

interface Shown {
  scheduling: RangeContent["scheduling"];
  rows: readonly ScheduleRow[];
  interpolation: string;
  units: UnitNames;
}

interface Question extends Shown {
  implement: Implement & { product: string };
}

export interface OwnRows {
  element: HTMLElement;
  /** null: there is no schedule. */
  show(shown: Shown | null): void;
  dispose(): void;
}

export function ownRows(store: Store, announce: (sentence: string) => void): OwnRows {
  let mine: MyController | null = store.get().mine;
  let shown: Shown | null = null;
  let asked = "";
  let copied = "";
  const errors = new FormErrors();
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const answer = h("div", { class: "own-rows", hidden: true });
  const copy = copyButton({ label: "Copy the table", text: () => copied || null }, announce);
  const picker = myControllerCard(errors, { forms: false, onChange: chooseMine }, trouble, answer);
  picker.element.hidden = true;
  picker.setProducts(store.get().products);
  picker.set(mine);

  const calls = latest<Question, [Product, TypedSchedule]>(
    ({ implement, rows, interpolation, units }) =>
      Promise.all([getProduct(implement.product), scheduleSettingsFor(implement, rows, interpolation, units)]),
    {
      onBusy: (busy) => picker.element.setAttribute("aria-busy", String(busy)),
      onAnswer([product, typed], { scheduling, units }) {
        draw(product, typed, scheduling, units);
        announce(`The schedule for ${productTitle(product)} is shown.`);
      },
      onError: complain,
    },
  );

  function complain(error: unknown): void {
    const listed = error instanceof ApiError ? (error.problem.errors ?? []) : [];
    trouble.textContent = listed[0]?.detail ?? sentenceOf(error);
    trouble.hidden = false;
    answer.hidden = true;
    asked = "";
  }

  function chooseMine(next: MyController | null): void {
    mine = next;
    rememberMine(next);
    store.set((workspace) => ({ ...workspace, mine: next }));
    ask();
  }

  function ask(): void {
    const implement = implementOf(mine);
    if (!shown || !implement) {
      calls.drop();
      asked = "";
      answer.hidden = true;
      trouble.hidden = true;
      return;
    }
    const key = JSON.stringify([implement, shown]);
    if (key === asked) return;
    asked = key;
    calls.send({ ...shown, implement });
  }

  function draw(
    product: Product,
    typed: TypedSchedule,
    scheduling: Shown["scheduling"],
    units: UnitNames,
  ): void {
    const lines = typed.rows.map(({ at, typing }) => ({ at, cells: typedRows(product, typing), notes: typing.notes }));
    const columns = lines[0]!.cells;
    const place = withUnit(scheduling.name || "at", scheduling.unit ?? "");
    const heads = [place, ...columns.map(({ label, unit }) => withUnit(label, unit))];
    const texts = lines.map(({ at, cells }) => [
      plainSetting(at),
      ...columns.map(({ name }) => cells.find((cell) => cell.name === name)?.value ?? ""),
    ]);
    copied = [heads, ...texts].map((line) => line.join("\t")).join("\n");
    const { deviations, remarks } = splitNotes(typed.notes);
    const ofRows = lines.flatMap(({ at, notes }) =>
      notes.map(({ code, detail }) => ({ code, detail: `At ${placeWords(at, scheduling)}: ${detail}` })),
    );
    const items = (notes: { detail: string }[]): HTMLElement =>
      h("ul", { class: "notes" }, notes.map(({ detail }) => h("li", {}, detail)));
    answer.replaceChildren(
      h("h3", {}, `Type into ${productTitle(product)}`),
      h(
        "div",
        { class: "scroll", role: "region", "aria-label": "Settings of each row", tabindex: 0 },
        h(
          "table",
          { class: "figures" },
          h("caption", { class: "visually-hidden" }, "Settings of each row"),
          h("thead", {}, h("tr", {}, heads.map((head) => h("th", { scope: "col" }, breakable(head))))),
          h(
            "tbody",
            {},
            texts.map(([at, ...values]) =>
              h("tr", {}, h("th", { scope: "row" }, at!), values.map((value) => h("td", {}, value))),
            ),
          ),
        ),
      ),
      h("div", { class: "actions" }, copy),
      deviations.length > 0 ? items(deviations) : "",
      deviations.length + remarks.length + ofRows.length > 0 ? h("p", { class: "hint" }, noteTimes(units.time)) : "",
      remarks.length + ofRows.length > 0
        ? h("details", {}, h("summary", {}, "How this was calculated"), items([...remarks, ...ofRows]))
        : "",
    );
    trouble.hidden = true;
    answer.hidden = false;
  }

  /** Drops numbers that were given in other units. */
  function take(next: MyController | null): void {
    mine = shown ? inUnits(next, shown.units) : next;
    picker.set(mine);
  }

  const leave = store.subscribe((workspace, previous) => {
    if (workspace.products !== previous.products) picker.setProducts(workspace.products);
    // Chosen on another screen, while this one is hidden.
    if (workspace.mine === previous.mine || workspace.mine === mine) return;
    take(workspace.mine);
    ask();
  });

  return {
    element: picker.element,
    show(next) {
      picker.element.hidden = next === null;
      const units = JSON.stringify(shown?.units);
      shown = next;
      if (next && JSON.stringify(next.units) !== units) {
        picker.setUnits(next.units);
        take(mine);
      }
      ask();
    },
    dispose() {
      leave();
      calls.drop();
    },
  };
}
