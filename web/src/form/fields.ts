// Conversion of a method's JSON Schema to form fields, and of typed texts to values. No DOM.
import type { Schema } from "../api/types.ts";
import { parseCases, writeCases } from "./cases.ts";
import { parseNumber, parseNumbers, parseRoots, writeRoots } from "./number.ts";
import type { Parsed } from "./number.ts";

/** "spread": a number, or an interval; "roots": numbers or complex pairs; "cases": a list of objects. */
export type FieldKind =
  "number" | "integer" | "boolean" | "choice" | "numbers" | "spread" | "roots" | "cases" | "names" | "text";

export interface FieldSpec {
  /** Path of the value inside the object, e.g. ["filter", "Tf"]. */
  path: string[];
  label: string;
  hint: string;
  unit: string;
  kind: FieldKind;
  choices: string[];
  /** Words that a number field also accepts, e.g. "free". */
  words: string[];
  /** For cases: the member that comes first without its name. */
  lead: string;
  /** The value of an empty field, as text; "" if there is none. */
  defaultText: string;
}

/** One field for each simple property, with nested objects expanded. Properties that no field can represent are left
    out. */
export function fieldsOf(
  schema: Schema | undefined,
  root: Schema | undefined = schema,
  path: string[] = [],
): FieldSpec[] {
  const properties = resolve(schema, root)?.properties ?? {};
  return Object.entries(properties).flatMap(([name, raw]): FieldSpec[] => {
    const property = resolve(raw, root);
    if (!property) return [];
    const here = [...path, name];
    const inside = membersOf(property, root);
    if (inside) return path.length < 3 ? fieldsOf({ properties: inside }, root, here) : [];
    const spec = fieldOf(property, root);
    if (!spec) return [];
    const own = property["x-unit"] ?? "";
    return [
      {
        ...spec,
        path: here,
        // A formula's field is not mistaken for that of its value.
        label: property.type === "string" && !property.enum ? `${here.join(" ")} =` : here.join(" "),
        hint: sentences(property),
        unit: own,
        defaultText:
          property.default === undefined || property.default === null || typeof property.default === "object"
            ? ""
            : String(property.default),
      },
    ];
  });
}

function resolve(schema: Schema | undefined, root: Schema | undefined): Schema | undefined {
  const match = /^#\/\$defs\/(.+)$/.exec(schema?.$ref ?? "");
  return match ? { ...root?.$defs?.[match[1]!], ...schema } : schema;
}

/** Members of an object, or of the alternative that is an object. */
function membersOf(schema: Schema, root: Schema | undefined): Record<string, Schema> | null {
  if (schema.properties) return schema.properties;
  const objects = (schema.oneOf ?? schema.anyOf ?? [])
    .flatMap((item) => resolve(item, root) ?? [])
    .filter((item) => item.type !== "null");
  if (objects.length === 0 || objects.some((item) => !item.properties)) return null;
  return Object.assign({}, ...objects.map((item) => item.properties)) as Record<string, Schema>;
}

function sentences(schema: Schema): string {
  return schema.description ?? schema.title ?? "";
}

type Shape = Pick<FieldSpec, "kind" | "choices" | "words" | "lead">;

const shape = (kind: FieldKind, given: Partial<Shape> = {}): Shape => ({
  kind,
  choices: [],
  words: [],
  lead: "",
  ...given,
});

function fieldOf(schema: Schema, root: Schema | undefined): Shape | null {
  const alternatives = schema.oneOf ?? schema.anyOf;
  if (alternatives)
    return combined(
      alternatives.flatMap((item) => resolve(item, root) ?? []),
      root,
    );
  if (schema.enum) return shape("choice", { choices: schema.enum.filter((item) => item !== null).map(String) });
  const type = Array.isArray(schema.type) ? schema.type.find((item) => item !== "null") : schema.type;
  switch (type) {
    case "number":
    case "integer":
    case "boolean":
      return shape(type);
    case "string":
      return shape("text");
    case "array":
      return listOf(resolve(schema.items, root), root);
    default:
      return null;
  }
}

const isNumber = (schema: Schema): boolean => schema.type === "number" || schema.type === "integer";

/** A list of numbers, of numbers or pairs, of names, or of objects with a leading number. */
function listOf(item: Schema | undefined, root: Schema | undefined): Shape | null {
  if (!item) return null;
  if (isNumber(item)) return shape("numbers");
  if (item.type === "string") return shape("names");
  const alternatives = (item.oneOf ?? item.anyOf ?? []).flatMap((one) => resolve(one, root) ?? []);
  if (alternatives.some(isNumber) && alternatives.some((one) => one.type === "array")) return shape("roots");
  const members = Object.entries(item.properties ?? {});
  const numeric = members.filter(([, member]) => isNumber(resolve(member, root) ?? {})).map(([name]) => name);
  const lead = numeric.find((name) => item.required?.includes(name)) ?? numeric[0];
  return lead === undefined ? null : shape("cases", { lead });
}

/** Options have two kinds of unions: "a number or one of these words" and "one of these words". */
function combined(alternatives: Schema[], root: Schema | undefined): Shape | null {
  const words = alternatives.flatMap((item) =>
    typeof item.const === "string" ? [item.const] : (item.enum ?? []).map(String),
  );
  const rest = alternatives.filter((item) => item.const === undefined && !item.enum && item.type !== "null");
  if (rest.length === 0) return shape("choice", { choices: words });
  const shapes = rest.flatMap((item) => fieldOf(item, root) ?? []);
  if (shapes.some(({ kind }) => kind === "number") && shapes.some(({ kind }) => kind === "numbers"))
    return shape("spread", { words });
  return shapes[0] ? { ...shapes[0], words } : null;
}

/** The typed text as a value; undefined: empty, so that the default applies. */
export function readField(spec: FieldSpec, typed: string): Parsed<unknown> {
  const text = typed.trim();
  if (text === "") return { ok: true, value: undefined };
  if (spec.words.includes(text)) return { ok: true, value: text };
  switch (spec.kind) {
    case "number":
      return parseNumber(text, spec.label);
    case "integer": {
      const parsed = parseNumber(text, spec.label);
      if (!parsed.ok || Number.isInteger(parsed.value)) return parsed;
      return { ok: false, sentence: `${spec.label} is ${text}; it counts something and must be a whole number.` };
    }
    case "numbers":
      return parseNumbers(text, spec.label);
    case "spread": {
      const single = parseNumber(text, spec.label);
      return single.ok ? single : parseNumbers(text, spec.label);
    }
    case "roots":
      return parseRoots(text, spec.label);
    case "cases":
      return parseCases(text, spec.label, spec.lead);
    case "names":
      return { ok: true, value: text.split(/[\s,;]+/).filter((name) => name !== "") };
    case "boolean":
      return { ok: true, value: text === "true" };
    case "choice":
    case "text":
      return { ok: true, value: text };
  }
}

/** A value as typed. */
export function typedText(value: unknown, spec?: Pick<FieldSpec, "kind" | "lead">): string {
  if (value === undefined || value === null) return "";
  if (spec?.kind === "roots") return writeRoots(value);
  if (spec?.kind === "cases") return writeCases(value, spec.lead);
  return Array.isArray(value) ? value.map((item: unknown) => typedText(item)).join(" ") : String(value);
}
