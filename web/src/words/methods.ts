// The service's description of its methods, as text to read and to search. Independent of any method.
import type { Method, Schema } from "../api/types.ts";
import { hasWords } from "./search_text.ts";

export interface OptionRow {
  name: string;
  /** Allowed values: "number in (1, 4]", "P, PI or PID". */
  values: string;
  standard: string;
  meaning: string;
}

/** One row for each option; options that are objects have one for each of their fields. */
export function optionRows(schema: Schema | undefined, root = schema, above = ""): OptionRow[] {
  return Object.entries(resolve(schema, root).properties ?? {}).flatMap(([name, raw]): OptionRow[] => {
    const property = resolve(raw, root);
    const full = above + name;
    if (property.properties) return optionRows(property, root, `${full}.`);
    const unit = property["x-unit"];
    return [
      {
        name: full,
        values: valuesOf(property, root) + (unit ? `, in ${unit}` : ""),
        standard: property.default === undefined || property.default === null ? "" : plain(property.default),
        meaning: property.description ?? property.title ?? "",
      },
    ];
  });
}

function resolve(schema: Schema | undefined, root: Schema | undefined): Schema {
  const match = /^#\/\$defs\/(.+)$/.exec(schema?.$ref ?? "");
  return match ? { ...root?.$defs?.[match[1]!], ...schema } : (schema ?? {});
}

const plain = (value: unknown): string => (typeof value === "string" ? value : JSON.stringify(value));

const either = (words: string[]): string =>
  words.length < 2 ? words.join("") : `${words.slice(0, -1).join(", ")} or ${words[words.length - 1]!}`;

function valuesOf(schema: Schema, root: Schema | undefined): string {
  if (schema.const !== undefined) return plain(schema.const);
  if (schema.enum) return either(schema.enum.filter((item) => item !== null).map(plain));
  const alternatives = (schema.oneOf ?? schema.anyOf ?? []).map((item) => resolve(item, root));
  if (alternatives.length > 0)
    return either([
      ...new Set(alternatives.filter((item) => item.type !== "null").map((item) => valuesOf(item, root))),
    ]);
  const types = [schema.type ?? "any value"].flat().filter((type) => type !== "null");
  const name = either(types.map((type) => (type === "boolean" ? "true or false" : type)));
  if (types.includes("array") && schema.items) return `list of ${valuesOf(resolve(schema.items, root), root)}`;
  return name + interval(schema);
}

function interval({ minimum, maximum, exclusiveMinimum, exclusiveMaximum }: Schema): string {
  const low = exclusiveMinimum ?? minimum;
  const high = exclusiveMaximum ?? maximum;
  if (low !== undefined && high !== undefined)
    return ` in ${exclusiveMinimum !== undefined ? "(" : "["}${low}, ${high}${exclusiveMaximum !== undefined ? ")" : "]"}`;
  if (low !== undefined) return ` ${exclusiveMinimum !== undefined ? "above" : "from"} ${low}`;
  if (high !== undefined) return ` ${exclusiveMaximum !== undefined ? "below" : "up to"} ${high}`;
  return "";
}

/** True if the description of the method contains every search word. */
export function mentions(method: Method, search: string): boolean {
  const { id, title, source, needs, validity, formula } = method;
  return hasWords([id, title, source, needs, validity, formula].join(" "), search);
}
