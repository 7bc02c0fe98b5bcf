// Units and today's settings: both optional.
import { sentenceOf } from "../../api/client.ts";
import { newest } from "../../api/latest.ts";
import { getProduct } from "../../api/products.ts";
import { controllerInRecord } from "../../api/records.ts";
import type { FieldError, Filter, GivenController, RecordedTest, SettingValue, TuningRequest, Units } from "../../api/types.ts";
import { h } from "../../dom.ts";
import { choiceField, textField } from "../../form/controls.ts";
import type { FormErrors } from "../../form/errors.ts";
import { keptNote } from "../../form/kept_note.ts";
import { parseNumber } from "../../form/number.ts";
import { productFields } from "../../form/product_fields.ts";
import { typedParts } from "../../form/typed.ts";
import { mineOfRequest, typedInto } from "../../my_controller.ts";
import type { MyController } from "../../my_controller.ts";
import { exactText } from "../../words/numbers.ts";
import { foundWords } from "../../words/settings.ts";
import type { RecordNames } from "../../words/record_names.ts";

export interface TodayCard {
  element: HTMLElement;
  /** Undefined: none is named. */
  readUnits(): Units | undefined;
  /** The units that were typed since the loop began. */
  typedUnits(): Units | undefined;
  read(): { baseline: TuningRequest["baseline"]; errors: FieldError[] };
  load(units: Units | undefined, baseline: TuningRequest["baseline"], name: string | undefined): void;
  readName(): string;
  /** Names that a file tells: written where nothing is typed. */
  propose(names: RecordNames): void;
  /** The record in which today's settings can be found; null: there is none, or not of a loop. */
  offerRecord(read: (() => RecordedTest) | null): void;
  /** A new loop: values that were filled in, or belonged to the previous loop, are cleared; values typed for this
      one stay. */
  beginLoop(): void;
  /** The displayed values belong to this loop: they must be typed again for the next one. */
  endLoop(): void;
  /** The user's own controller, which adds a form of its own. */
  setMine(mine: MyController | null): void;
}

const DEFAULT_FILTER = "derivative";

/** Instead of a form: the settings as typed into the user's own controller. */
const OWN = "own";

/** Instead of a form: the settings that moved u in the record. */
const FOUND = "from-record";

/** The part of the card other than labels. */
const BASELINE = "baseline";

const FORMS = [
  ["ideal", "ideal"],
  ["parallel", "parallel"],
  ["series", "series"],
  ["npid", "nonlinear"],
] as const;

