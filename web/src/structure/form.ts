// The form of a structure: its block diagram with the plants and controllers in it, the sliders of its limits, today's
// settings, name and units.
import type { StructureAnswer, StructureId } from "../api/structure.ts";
import { h, svgElement, svgWriter, node } from "../dom.ts";
import { choiceField, textField } from "../form/controls.ts";
import type { Control, FormErrors } from "../form/errors.ts";
import { parseNumber } from "../form/number.ts";
import { slider } from "../form/slider.ts";
import type { Slider } from "../form/slider.ts";
import { unitIn } from "../words/figure_units.ts";
import { exactText, formatNumber, unitNames } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { reachedOf, settingsOfAnswer, settingWords } from "../words/structure.ts";
import type { BlockSettings } from "../words/structure.ts";
import { layoutDiagram } from "./diagram.ts";
import { plantLine } from "./plant_line.ts";
import type { PlantLine } from "./plant_line.ts";
import { pointerOf } from "./question.ts";
import { fieldsOf, isActive, LABEL_FIELDS, STRUCTURE_SPECS } from "./structures.ts";
import type { BlockSpec, FieldSpec, Texts } from "./structures.ts";

export interface StructureForm {
  diagram: HTMLElement;
  controls: HTMLElement;
  texts(): Texts;
  show(id: StructureId, texts: Texts): void;
  /** The designed settings in their blocks, and what was reached at each limit. */
  showAnswer(answer: StructureAnswer): void;
  dispose(): void;
}

export interface StructureFormEvents {
  /** A text has changed; `held`: a slider that will be released. */
  onChange(held: boolean): void;
}

/** One field on the page. */
interface Part {
  spec: FieldSpec;
  element: HTMLElement;
  control: Control;
  plant?: PlantLine;
  slider?: Slider;
}

/** Choices that give the diagram or the form other parts. */
const REBUILDS = ["size", "arrangement", "pairing"];

export const unitsOf = (texts: Texts): UnitNames =>
  unitNames({ time: texts["units.time"] ?? "", u: texts["units.u"] ?? "", y: texts["units.y"] ?? "" });

