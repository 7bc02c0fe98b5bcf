// Typed texts of a structure to its request, and back. No DOM.
import type { StructureId, StructureQuestion, StructureRequest } from "../api/structure.ts";
import type { FieldError, Plant } from "../api/types.ts";
import { parseNumber, parseNumbers } from "../form/number.ts";
import { exactText } from "../words/numbers.ts";
import { fieldsOf, isActive, SAMPLED, STRUCTURE_SPECS } from "./structures.ts";
import type { FieldSpec, Texts } from "./structures.ts";

/** The text for parts of a request without a field: their values by their paths. */
const REST = "rest";

export const pointerOf = (key: string): string => `/${key.replaceAll(".", "/")}`;

type Box = Record<string, unknown> | unknown[];

const get = (box: unknown, key: string): unknown =>
  key.split(".").reduce<unknown>((part, name) => (part as Record<string, unknown> | null | undefined)?.[name], box);

function set(box: Box, key: string, value: unknown): void {
  const names = key.split(".");
  const last = names.pop()!;
  let at = box as Record<string, unknown>;
  names.forEach((name, index) => {
    const next = names[index + 1] ?? last;
    at[name] ??= /^\d+$/.test(next) ? [] : {};
    at = at[name] as Record<string, unknown>;
  });
  at[last] = value;
}

const PID = ["Kp", "Ti", "Td", "Tf", "b"];
const FILTER = "measurement_second_order";
const SETTING = /([A-Za-z]+)\s*[=:]?\s*([+\-−]?[\d.,]+(?:e[+-]?\d+)?)/gi;

type Read = { value: unknown } | { sentence: string };

/** "Kp 0.65, Ti 2.8, Td 0.4, Tf 0.1": settings in the ideal form, or those of `parameters`; any other controller as JSON. */
export function parseSettings(text: string, parameters: readonly string[] = PID): Read {
  if (text.trim().startsWith("{"))
    try {
      return { value: JSON.parse(text) as unknown };
    } catch {
      return { sentence: "This is not JSON. Write a controller as in the API, or its settings in the ideal form." };
    }
  const values: Record<string, number> = {};
  const example = `Write ${parameters.map((name, index) => `${name} ${[0.65, 2.8, 0.4, 0.1, 1][index]}`).slice(0, 2).join(", ")} for example.`;
  const rest = text.replace(SETTING, (_, name: string, number: string) => {
    const known = parameters.find((candidate) => candidate.toLowerCase() === name.toLowerCase());
    const parsed = parseNumber(number.replace(/[.,]+$/, ""), name);
    if (!known || !parsed.ok) return name;
    values[known] = parsed.value;
    return "";
  });
  const odd = rest.replace(/[\s,;]+/g, " ").trim();
  if (odd !== "") return { sentence: `"${odd}" is not one of ${parameters.join(", ")} with a number. ${example}` };
  const first = parameters[0]!;
  if (values[first] === undefined) return { sentence: `${first} is missing. ${example}` };
  const { Tf, ...settings } = values;
  return { value: Tf === undefined ? settings : { ...settings, filter: { type: FILTER, Tf } } };
}

/** Settings as they are typed; "" for none. */
export function settingsLine(settings: object, parameters: readonly string[] = PID): string {
  const { form = "ideal", c = 0, filter, action: _action, ...rest } = settings as Record<string, unknown> & { filter?: { type?: string; Tf?: number } };
  const { type = "none", Tf, ...others } = filter ?? {};
  const known = Object.keys(rest).every((name) => parameters.includes(name)) && Object.keys(others).length === 0;
  if (form !== "ideal" || c !== 0 || !known || (type !== "none" && type !== FILTER)) return JSON.stringify(settings);
  const all: Record<string, unknown> = type === FILTER ? { ...rest, Tf } : rest;
  const usual: Record<string, number> = { Td: 0, b: 1, Lf: 0 };
  return parameters.flatMap((name) => (typeof all[name] === "number" && all[name] !== usual[name] ? [`${name} ${exactText(all[name])}`] : [])).join(", ");
}

function parseFraction(text: string, label: string): Read {
  const [above = "", below = "1", ...more] = text.split("/");
  const num = parseNumbers(above, label);
  const den = parseNumbers(below, label);
  if (more.length > 0 || !num.ok || !den.ok) return { sentence: `${label}: write the coefficients of s in descending powers, such as 40.2 1 / 349 0.` };
  return { value: { num: num.value, den: den.value } };
}

function parseField(spec: FieldSpec, text: string): Read {
  switch (spec.kind) {
    case "number": {
      const parsed = parseNumber(text, spec.label);
      return parsed.ok ? { value: parsed.value } : parsed;
    }
    case "numbers": {
      const parsed = parseNumbers(text, spec.label);
      return parsed.ok ? { value: parsed.value } : parsed;
    }
    case "controller":
      return parseSettings(text, spec.parameters);
    case "fraction":
      return parseFraction(text, spec.label);
    case "plant":
      return text.trim() === "" ? { sentence: `${spec.label} is empty. Write a plant, such as 2 e^(-8s)/(30s+1).` } : { value: text.trim() === "0" ? 0 : text.trim() };
    case "text":
      return { value: text.trim() };
    case "choice":
      return { value: spec.key === "pairing" ? text.split(" ").map(Number) : text };
  }
}