export function todayCard(errors: FormErrors, onUnits: () => void): TodayCard {
  const unit = (label: string, pointer: string, value: string, placeholder: string): ReturnType<typeof textField> =>
    textField({ label, value, placeholder, pointer: () => pointer }, errors);
  const name = unit("Loop name", "/name", "", "TIC-101");
  const time = unit("Time unit", "/units/time", "", "s");
  const u = unit("Unit of u", "/units/u", "", "%");
  const y = unit("Unit of y", "/units/y", "", "degC");
  for (const field of [time, u, y]) field.input.addEventListener("change", onUnits);

  const form = choiceField({ label: "Form", choices: FORMS, pointer: () => "/baseline/form" }, errors);
  const slots = (["first", "second", "third"] as const).map((_, index) =>
    textField({ label: "", pointer: () => `/baseline/${names()[index]}` }, errors),
  );
  const filter = textField(
    { label: "Tf", hint: "filter of the derivative; empty: none", pointer: () => "/baseline/filter/Tf" },
    errors,
  );
  const delta = textField(
    {
      label: "delta_r",
      hint: "much larger errors hardly enter the integral; empty: the set-point step",
      pointer: () => "/baseline/delta_r",
    },
    errors,
  );
  // A loaded request may have them in another product than the chosen one.
  let mine: MyController | null = null;
  const own = productFields(errors, () => isOwn());
  own.element.hidden = true;
  let record: (() => RecordedTest) | null = null;
  const note = h("p", { class: "hint", role: "status", hidden: true });
  const beginFind = newest();
  /** The service has found them: what it refuses is not sent. */
  let sure = false;
  // Members of a loaded request that no field shows, e.g. set-point weights.
  let rest: Record<string, unknown> = {};
  let filterType = DEFAULT_FILTER;
  const kept = keptNote("today's settings", () => keep({}));

  function keep(parts: Record<string, unknown>): void {
    rest = parts;
    label();
  }

  function names(): [string, string, string] {
    return form.input.value === "parallel" ? ["Kp", "Ki", "Kd"] : ["Kp", "Ti", "Td"];
  }
  const isOwn = (): boolean => form.input.value === OWN;
  const isFound = (): boolean => form.input.value === FOUND;

  function label(): void {
    own.element.hidden = !isOwn();
    form.element.classList.toggle("wide", isOwn());
    for (const field of [...slots, filter]) field.element.hidden = isOwn() || isFound();
    kept.show(isOwn() || isFound() ? {} : rest);
    names().forEach((text, index) => slots[index]!.setLabel(text));
    delta.element.hidden = form.input.value !== "npid";
  }
  function showProduct(settings?: Record<string, SettingValue>): void {
    const id = mine?.product;
    if (id === undefined) return own.setProduct(null);
    getProduct(id).then(
      (product) => {
        if (mine?.product !== id) return;
        own.setProduct(product);
        if (settings) own.load(settings);
      },
      // Without its parameters there are no fields, but the other forms are still available.
      () => own.setProduct(null),
    );
  }

  /** Its own form is offered if there is a controller. */
  function setMine(next: MyController | null, settings?: Record<string, SettingValue>): void {
    mine = next;
    showForms();
    showProduct(settings);
  }

  function showForms(): void {
    const chosen = form.input.value;
    const own = mine ? [[OWN, mine.name] as const] : [];
    const found = record ? [[FOUND, "from the record"] as const] : [];
    form.input.replaceChildren(
      ...[...FORMS, ...own, ...found].map(([value, text]) => h("option", { value }, text)),
    );
    form.input.value = (chosen === OWN && !mine) || (chosen === FOUND && !record) ? "ideal" : chosen;
    label();
  }

  /** What the record holds is asked once, when it is chosen; a refusal takes the choice back. */
  async function find(): Promise<void> {
    const isNewest = beginFind();
    sure = false;
    note.hidden = !isFound();
    if (!isFound() || !record) return;
    note.textContent = "Looking in the record...";
    try {
      const found = await controllerInRecord(record());
      if (!isNewest()) return;
      sure = true;
      note.textContent = foundWords(found, time.input.value.trim());
    } catch (error) {
      if (!isNewest()) return;
      note.textContent = `There are no settings from the record. ${sentenceOf(error)}`;
      form.input.value = mine ? OWN : "ideal";
      label();
    }
  }

  function readOwn(): { baseline: GivenController | undefined; errors: FieldError[] } {
    const { settings, errors: faults } = own.read();
    if (!settings || !mine) return { baseline: undefined, errors: faults };
    return { baseline: typedInto(mine, settings), errors: faults };
  }

  label();
  form.input.addEventListener("change", () => {
    label();
    void find();
  });

  const labels = { name, time, u, y };

  function loadLabels(units: Units | undefined, loopName: string | undefined): void {
    name.input.value = loopName ?? "";
    time.input.value = units?.time ?? "";
    u.input.value = units?.u ?? "";
    y.input.value = units?.y ?? "";
  }

  function loadBaseline(loaded: TuningRequest["baseline"]): void {
    beginFind();
    sure = loaded === FOUND;
    note.hidden = true;
    const baseline = loaded === FOUND ? undefined : loaded;
    if (baseline?.product !== undefined) {
      const { product, settings, ...spans } = baseline;
      rest = {};
      setMine(mineOfRequest({ product, ...spans }, mine), settings);
      form.input.value = OWN;
      return label();
    }
    own.load({});
    const known = baseline && FORMS.some(([id]) => id === baseline.form);
    form.input.value = known ? baseline.form : loaded === FOUND && record ? FOUND : mine && !baseline ? OWN : "ideal";
    label();
    const text = (value: unknown): string => (typeof value === "number" ? exactText(value) : "");
    names().forEach((key, index) => {
      slots[index]!.input.value = text(baseline?.[key]);
    });
    delta.input.value = text(baseline?.["delta_r"]);
    const given = baseline?.["filter"] as Filter | null | undefined;
    const filtered = given && given.type !== "none" ? given : null;
    filter.input.value = text(filtered?.Tf);
    filterType = filtered?.type ?? DEFAULT_FILTER;
    // A filter with its time has a field, and is removed when that is cleared.
    const shown = ["form", "delta_r", ...names(), ...(filtered && filter.input.value === "" ? [] : ["filter"])];
    keep(Object.fromEntries(Object.entries(baseline ?? {}).filter(([key]) => !shown.includes(key))));
  }

  const element = h(
    "section",
    { class: "card", "aria-labelledby": "today-title" },
    h("h2", { id: "today-title" }, "Today's settings ", h("span", { class: "optional" }, "optional")),
    h("p", { class: "hint" }, "The present settings of the controller: every proposal is compared with them."),
    h("div", { class: "fields" }, form.element, ...slots.map((slot) => slot.element), delta.element, filter.element),
    note,
    own.element,
    kept.element,
    h("h2", {}, "Name and units ", h("span", { class: "optional" }, "optional")),
    h("div", { class: "fields" }, name.element, time.element, u.element, y.element),
  );

  /** A unit that was not named is not sent: the service then states its assumption. */
  function unitsOf(counts: (part: string) => boolean): Units | undefined {
    const named = Object.entries({ time, u, y }).flatMap(([part, field]) => {
      const text = field.input.value.trim();
      return text !== "" && counts(part) ? [[part, text] as const] : [];
    });
    return named.length > 0 ? Object.fromEntries(named) : undefined;
  }

  const partOf = (input: EventTarget | null): string =>
    Object.entries(labels).find(([, field]) => field.input === input)?.[0] ?? BASELINE;
  const typed = typedParts(element, partOf);

  return {
    element,
    readName: () => name.input.value.trim(),
    readUnits: () => unitsOf(() => true),
    typedUnits: () => unitsOf((part) => typed.has(part)),
    setMine(next) {
      const empty = [...slots, filter, delta].every((field) => field.input.value.trim() === "");
      if (next && next.product !== mine?.product && empty && !isOwn()) {
        setMine(next);
        form.input.value = OWN;
        label();
      } else setMine(next);
    },
    read() {
      if (isFound()) return { baseline: sure ? FOUND : undefined, errors: [] };
      if (isOwn()) return readOwn();
      const typed = slots.map((slot) => slot.input.value.trim());
      // Any other field requires Kp: typed values are never ignored.
      const others = [filter, ...(form.input.value === "npid" ? [delta] : [])].map((field) => field.input.value.trim());
      if ([...typed, ...others].every((text) => text === "")) return { baseline: undefined, errors: [] };
      const faults: FieldError[] = [];
      const baseline: GivenController = { form: form.input.value, ...rest };
      names().forEach((key, index) => {
        const text = typed[index]!;
        if (text === "" && key !== "Kp") {
          if (key === "Ti") baseline[key] = null;
          return;
        }
        const parsed = parseNumber(text, key);
        if (parsed.ok) baseline[key] = parsed.value;
        else faults.push({ pointer: `/baseline/${key}`, detail: parsed.sentence });
      });
      if (baseline.form === "npid" && delta.input.value.trim() !== "") {
        const parsed = parseNumber(delta.input.value, "delta_r");
        if (parsed.ok) baseline["delta_r"] = parsed.value;
        else faults.push({ pointer: "/baseline/delta_r", detail: parsed.sentence });
      }
      if (filter.input.value.trim() !== "") {
        const parsed = parseNumber(filter.input.value, "Tf");
        if (parsed.ok) baseline["filter"] = { type: filterType, Tf: parsed.value };
        else faults.push({ pointer: "/baseline/filter/Tf", detail: parsed.sentence });
      }
      return { baseline, errors: faults };
    },
    load(units, baseline, loopName) {
      typed.forget();
      loadLabels(units, loopName);
      loadBaseline(baseline);
      onUnits();
    },
    propose(names) {
      for (const [part, text] of [["u", names.u], ["y", names.y], ["name", names.tag]] as const)
        if (text !== "" && labels[part].input.value.trim() === "") labels[part].input.value = text;
      onUnits();
    },
    offerRecord(read) {
      record = read;
      showForms();
      if (isFound()) void find();
      else if (!read) note.hidden = true;
    },
    beginLoop() {
      for (const [part, field] of Object.entries(labels)) if (!typed.has(part)) field.input.value = "";
      if (!typed.has(BASELINE)) loadBaseline(undefined);
      onUnits();
    },
    endLoop: typed.forget,
  };
}
