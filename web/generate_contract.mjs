// Writes src/api/contract.gen.ts, the types of the contract, and src/api/units.gen.ts, the units of its figures, from
// the service's own document on standard input:
//     curl -s http://127.0.0.1:8080/openapi.json | npm run --silent contract
// A test compares the files with the document of the current service. Types that the page does not use, and
// descriptions, are left out.
import { readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import openapiTS, { astToString } from "openapi-typescript";

/** Types that the page sends; an answer with one of them contains it as sent. */
const SENT = [
  "CascadeRequest", "CheckRequest", "ExperimentCodeRequest", "FeedforwardRequest", "IdentifyRequest", "InteractionRequest", "LevelRequest", "PlantQuestion",
  "PredictorRequest", "RangeRequest", "RelayRequest", "ScoreRequest", "TuningRequest",
];

/** Types of answers; the types to which both refer are included. */
const ANSWERED = [
  "Batch", "BatchCheck", "CascadeAnswer", "CheckResult", "ControllerProduct", "ControllerRecordAnswer", "ControllerSummary", "DesignAnswer", "EvaluateAnswer", "Example", "FeedforwardAnswer", "Frontier", "Health",
  "IdentifyAnswer", "InteractionAnswer", "Job", "JobList", "LevelAnswer", "MethodDescription", "PlantAnswer", "PredictorAnswer", "PreviewAnswer", "Problem", "RangeExample", "RangeResult",
  "RelayAnswer", "ScheduleSettingsAnswer", "ScoreAnswer", "SettingsAnswer", "TuningResult",
];

/** Types that the page fills from a description and reads by name, each with the member that holds its kind. */
const OPEN = { Plant: "type", PlantModel: "type", Method: "method" };

/** Types with figures of which the page shows the units. */
const MEASURED = [
  "CheckTest", "CheckedRecord", "DataQuality", "IdealController", "LoadPerformance", "LoopCause", "LoopPerformance", "LoopPeriod", "LoopRank", "MissingPart",
  "NonlinearController", "OwnLoad", "OwnLoadFigures", "OwnSetpointFigures", "OwnStep", "OwnStepEntry", "PreTest", "ReplayFigures", "Robustness", "SetpointPerformance",
];

const SHAPE = ["$ref", "type", "enum", "const", "additionalProperties", "items", "oneOf", "anyOf", "properties", "required"];

/** Only the structure. Members that answers always have (`x-written`) are required if answers have the type. */
function shapeOf(schema, answered) {
  if (Array.isArray(schema)) return schema.map((part) => shapeOf(part, answered));
  if (typeof schema !== "object" || schema === null) return schema;
  if (schema.$ref) return { $ref: schema.$ref };
  const shape = {};
  for (const name of SHAPE) {
    if (!(name in schema)) continue;
    const part = schema[name];
    shape[name] =
      name === "properties"
        ? Object.fromEntries(Object.entries(part).map(([member, of]) => [member, shapeOf(of, answered)]))
        : shapeOf(part, answered);
  }
  const pair = schema.minItems === 2 && schema.maxItems === 2;
  if (pair) Object.assign(shape, { minItems: 2, maxItems: 2 });
  if (answered && schema["x-written"]) shape.required = [...new Set([...(shape.required ?? []), ...schema["x-written"]])];
  return shape;
}

const nameOf = (reference) => reference.split("/").at(-1);

/** One object with the members of all of the union's types: readers check its kind. */
function merged(union, schemas) {
  const parts = union.oneOf.map(({ $ref }) => schemas[nameOf($ref)]);
  const names = [...new Set(parts.flatMap(({ properties }) => Object.keys(properties)))];
  const member = (name) => {
    const shapes = [...new Set(parts.flatMap(({ properties }) => JSON.stringify(properties[name]) ?? []))].map((text) => JSON.parse(text));
    return shapes.length === 1 ? shapes[0] : { anyOf: shapes };
  };
  const required = names.filter((name) => parts.every((part) => part.required?.includes(name)));
  return { type: "object", properties: Object.fromEntries(names.map((name) => [name, member(name)])), required, additionalProperties: false };
}

/** These names and all to which they refer, without those that are only reached through `apart`. */
function reached(schemas, from, apart = []) {
  const names = new Set();
  const take = (part) => {
    if (typeof part !== "object" || part === null) return;
    if (part.$ref) visit(nameOf(part.$ref));
    Object.values(part).forEach(take);
  };
  const visit = (name) => {
    if (names.has(name) || apart.includes(name)) return;
    if (!schemas[name]) throw new Error(`The document has no ${name}.`);
    names.add(name);
    take(schemas[name]);
  };
  from.forEach(visit);
  return names;
}

export async function contractTypes(document) {
  const described = document.components.schemas;
  const answered = reached(described, ANSWERED, SENT);
  const schemas = Object.fromEntries(Object.entries(described).map(([name, schema]) => [name, shapeOf(schema, answered.has(name))]));
  for (const [name, kind] of Object.entries(OPEN))
    schemas[name] = { type: "object", properties: { [kind]: { type: "string" } }, required: [kind], additionalProperties: true };
  schemas.Controller = merged(schemas.Controller, schemas);
  const names = reached(schemas, [...SENT, ...ANSWERED]);
  const used = Object.fromEntries(Object.entries(schemas).filter(([name]) => names.has(name)));
  const small = { openapi: document.openapi, info: { title: "", version: "" }, paths: {}, components: { schemas: used } };
  const text = astToString(await openapiTS(small, { exportType: true, rootTypes: true, rootTypesNoSchemaPrefix: true, arrayLength: true }));
  const types = text.replaceAll(/ *\/\*\*.*?\*\/\n/gs, "").replaceAll(/^export type (paths|webhooks|operations|\$defs) = .*;\n/gm, "");
  return `// Made by generate_contract.mjs from the service's /openapi.json; not to be edited.\n${types.replaceAll("    ", "  ")}`;
}

/** By type and member; a member without a unit is left out. */
export function figureUnits(document) {
  const types = MEASURED.map((type) => {
    const { properties } = document.components.schemas[type];
    const units = Object.entries(properties).flatMap(([name, schema]) => (schema["x-unit"] ? [`    ${name}: ${JSON.stringify(schema["x-unit"])},`] : []));
    return `  ${type}: {\n${units.join("\n")}\n  },`;
  });
  return `// Made by generate_contract.mjs from the service's /openapi.json; not to be edited.\nexport const UNITS = {\n${types.join("\n")}\n} as const;\n`;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const document = JSON.parse(readFileSync(0, "utf8"));
  writeFileSync(new URL("src/api/contract.gen.ts", import.meta.url), await contractTypes(document));
  writeFileSync(new URL("src/api/units.gen.ts", import.meta.url), figureUnits(document));
}
