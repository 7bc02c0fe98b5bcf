// The service's own description of its calls, as data to show: /openapi.json, OpenAPI 3.1.

/** A schema of the document; only what is shown. */
export interface ApiSchema {
  $ref?: string;
  title?: string;
  description?: string;
  type?: string | string[];
  properties?: Record<string, ApiSchema>;
  required?: string[];
  items?: ApiSchema;
  oneOf?: ApiSchema[];
  anyOf?: ApiSchema[];
  enum?: unknown[];
  const?: unknown;
  default?: unknown;
  examples?: unknown[];
  additionalProperties?: ApiSchema | boolean;
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
  minItems?: number;
  maxItems?: number;
  maxLength?: number;
  format?: string;
  "x-unit"?: string;
}

export interface ApiParameter {
  name: string;
  in: string;
  required?: boolean;
  description?: string;
  schema?: ApiSchema;
}

interface MediaType {
  schema?: ApiSchema;
  example?: unknown;
  examples?: Record<string, { summary?: string; value: unknown }>;
}

type Content = Record<string, MediaType>;

interface ApiAnswer {
  $ref?: string;
  description?: string;
  content?: Content;
}

interface Operation {
  operationId: string;
  tags?: string[];
  summary?: string;
  description?: string;
  parameters?: (ApiParameter & { $ref?: string })[];
  requestBody?: { content: Content };
  responses: Record<string, ApiAnswer>;
}

type PathItem = Record<string, unknown> & { parameters?: (ApiParameter & { $ref?: string })[] };

export interface ApiDocument {
  info: { title: string; version: string; description?: string };
  tags?: { name: string; description?: string }[];
  paths: Record<string, PathItem>;
  components: { schemas: Record<string, ApiSchema>; parameters?: Record<string, ApiParameter>; responses?: Record<string, ApiAnswer> };
}

export interface Call {
  id: string;
  method: string;
  path: string;
  tag: string;
  summary: string;
  description: string;
  parameters: ApiParameter[];
  /** The request's body, by its media type; empty: it has none. */
  body: Content;
  answers: { status: string; description: string; content: Content }[];
}

const METHODS = ["get", "post", "put", "patch", "delete"];

/** The part of the document to which a reference leads, under the members next to it. */
export function resolved<T extends { $ref?: string }>(document: ApiDocument, part: T): T {
  let whole = part;
  while (whole.$ref !== undefined) {
    const { $ref, ...siblings } = whole;
    const target = $ref
      .replace(/^#\//, "")
      .split("/")
      .reduce<unknown>((at, name) => (at as Record<string, unknown> | undefined)?.[name], document);
    whole = { ...(target as T), ...(siblings as Partial<T>) };
  }
  return whole;
}

/** Every call, in the document's order. */
export const callsOf = (document: ApiDocument): Call[] =>
  Object.entries(document.paths).flatMap(([path, item]) =>
    METHODS.flatMap((method): Call[] => {
      const operation = item[method] as Operation | undefined;
      if (!operation) return [];
      const parameters = [...(item.parameters ?? []), ...(operation.parameters ?? [])].map((one) => resolved(document, one));
      const answers = Object.entries(operation.responses).map(([status, answer]) => {
        const { description = "", content = {} } = resolved(document, answer);
        return { status, description, content };
      });
      const { operationId: id, tags = [], summary = "", description = "", requestBody } = operation;
      return [{ id, method: method.toUpperCase(), path, tag: tags[0] ?? "", summary, description, parameters, body: requestBody?.content ?? {}, answers }];
    }),
  );

export interface NamedExample {
  name: string;
  /** As typed: JSON with indents, or the text itself. */
  text: string;
}

export const asText = (value: unknown): string => (typeof value === "string" ? value : JSON.stringify(value, null, 2));

/** Requests to begin with, for one media type; at least one. */
export function examplesOf(document: ApiDocument, { schema, example, examples }: MediaType): NamedExample[] {
  const named = Object.entries(examples ?? {}).map(([name, { summary, value }]) => ({ name: summary ?? name, text: asText(value) }));
  const single = example === undefined ? [] : [{ name: "Example", text: asText(example) }];
  const ofSchema = (schema ? (resolved(document, schema).examples ?? []) : []).map((value, index) => ({ name: `Example ${index + 1}`, text: asText(value) }));
  const all = [...named, ...single, ...ofSchema];
  return all.length > 0 ? all : [{ name: "Empty", text: "{}" }];
}

/** "number above 0, in s", "one of: P, PI", "list of at most 50". */
export function typeWords(document: ApiDocument, raw: ApiSchema): string {
  const schema = resolved(document, raw);
  if (schema.const !== undefined) return asText(schema.const);
  if (schema.enum) return schema.enum.map(asText).join(", ");
  const alternatives = schema.oneOf ?? schema.anyOf;
  if (alternatives) return "one of these";
  const type = [schema.type ?? "any value"].flat().join(" or ");
  const bounds = [
    schema.minimum !== undefined ? `at least ${schema.minimum}` : "",
    schema.exclusiveMinimum !== undefined ? `above ${schema.exclusiveMinimum}` : "",
    schema.maximum !== undefined ? `at most ${schema.maximum}` : "",
    schema.exclusiveMaximum !== undefined ? `below ${schema.exclusiveMaximum}` : "",
    schema.minItems !== undefined ? `at least ${schema.minItems} items` : "",
    schema.maxItems !== undefined ? `at most ${schema.maxItems} items` : "",
    schema.maxLength !== undefined ? `at most ${schema.maxLength} characters` : "",
    schema.format ?? "",
    schema["x-unit"] ? `in ${schema["x-unit"]}` : "",
  ].filter(Boolean);
  return [type, ...bounds].join(", ");
}

export interface ApiField {
  name: string;
  schema: ApiSchema;
  required: boolean;
}

/** The fields inside a schema: members of an object, of the items of a list, or alternatives. */
export function fieldsOf(document: ApiDocument, raw: ApiSchema): ApiField[] {
  const schema = resolved(document, raw);
  const alternatives = schema.oneOf ?? schema.anyOf ?? [];
  const members = Object.entries(schema.properties ?? {}).map(([name, member]) => ({
    name,
    schema: member,
    required: schema.required?.includes(name) ?? false,
  }));
  const named = (index: number): string => {
    const { title, type } = resolved(document, alternatives[index]!);
    return title ?? [type ?? "value"].flat().join(" or ");
  };
  const others = typeof schema.additionalProperties === "object" ? [{ name: "any name", schema: schema.additionalProperties, required: false }] : [];
  const items = schema.items ? fieldsOf(document, schema.items) : [];
  return [
    ...members,
    ...others,
    ...items,
    ...alternatives.map((alternative, index) => ({ name: named(index), schema: alternative, required: false })),
  ];
}
