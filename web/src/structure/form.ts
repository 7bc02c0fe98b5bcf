// The form of a structure: its block diagram with the plants and controllers in it, the sliders of its limits, today's
// settings, name and units.
import type { StructureAnswer, StructureId } from "../api/structure.ts";
import { h, node, svgElement, svgWriter } from "../dom.ts";
import { choiceField, textField } from "../form/controls.ts";
import type { Field } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
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
import { fieldsOf, isActive, LABEL_FIELDS, SAMPLED, STRUCTURE_SPECS } from "./structures.ts";
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

/** One field on the page. */
interface Part {
  spec: FieldSpec;
  element: HTMLElement;
  field: Field<HTMLInputElement> | Field<HTMLSelectElement>;
  plant?: PlantLine;
  slider?: Slider;
}

interface BlockPart {
  spec: BlockSpec;
  element: HTMLElement;
  /** The designed settings. */
  shown: HTMLElement;
}

export const unitsOf = (texts: Texts): UnitNames => unitNames({ time: texts["units.time"] ?? "", u: texts["units.u"] ?? "", y: texts["units.y"] ?? "" });

/** `onChange`: a text has changed; `held`: by a slider that will be released. */
export function structureForm(errors: FormErrors, onChange: (held: boolean) => void): StructureForm {
  let id: StructureId = "cascade";
  let texts: Texts = {};
  let parts = new Map<string, Part>();
  let blocks: BlockPart[] = [];
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
  const sampled = h("div", { class: "fields" });
  const sampledBox = h("details", {}, h("summary", {}, "Call by call, with limits"), sampled);
  const labels = h("div", { class: "fields" });
  const labelBox = h("details", {}, h("summary", {}, "Name and units"), labels);
  const controls = h("section", { class: "card structure-controls", "aria-label": "Limits" }, h("h2", {}, "Limits"), sliders, others, todayBox, sampledBox, labelBox);

  const unitOf = ({ unit = "" }: FieldSpec): string => unitIn(unit, unitsOf(texts));

  function take(spec: FieldSpec, text: string, held = false): void {
    if (texts[spec.key] === text && !spec.slider) return;
    texts = { ...texts, [spec.key]: text };
    if (spec.key === "size") {
      show(id, texts);
      parts.get("size")!.field.input.focus();
    } else if (spec.kind === "choice") arrange();
    if (spec.kind === "choice" && text === "given") prefill(spec);
    if (spec.key.startsWith("units."))
      for (const part of parts.values()) {
        part.field.setUnit(unitOf(part.spec));
        part.plant?.read(unitsOf(texts).time);
      }
    fit();
    onChange(held);
  }

  /** A given controller begins with what was designed. */
  function prefill({ givenAt }: FieldSpec): void {
    for (const { spec } of blocks) {
      const key = spec.fields.find((name) => name === givenAt || name.startsWith(`${givenAt}.`));
      const designed = settings.find(({ block }) => block === spec.id)?.settings ?? [];
      if (key === undefined || texts[key] || designed.length === 0) continue;
      const { field, spec: of } = parts.get(key)!;
      const text = of.kind === "fraction" ? designed[0]!.exact : designed.map(({ name, exact }) => `${name} ${exact}`).join(", ");
      texts = { ...texts, [key]: text };
      field.input.value = text;
    }
  }

  function sliderPart(spec: FieldSpec): Part {
    const { from, to, log = false, step, low, high, relative } = spec.slider!;
    const clear = (): void => {
      made.set(null);
      take(spec, "");
    };
    const made: Slider = slider(
      {
        label: spec.label,
        unit: unitOf(spec),
        ...(spec.hint ? { hint: spec.hint } : {}),
        log,
        ...(step === undefined ? {} : { step }),
        ends: [low, high],
        unset: spec.placeholder ?? "default",
        pointer: () => (isActive(spec, texts) ? pointerOf(spec.key) : null),
        spoken: (value) => [spec.label, formatNumber(value), unitOf(spec)].filter(Boolean).join(" "),
        onMove: (value) => take(spec, exactText(value), true),
        onRelease: (value) => take(spec, exactText(value)),
        ...(spec.optional ? { onHome: clear } : {}),
      },
      errors,
    );
    // An empty field is no number for the slider, but leaves an optional limit out.
    const empty = (event: Event): void => {
      if (!spec.optional || event.target !== made.field.input || made.field.input.value.trim() !== "") return;
      event.stopPropagation();
      clear();
    };
    made.element.addEventListener("change", empty, true);
    const parsed = parseNumber(texts[spec.key] ?? "", spec.label);
    const about = relative && parsed.ok ? Math.abs(parsed.value) || 1 : 1;
    made.setLimits(from * about, to * about);
    made.set(parsed.ok ? parsed.value : null);
    return { spec, element: made.element, field: made.field, slider: made };
  }

  /** `bare`: the block around it says what it is. */
  function partOf(spec: FieldSpec, bare: boolean): Part {
    const value = texts[spec.key] ?? "";
    const { label, hint, placeholder, choices = [] } = spec;
    const pointer = (): string | null => (isActive(spec, texts) ? pointerOf(spec.key) : null);
    const options = { label, bare, value, unit: unitOf(spec), ...(hint ? { hint } : {}), ...(placeholder ? { placeholder } : {}), pointer };
    const plant = spec.kind === "plant" ? plantLine(spec, value, errors, () => unitsOf(texts).time) : undefined;
    const field = plant?.field ?? (spec.kind === "choice" ? choiceField({ ...options, choices }, errors) : textField(options, errors));
    field.input.addEventListener("change", () => take(spec, field.input.value));
    return { spec, element: plant?.element ?? field.element, field, ...(plant ? { plant } : {}) };
  }

  /** Fields that belong to a choice are shown only with it. */
  function fit(): void {
    for (const { spec, element } of parts.values()) element.hidden = !isActive(spec, texts);
    for (const { spec, shown } of blocks) {
      const designed = settings.find(({ block }) => block === spec.id);
      const given = spec.fields.map((key) => parts.get(key)!).some(({ spec: of, element }) => (of.kind === "controller" || of.kind === "fraction") && !element.hidden);
      shown.hidden = given || !designed;
      shown.textContent = designed ? settingWords(designed.settings) : "";
    }
  }

  /** The blocks take their places, and the lines are drawn between them. */
  function arrange(): void {
    if (width === 0) return;
    const plan = layoutDiagram(id, texts, width);
    const place = (element: HTMLElement, box: object | undefined): void => {
      const lengths = Object.entries(box ?? { left: "", top: "", width: "", height: "" }) as [string, number | ""][];
      for (const [name, length] of lengths) element.style.setProperty(name, length === "" ? "" : `${length}px`);
    };
    stage.classList.toggle("listed", plan === null);
    place(stage, plan ? { width: plan.width, height: plan.height } : undefined);
    for (const { spec, element } of blocks) place(element, plan?.boxes[spec.id]);
    if (!plan) return;
    for (const [name, value] of Object.entries({ width: plan.width, height: plan.height, viewBox: `0 0 ${plan.width} ${plan.height}` })) svg.setAttribute(name, String(value));
    write(plan.drawing);
  }

  function clear(): void {
    for (const { field, plant } of parts.values()) {
      plant?.dispose();
      errors.remove(field.control);
    }
    parts = new Map();
  }

  function show(next: StructureId, given: Texts): void {
    [id, texts, settings] = [next, given, []];
    clear();
    const spec = STRUCTURE_SPECS[id];
    const fields = fieldsOf(id, texts);
    const blockSpecs = spec.blocks(texts);
    const inBlock = ({ key }: FieldSpec): boolean => blockSpecs.some((block) => block.fields.includes(key));
    for (const field of fields) parts.set(field.key, field.slider ? sliderPart(field) : partOf(field, inBlock(field) && field.kind !== "number"));
    /** The part of the page for a field outside the blocks. */
    const homeOf = (field: FieldSpec): HTMLElement => {
      if (field.kind === "choice") return setup;
      if (field.slider) return sliders;
      if (LABEL_FIELDS.includes(field)) return labels;
      if (field.key.startsWith(SAMPLED)) return sampled;
      return field.key.startsWith("baseline") ? today : others;
    };
    for (const home of [setup, sliders, others, today, sampled, labels]) home.replaceChildren();
    for (const field of fields) if (!inBlock(field)) homeOf(field).append(parts.get(field.key)!.element);
    setup.hidden = setup.childElementCount === 0;
    todayBox.hidden = today.childElementCount === 0;
    blocks = blockSpecs.map((block) => blockPart(block));
    svg.setAttribute("aria-label", `${spec.title}: block diagram with the signals between the fields`);
    stage.replaceChildren(svg, ...blocks.map(({ element }) => element));
    arrange();
    fit();
  }

  function blockPart(spec: BlockSpec): BlockPart {
    const shown = h("p", { class: "block-settings", hidden: true });
    const inside = spec.fields.map((key) => parts.get(key)!);
    const content =
      spec.id === "matrix"
        ? inside.map((part) => h("div", { class: "cell" }, h("div", { class: "block-head" }, h("p", {}, part.spec.label), part.plant?.choose), part.element))
        : [h("div", { class: "block-head" }, h("p", { class: "block-title" }, spec.title), inside.map(({ plant }) => plant?.choose)), h("div", { class: "block-fields" }, inside.map(({ element }) => element)), shown];
    const element = h("div", { class: `block ${spec.id}`, role: "group", "aria-label": spec.title, "data-size": texts["size"] }, content);
    return { spec, element, shown };
  }

  const observer = new ResizeObserver(([entry]) => {
    const now = Math.floor(entry!.contentRect.width);
    if (now === width || now === 0) return;
    width = now;
    // Not at once: a scroll bar that comes with the new height would call again.
    requestAnimationFrame(arrange);
  });
  observer.observe(diagram);

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