/** Choices that decide which fields are part of the request, and are none of its members. */
const isMember = ({ key, kind }: FieldSpec, text: string): boolean =>
  kind !== "choice" || !(text === "given" || text === "design" || text === "" || key === "size");

/** The fields next to a path leave that part out of the request: settings are given, or there is no run. */
function isLeftOut(path: string, specs: readonly FieldSpec[], texts: Texts): boolean {
  const part = path.slice(0, path.lastIndexOf(".") + 1);
  if (part.startsWith(SAMPLED) && !texts[`${SAMPLED}sample_time`]?.trim()) return true;
  return part !== "" && specs.some(({ key }) => key.startsWith(part) && texts[key] === "given");
}

export function readQuestion(id: StructureId, texts: Texts): { question: StructureQuestion; errors: FieldError[] } {
  const errors: FieldError[] = [];
  const specs = fieldsOf(id, texts);
  const request: StructureRequest = { ...STRUCTURE_SPECS[id].fixed };
  for (const [path, value] of Object.entries(JSON.parse(texts[REST] || "{}") as object)) if (!isLeftOut(path, specs, texts)) set(request, path, value);
  for (const spec of specs) {
    const text = texts[spec.key] ?? "";
    if (!isActive(spec, texts) || !isMember(spec, text) || (spec.optional && text.trim() === "")) continue;
    const read = parseField(spec, text);
    if ("sentence" in read) errors.push({ pointer: pointerOf(spec.key), detail: read.sentence });
    else set(request, spec.key, read.value);
  }
  return { question: { id, request }, errors };
}

/** A choice that the texts leave open, and the answers to plants that only the service can write. */
const firstChoice = ({ choices }: FieldSpec): string => choices?.[0]?.[0] ?? "";

function writeField(spec: FieldSpec, request: StructureRequest): string {
  const value = get(request, spec.key);
  if (spec.kind === "choice") {
    const given = spec.givenAt ? get(request, spec.givenAt) : undefined;
    if (typeof given === "object" && given !== null && !("tune" in given)) return "given";
    if (spec.key === "pairing") return Array.isArray(value) ? value.join(" ") : "";
    return typeof value === "string" ? value : firstChoice(spec);
  }
  if (value === undefined || value === null) return spec.kind === "plant" && !spec.optional && value === null ? "0" : "";
  if (typeof value === "number") return exactText(value);
  if (typeof value === "string") return value;
  if (spec.kind === "numbers") return (value as number[]).map(exactText).join(" ");
  if (spec.kind === "controller") return "tune" in (value as object) ? "" : settingsLine(value, spec.parameters);
  if (spec.kind === "fraction") {
    const { num, den } = value as { num: number[]; den: number[] };
    return `${num.map(exactText).join(" ")} / ${den.map(exactText).join(" ")}`;
  }
  return "";
}

/** Terms on which a job is run, and what the page itself adds. */
const NOT_TYPED = ["structure", "evaluate", "implement", "notify", "priority", "timeout_s", "compare"];

/** The parts that no field shows, with their paths. A list that fields show has none. */
const partsWithoutField = (part: object, specs: readonly FieldSpec[], before = ""): [path: string, value: unknown][] =>
  Object.entries(part).flatMap(([name, value]): [string, unknown][] => {
    const path = before + name;
    if (specs.some(({ key }) => key === path)) return [];
    if (!specs.some(({ key }) => key.startsWith(`${path}.`))) return [[path, value]];
    return typeof value === "object" && value !== null && !Array.isArray(value) ? partsWithoutField(value, specs, `${path}.`) : [];
  });

/** The texts that show a request. Plants that are objects are left out: see `objectPlants`. */
export function textsOf(id: StructureId, request: StructureRequest): Texts {
  const size = Array.isArray(request["plant"]) && request["plant"].length === 3 ? "3" : "2";
  const texts: Texts = id === "interaction" ? { size } : {};
  const specs = fieldsOf(id, texts);
  for (const spec of specs) if (spec.key !== "size") texts[spec.key] = writeField(spec, request);
  const rest = Object.fromEntries(partsWithoutField(request, specs).filter(([path]) => !NOT_TYPED.includes(path)));
  if (Object.keys(rest).length > 0) texts[REST] = JSON.stringify(rest);
  return texts;
}

/** Plants of a request that are not texts, by the keys of their fields. */
export const objectPlants = (id: StructureId, request: StructureRequest): [string, Plant][] =>
  fieldsOf(id, textsOf(id, request)).flatMap(({ key, kind }): [string, Plant][] => {
    const value = get(request, key);
    return kind === "plant" && typeof value === "object" && value !== null ? [[key, value as Plant]] : [];
  });

/** What a link holds: every text that is part of the question. */
export const linkedTexts = (id: StructureId, texts: Texts): Texts =>
  Object.fromEntries(
    [...fieldsOf(id, texts), { key: REST, kind: "text", label: "" } as FieldSpec].flatMap((spec) => {
      const text = texts[spec.key] ?? "";
      return text === "" || !isActive(spec, texts) || (spec.kind === "choice" && text === firstChoice(spec)) ? [] : [[spec.key, text] as const];
    }),
  );

/** The texts of a link; the first choice where it has none. */
export function textsOfLink(id: StructureId, linked: Texts): Texts {
  const texts: Texts = { ...linked };
  for (const spec of fieldsOf(id, texts)) if (spec.kind === "choice") texts[spec.key] ??= firstChoice(spec);
  return texts;
}
