// From a method's JSON Schema to form fields, and from what was typed back to values. No DOM.
import type { Schema } from "../api/types.ts";
import { parseNumber, parseNumbers } from "./number.ts";
import type { Parsed } from "./number.ts";

export type FieldKind = "number" | "integer" | "boolean" | "choice" | "numbers" | "text";

export interface FieldSpec {
  /** Where the value goes inside the object, e.g. ["filter", "Tf"]. */
  path: string[];
  label: string;
  hint: string;
  unit: string;
  kind: FieldKind;
  choices: string[];
  /** Words that a number field also takes, e.g. "free". */
  words: string[];
  /** What is used when the field is left empty, as text; "" if nothing is. */
  defaultText: string;
}

/** One field for each simple property, nested objects opened up. Properties of a shape that no field can hold are left out. */
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
    if (property.properties) return path.length < 3 ? fieldsOf(property, root, here) : [];
    const spec = fieldOf(property, root);
    if (!spec) return [];
    const own = property["x-unit"] ?? "";
    return [
      {
        ...spec,
        path: here,
        label: here.join(" "),
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

function sentences(schema: Schema): string {
  return schema.description ?? schema.title ?? "";
}

type Shape = Pick<FieldSpec, "kind" | "choices" | "words">;

function fieldOf(schema: Schema, root: Schema | undefined): Shape | null {
  const alternatives = schema.oneOf ?? schema.anyOf;
  if (alternatives)
    return combined(
      alternatives.flatMap((item) => resolve(item, root) ?? []),
      root,
    );
  if (schema.enum)
    return { kind: "choice", choices: schema.enum.filter((item) => item !== null).map(String), words: [] };
  const type = Array.isArray(schema.type) ? schema.type.find((item) => item !== "null") : schema.type;
  switch (type) {
    case "number":
    case "integer":
    case "boolean":
      return { kind: type, choices: [], words: [] };
    case "string":
      return { kind: "text", choices: [], words: [] };
    case "array": {
      const item = resolve(schema.items, root)?.type;
      return item === "number" || item === "integer" ? { kind: "numbers", choices: [], words: [] } : null;
    }
    default:
      return null;
  }
}

/** "a number or one of these words" and "one of these words" are the unions that options have. */
function combined(alternatives: Schema[], root: Schema | undefined): Shape | null {
  const words = alternatives.flatMap((item) =>
    typeof item.const === "string" ? [item.const] : (item.enum ?? []).map(String),
  );
  const rest = alternatives.filter((item) => item.const === undefined && !item.enum && item.type !== "null");
  if (rest.length === 0) return { kind: "choice", choices: words, words: [] };
  const first = rest.map((item) => fieldOf(item, root)).find((shape) => shape !== null);
  return first ? { ...first, words } : null;
}

/** The typed text as a value; undefined: left empty, the default holds. */
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
    case "boolean":
      return { ok: true, value: text === "true" };
    case "choice":
    case "text":
      return { ok: true, value: text };
  }
}

/** Puts a value at its path; undefined puts nothing. */
export function place(target: Record<string, unknown>, path: string[], value: unknown): void {
  if (value === undefined) return;
  let at = target;
  for (const key of path.slice(0, -1)) {
    if (typeof at[key] !== "object" || at[key] === null) at[key] = {};
    at = at[key] as Record<string, unknown>;
  }
  at[path[path.length - 1]!] = value;
}

/** The value at a path, or undefined. */
export function pick(source: unknown, path: string[]): unknown {
  return path.reduce<unknown>(
    (at, key) => (typeof at === "object" && at !== null ? (at as Record<string, unknown>)[key] : undefined),
    source,
  );
}

/** A value as it would be typed. */
export function typedText(value: unknown): string {
  if (value === undefined || value === null) return "";
  return Array.isArray(value) ? value.map(typedText).join(" ") : String(value);
}
