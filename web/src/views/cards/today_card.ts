// Today's settings, typed or from the record, and the loop's name and units: all optional.
import { sentenceOf } from "../../api/client.ts";
import { newest } from "../../api/latest.ts";
import { getProduct } from "../../api/products.ts";
import { controllerInRecord } from "../../api/records.ts";
import type { FieldError, Filter, GivenController, RecordedTest, SettingValue, TuningRequest, Units } from "../../api/types.ts";
import { foldingCard, h, uniqueId } from "../../dom.ts";
import { choiceField, textField } from "../../form/controls.ts";
import { openAround } from "../../form/errors.ts";
import type { FormErrors } from "../../form/errors.ts";
import { keptNote, objectOf } from "../../form/kept_note.ts";
import { parseNumber } from "../../form/number.ts";
import { productFields } from "../../form/product_fields.ts";
import { typedParts } from "../../form/typed.ts";
import { implementOf, mineOfRequest, typedInto } from "../../my_controller.ts";
import type { MyController } from "../../my_controller.ts";
import { exactText } from "../../words/numbers.ts";
import { foundWords } from "../../words/found.ts";
import { sameRecord } from "../../words/record_names.ts";
import type { RecordNames } from "../../words/record_names.ts";

export interface TodayCard {
  element: HTMLElement;
  /** Name and units of the loop. */
  names: HTMLElement;
  /** Undefined: none is named. */
  readUnits(): Units | undefined;
  /** The units that were typed since the loop began. */
  typedUnits(): Units | undefined;
  read(): { baseline: TuningRequest["baseline"]; errors: FieldError[] };
  load(units: Units | undefined, baseline: TuningRequest["baseline"], name: string | undefined): void;
  readName(): string;
  /** Everything as typed, by names for an address. */
  texts(): Record<string, string>;
  setTexts(texts: Record<string, string>): void;
  /** Names from a file: shown in fields in which nothing was typed. Without reporting. */
  propose(names: RecordNames): void;
  /** The record in which today's settings can be found; null: there is none, or not of a loop. `ask`: at once;
      settings that are certain are then taken where none are typed. */
  offerRecord(read: (() => RecordedTest) | null, ask?: boolean): void;
  /** Resolves when the service has answered about the record. */
  settled(): Promise<void>;
  /** A new loop: values that were filled in, or belonged to the previous loop, are cleared; values typed for this
      one stay. */
  beginLoop(): void;
  /** The displayed values belong to this loop: they must be typed again for the next one. */
  endLoop(): void;
  /** The user's own controller, which adds a form of its own. */
  setMine(mine: MyController | null): void;
}

const DEFAULT_FILTER = "derivative";

const IN_RECORD = "The record is that of a loop: today's settings may be found in it.";

/** Instead of a form: the settings as typed into the user's own controller. */
const OWN = "own";