export function structureForm(errors: FormErrors, events: StructureFormEvents): StructureForm {
  let id: StructureId = "cascade";
  let texts: Texts = {};
  let parts = new Map<string, Part>();
  let blocks: { spec: BlockSpec; element: HTMLElement; shown: HTMLElement }[] = [];
  let settings: BlockSettings[] = [];
  let width = 0;
  const drawing = svgElement(node("g"));
  const write = svgWriter(drawing);
  const svg = svgElement(node("svg", { role: "img", class: "diagram-lines" }));
  svg.append(drawing);
  const setup = h("div", { class: "diagram-setup" });
  const stage = h("div", { class: "diagram-stage" });
  const diagram = h("section", { class: "card structure-diagram", "aria-label": "Block diagram" }, setup, stage);
  const sliders = h("div", { class: "sliders" });
  const others = h("div", { class: "fields" });
  const today = h("div", { class: "stack" });
  const todayBox = h("details", {}, h("summary", {}, "Today's settings, for comparison"), today);
  const labels = h("div", { class: "fields" });
  const controls = h(
    "section",
    { class: "card structure-controls", "aria-label": "Limits" },
    h("h2", {}, "Limits"),
    sliders,
    others,
    todayBox,
    h("details", {}, h("summary", {}, "Name and units"), labels),
  );

  const spoken = (spec: FieldSpec, value: number): string => [spec.label, formatNumber(value), unitIn(spec.unit ?? "", unitsOf(texts))].filter(Boolean).join(" ");

  function take(spec: FieldSpec, text: string, held = false): void {
    if (texts[spec.key] === text && !spec.slider) return;
    texts = { ...texts, [spec.key]: text };
    if (REBUILDS.includes(spec.key)) return rebuild(spec.key);
    if (spec.kind === "choice" && text === "given") prefill(spec);
    if (spec.key.startsWith("units.")) setUnits();
    fit();
    events.onChange(held);
  }

  function rebuild(key: string): void {
    show(id, texts);
    parts.get(key)?.control.input.focus();
    events.onChange(false);
  }

  /** A given controller begins with what was designed. */
  function prefill({ key, givenAt }: FieldSpec): void {
    for (const { spec } of blocks) {
      const given = spec.fields.find((name) => name === givenAt || name.startsWith(`${givenAt}.`));
      const found = settings.find(({ block }) => block === spec.id)?.settings ?? [];
      const part = given === undefined || given === key ? undefined : parts.get(given);
      if (!part || texts[given!] || found.length === 0) continue;
      const text = part.spec.kind === "fraction" ? found[0]!.exact : found.map(({ name, exact }) => `${name} ${exact}`).join(", ");
      texts = { ...texts, [given!]: text };
      part.control.input.value = text;
    }
  }

  function sliderPart(spec: FieldSpec): Part {
    const { from, to, log = false, step, low, high, relative } = spec.slider!;
    const unit = unitIn(spec.unit ?? "", unitsOf(texts));
    const clear = (): void => {
      made.set(null);
      take(spec, "");
    };
    const made: Slider = slider(
      {
        label: spec.label,
        unit,
        ...(spec.hint ? { hint: spec.hint } : {}),
        log,
        ...(step === undefined ? {} : { step }),
        ends: [low, high],
        unset: spec.placeholder ?? "default",
        pointer: () => pointerOf(spec.key),
        spoken: (value) => spoken(spec, value),
        onMove: (value) => take(spec, exactText(value), true),
        onRelease: (value) => take(spec, exactText(value)),
        ...(spec.optional ? { onHome: clear } : {}),
      },
      errors,
    );
    // An empty field is no number for the slider, but leaves an optional limit out.
    made.element.addEventListener(
      "change",
      (event) => {
        if (!spec.optional || event.target !== made.field.input || made.field.input.value.trim() !== "") return;
        event.stopPropagation();
        errors.settle(made.field.control);
        clear();
      },
      true,
    );
    const parsed = parseNumber(texts[spec.key] ?? "", spec.label);
    const value = parsed.ok ? parsed.value : null;
    const about = relative ? Math.abs(value || 1) : 1;
    made.setLimits(from * about, to * about);
    made.set(value);
    return { spec, element: made.element, control: made.field.control, slider: made };
  }

  function partOf(spec: FieldSpec, bare: boolean): Part {
    const options = {
      label: spec.label,
      bare,
      value: texts[spec.key] ?? "",
      unit: unitIn(spec.unit ?? "", unitsOf(texts)),
      ...(spec.hint && !bare ? { hint: spec.hint } : {}),
      ...(spec.placeholder ? { placeholder: spec.placeholder } : {}),
      pointer: () => (isActive(spec, texts) ? pointerOf(spec.key) : null),
    };
    if (spec.kind === "choice") {
      const { element, input, control } = choiceField({ ...options, choices: spec.choices ?? [] }, errors);
      input.addEventListener("change", () => take(spec, input.value));
      return { spec, element, control };
    }
    if (spec.kind === "plant") {
      const plant = plantLine(spec, errors, () => unitsOf(texts).time);
      const { input, control } = plant.field;
      input.value = texts[spec.key] ?? "";
      input.addEventListener("change", () => take(spec, input.value));
      plant.read(unitsOf(texts).time);
      return { spec, element: h("div", { class: "plant-line" }, plant.elements), control, plant };
    }
    const { element, input, control } = textField(options, errors);
    input.addEventListener("change", () => take(spec, input.value));
    return { spec, element, control };
  }

  /** Fields that belong to the choice above them are shown only with it. */
  function fit(): void {
    for (const { spec, element } of parts.values()) element.hidden = !isActive(spec, texts);
    for (const { spec, shown } of blocks) {
      const designed = settings.find(({ block }) => block === spec.id);
      const given = spec.fields.some((key) => ["controller", "fraction"].includes(parts.get(key)!.spec.kind) && isActive(parts.get(key)!.spec, texts));
      shown.hidden = given || !designed;
      shown.textContent = designed ? settingWords(designed.settings) : "";
    }
  }

  function setUnits(): void {
    const units = unitsOf(texts);
    for (const { plant } of parts.values()) plant?.read(units.time);
    // Labels name their units.
    if (!controls.contains(document.activeElement)) show(id, texts);
  }

  /** The blocks take their places, and the lines are drawn between them. */
  function arrange(): void {
    if (width === 0) return;
    const plan = layoutDiagram(id, texts, width);
    stage.classList.toggle("listed", plan === null);
    svg.setAttribute("visibility", plan ? "visible" : "hidden");
    stage.style.height = plan ? `${plan.height}px` : "";
    stage.style.width = plan ? `${plan.width}px` : "";
    for (const { spec, element } of blocks) {
      const box = plan?.boxes[spec.id];
      for (const [name, value] of [["left", box?.x], ["top", box?.y], ["width", box?.width], ["height", box?.height]] as const)
        element.style[name] = value === undefined ? "" : `${value}px`;
    }
    if (!plan) return;
    for (const [name, value] of [["width", plan.width], ["height", plan.height], ["viewBox", `0 0 ${plan.width} ${plan.height}`]] as const) svg.setAttribute(name, String(value));
    write(plan.drawing);
  }

  function clear(): void {
    for (const { control, plant } of parts.values()) {
      plant?.dispose();
      errors.remove(control);
    }
    parts = new Map();
    blocks = [];
  }

  function show(next: StructureId, given: Texts): void {
    if (next !== id) settings = [];
    id = next;
    texts = given;
    clear();
    const spec = STRUCTURE_SPECS[id];
    const fields = fieldsOf(id, texts);
    const blockSpecs = spec.blocks(texts);
    const inBlock = (key: string): BlockSpec | undefined => blockSpecs.find((block) => block.fields.includes(key));
    for (const field of fields) {
      const block = inBlock(field.key);
      const labelled = block !== undefined && field.kind === "number";
      parts.set(field.key, field.slider ? sliderPart(field) : partOf(field, block !== undefined && !labelled));
    }
    const listed = (keep: (field: FieldSpec) => boolean): HTMLElement[] => fields.filter((field) => !inBlock(field.key) && keep(field)).map(({ key }) => parts.get(key)!.element);
    const isToday = ({ key }: FieldSpec): boolean => key.startsWith("baseline");
    const isLabel = ({ key }: FieldSpec): boolean => LABEL_FIELDS.some((label) => label.key === key);
    setup.replaceChildren(...listed(({ kind }) => kind === "choice"));
    setup.hidden = setup.childElementCount === 0;
    sliders.replaceChildren(...listed((field) => field.slider !== undefined));
    others.replaceChildren(...listed((field) => !field.slider && field.kind !== "choice" && !isToday(field) && !isLabel(field)));
    today.replaceChildren(...listed(isToday));
    todayBox.hidden = today.childElementCount === 0;
    labels.replaceChildren(...listed(isLabel));
    blocks = blockSpecs.map((block) => {
      const shown = h("p", { class: "block-settings", hidden: true });
      const inside = block.fields.map((key) => parts.get(key)!);
      const cell = ({ spec: { label }, element }: Part): HTMLElement => h("div", { class: "cell" }, h("p", {}, label), element);
      const element =
        block.id === "matrix"
          ? h("div", { class: "block matrix", role: "group", "aria-label": "Plants", "data-size": texts["size"] }, inside.map(cell))
          : h("div", { class: "block", role: "group", "aria-label": block.title }, h("p", { class: "block-title" }, block.title), h("div", { class: "block-fields" }, inside.map((part) => part.element)), shown);
      return { spec: block, element, shown };
    });
    svg.setAttribute("aria-label", `${spec.title}: block diagram with the signals between the fields`);
    stage.replaceChildren(svg, ...blocks.map(({ element }) => element));
    arrange();
    fit();
  }

  const observer = new ResizeObserver(([entry]) => {
    const now = Math.floor(entry!.contentRect.width);
    if (now === width || now === 0) return;
    width = now;
    // Not at once: a scroll bar that comes with the new height would call again.
    requestAnimationFrame(arrange);
  });
  observer.observe(setup.parentElement!);

  return {
    diagram,
    controls,
    texts: () => texts,
    show,
    showAnswer(answer) {
      settings = settingsOfAnswer(answer, unitsOf(texts));
      const reached = reachedOf(answer);
      for (const { spec, slider: moved } of parts.values()) {
        const value = reached[spec.key];
        moved?.setReached(typeof value === "number" ? `reached ${formatNumber(value)}` : "", false);
        if (answer.structure === "cascade" && spec.key === "limits.Ms_valve") moved!.field.input.placeholder = formatNumber(answer.Ms_valve_limit);
      }
      fit();
    },
    dispose() {
      observer.disconnect();
      clear();
    },
  };
}