/** Instead of settings: those that moved u in the record. */
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
  for (const field of [time, u, y])
    field.input.addEventListener("change", () => {
      onUnits();
      askAgain();
    });

  const form = choiceField({ label: "Form", choices: FORMS, pointer: () => "/baseline/form" }, errors);
  const slots = (["first", "second", "third"] as const).map((_, index) =>
    textField({ label: "", pointer: () => `/baseline/${names()[index]}` }, errors),
  );
  const filter = textField(
    { label: "Tf", hint: "filter", pointer: () => "/baseline/filter/Tf" },
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
  const said = h("p", { role: "status" });
  const take = h("input", { type: "checkbox", id: uniqueId("found") });
  const offer = h("div", { class: "check" }, take, h("label", { for: take.id }, "Use as today's settings"));
  const fromRecord = h("div", { class: "from-record", hidden: true }, said, offer);
  const beginFind = newest();
  /** The last question to the service. */
  let asked: { record: RecordedTest; rest: string } | null = null;
  let sure = false;
  let finding: Promise<void> = Promise.resolve();
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
  const isFound = (): boolean => record !== null && take.checked;

  function label(): void {
    fromRecord.hidden = record === null;
    if (record) openAround(fromRecord);
    typedFields.hidden = isFound();
    own.element.hidden = !isOwn() || isFound();
    form.element.classList.toggle("wide", isOwn());
    for (const field of [...slots, filter]) field.element.hidden = isOwn();
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
    const chosen = form.input.value;
    const own = mine ? [[OWN, mine.name] as const] : [];
    form.input.replaceChildren(...[...FORMS, ...own].map(([value, text]) => h("option", { value }, text)));
    form.input.value = chosen === OWN && !mine ? "ideal" : chosen;
    label();
    showProduct(settings);
  }

  const isEmpty = (): boolean =>
    own.isEmpty() && [...slots, filter, delta].every((field) => field.input.value.trim() === "");

  function none(reason: string): void {
    said.textContent = `There are no settings from the record. ${reason}`.trimEnd();
    take.checked = false;
  }

  /** Asks once for each record and controller; without settings the choice is taken back. */
  async function find(): Promise<void> {
    const implement = implementOf(mine);
    const units = unitsOf(() => true);
    const question = { record: record!(), rest: JSON.stringify([implement, units]) };
    if (asked && asked.rest === question.rest && sameRecord(asked.record, question.record)) return;
    asked = question;
    const isNewest = beginFind();
    sure = false;
    offer.hidden = true;
    said.textContent = "Looking for today's settings in the record…";
    try {
      const found = await controllerInRecord(question.record, implement, units);
      const product = implement ? await getProduct(implement.product) : null;
      if (!isNewest()) return;
      const { identified } = found;
      if (!identified) none(found.not_identified ?? "");
      else {
        sure = true;
        said.textContent = foundWords({ ...found, identified }, product, time.input.value.trim() || "s");
        offer.hidden = false;
        if (identified.certain && isEmpty() && !typed.has(BASELINE)) take.checked = true;
      }
    } catch (error) {
      if (!isNewest()) return;
      none(sentenceOf(error));
    }
    label();
  }

  const ask = (): void => {
    finding = find();
  };

  /** Another controller, or units, make other words of the same settings. */
  function askAgain(): void {
    if (record && sure && asked) ask();
  }

  take.addEventListener("change", () => {
    label();
    if (isFound()) ask();
  });

  function readOwn(): { baseline: GivenController | undefined; errors: FieldError[] } {
    const { settings, errors: faults } = own.read();
    if (!settings || !mine) return { baseline: undefined, errors: faults };
    return { baseline: typedInto(mine, settings), errors: faults };
  }

  form.input.addEventListener("change", label);

  const labels = { name, time, u, y };

  function loadLabels(units: Units | undefined, loopName: string | undefined): void {
    name.input.value = loopName ?? "";
    time.input.value = units?.time ?? "";
    u.input.value = units?.u ?? "";
    y.input.value = units?.y ?? "";
  }

  function loadBaseline(loaded: TuningRequest["baseline"]): void {
    beginFind();
    asked = null;
    sure = take.checked = loaded === FOUND;
    said.textContent = IN_RECORD;
    offer.hidden = false;
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
    form.input.value = known ? baseline.form : mine && !baseline ? OWN : "ideal";
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

  const typedFields = h(
    "div",
    { class: "fields today-fields" },
    form.element,
    slots.map((slot) => slot.element),
    delta.element,
    filter.element,
  );
  const element = foldingCard(
    "Today's settings",
    "optional, for comparison",
    true,
    fromRecord,
    typedFields,
    own.element,
    kept.element,
  );
  const loop = foldingCard(
    "Name and units",
    "optional",
    // On a phone it would push the cards of the process further down.
    !window.matchMedia("(max-width: 700px)").matches,
    h("div", { class: "fields names" }, name.element, time.element, u.element, y.element),
  );
  label();

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
  const typed = typedParts([element, loop], partOf);

  /** The fields of today's settings by their names, whatever the form. */
  const inputs = (): Record<string, HTMLInputElement> => ({
    ...Object.fromEntries(slots.map((slot, index) => [`today.${index + 1}`, slot.input])),
    "today.Tf": filter.input,
    "today.delta_r": delta.input,
    ...Object.fromEntries(Object.entries(labels).map(([part, field]) => [`loop.${part}`, field.input])),
  });
  const OWN_TEXT = "today.set.";

  return {
    element,
    names: loop,
    texts: () => ({
      ...Object.fromEntries(Object.entries(inputs()).map(([key, input]) => [key, input.value.trim()])),
      ...Object.fromEntries(Object.entries(own.texts()).map(([key, text]) => [OWN_TEXT + key, text.trim()])),
      "today.form": form.input.value,
      "today.rest": Object.keys(rest).length > 0 ? JSON.stringify(rest) : "",
      "today.record": take.checked ? "yes" : "",
      "today.typed": typed.list().join(" "),
    }),
    setTexts(texts) {
      for (const [key, input] of Object.entries(inputs())) input.value = texts[key] ?? "";
      const settings = Object.entries(texts).filter(([key]) => key.startsWith(OWN_TEXT));
      own.setTexts(Object.fromEntries(settings.map(([key, text]) => [key.slice(OWN_TEXT.length), text])));
      const known = [...form.input.options].some(({ value }) => value === texts["today.form"]);
      form.input.value = known ? texts["today.form"]! : "ideal";
      rest = objectOf(texts["today.rest"]);
      sure = take.checked = texts["today.record"] === "yes";
      asked = null;
      typed.forget();
      typed.note((texts["today.typed"] ?? "").split(" ").filter(Boolean));
      label();
      onUnits();
    },
    readName: () => name.input.value.trim(),
    readUnits: () => unitsOf(() => true),
    typedUnits: () => unitsOf((part) => typed.has(part)),
    setMine(next) {
      if (next && next.product !== mine?.product && isEmpty() && !isOwn()) {
        setMine(next);
        form.input.value = OWN;
        label();
      } else setMine(next);
      askAgain();
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
    },
    offerRecord(read, now = false) {
      record = read;
      label();
      if (read && (now || isFound())) ask();
    },
    settled: () => finding,
    beginLoop() {
      for (const [part, field] of Object.entries(labels)) if (!typed.has(part)) field.input.value = "";
      if (!typed.has(BASELINE)) loadBaseline(undefined);
      onUnits();
    },
    endLoop: typed.forget,
  };
}
