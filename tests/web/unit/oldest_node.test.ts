// The page's code, its tools and its tests run on the oldest Node.js that package.json allows, which Debian 12 has. The
// tests have no types that show newer names, so these are searched for here, on any version of Node.js; the page's own
// code has tsc.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import test from "node:test";
import type * as TypeScript from "typescript";

const root = process.env.TUNEWRIGHT_ROOT!;
const web = path.join(root, "web");
const fromWeb = createRequire(path.join(web, "package.json"));
const ts = fromWeb("typescript") as typeof TypeScript;

// The newest edition of the language that each Node.js supports completely.
const EDITION_OF_NODE: Record<string, number> = { "18": 2022, "20": 2023, "22": 2024 };
// Names of Node.js itself that are newer than 18.
const LATER_IN_NODE = ["import.meta.dirname", "import.meta.filename", "import.meta.resolve", "process.loadEnvFile",
  "process.getBuiltinModule", "util.styleText", "util.parseEnv", "fs.glob", "fs.globSync", "fs.openAsBlob", "path.matchesGlob",
  "assert.partialDeepStrictEqual", "mock.timers", "t.plan", "t.assert", "t.waitFor", "AbortSignal.any"];
// Words that are also used for other things; a call with such a name proves nothing.
const COMMON_WORDS = ["difference", "drop", "take"];
const LATER_MODULES = ["node:sqlite", "node:sea"];

const engines = JSON.parse(readFileSync(path.join(web, "package.json"), "utf8")).engines.node as string;
const oldest = />=(\d+)/.exec(engines)![1]!;
const edition = EDITION_OF_NODE[oldest]!;

const parsed = (file: string, text = readFileSync(file, "utf8")) => ts.createSourceFile(file, text, ts.ScriptTarget.Latest, true);

function walk(node: TypeScript.Node, visit: (node: TypeScript.Node) => void): void {
  visit(node);
  node.forEachChild((child) => walk(child, visit));
}

/** Names of methods in TypeScript's own descriptions of the language, from the selected files. */
function methods(wanted: (name: string) => boolean): Set<string> {
  const names = new Set<string>();
  const folder = path.dirname(fromWeb.resolve("typescript"));
  for (const file of readdirSync(folder).filter((name) => /^lib\..*\.d\.ts$/.test(name) && wanted(name)))
    walk(parsed(path.join(folder, file)), (node) => {
      if (ts.isMethodSignature(node) && ts.isIdentifier(node.name)) names.add(node.name.text);
    });
  return names;
}

function isLater(file: string): boolean {
  if (file === "lib.esnext.disposable.d.ts") return false; // only common words
  const year = /^lib\.es(\d{4})/.exec(file)?.[1];
  return /^lib\.esnext/.test(file) || Number(year ?? 0) > edition;
}
const known = methods((file) => /^lib\.es\d/.test(file) && !isLater(file));
const later = new Set([...methods(isLater)].filter((name) => !known.has(name) && !COMMON_WORDS.includes(name)));

/** Uses of names that the oldest Node.js does not have, one line each. */
function tooNew(file: string, text?: string): string[] {
  const source = parsed(file, text);
  const found: string[] = [];
  const report = (node: TypeScript.Node, what: string) =>
    found.push(`${path.relative(root, file)}:${source.getLineAndCharacterOfPosition(node.getStart()).line + 1}: ${what}`);
  walk(source, (node) => {
    if (ts.isPropertyAccessExpression(node)) {
      const whole = node.getText();
      if (later.has(node.name.text)) report(node, node.name.text);
      else if (LATER_IN_NODE.includes(whole)) report(node, whole);
    }
    if (ts.isImportDeclaration(node)) {
      if (node.attributes) report(node, "attributes of an import");
      const from = (node.moduleSpecifier as TypeScript.StringLiteral).text;
      if (LATER_MODULES.includes(from)) report(node, from);
      // `import { glob } from "node:fs"`
      const names = node.importClause?.namedBindings;
      if (names && ts.isNamedImports(names))
        for (const { name, propertyName } of names.elements) {
          const whole = `${from.replace(/^node:|\/promises$/g, "")}.${(propertyName ?? name).text}`;
          if (LATER_IN_NODE.includes(whole)) report(node, whole);
        }
    }
  });
  return found;
}

function sources(folder: string): string[] {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const whole = path.join(folder, entry.name);
    if (entry.isDirectory()) return sources(whole);
    return /\.(ts|mjs|js)$/.test(entry.name) ? [whole] : [];
  });
}

test("no test of the page uses what is newer than the oldest Node.js", () => {
  const files = sources(path.join(root, "tests/web"));
  assert.ok(files.length > 40, `${files.length} sources`);
  assert.deepEqual(files.flatMap((file) => tooNew(file)), []);
});

test("what came later is found, and what Node.js 18 has is not", () => {
  assert.equal(oldest, "18", "the cases below are those of 18");
  const found = (text: string) => tooNew(path.join(root, "case.mjs"), text).map((line) => line.replace(/.*: /, ""));
  const cases: [string, string[]][] = [
    ["[2, 1].toSorted(); [1].toReversed(); [1].toSpliced(0, 1);", ["toSorted", "toReversed", "toSpliced"]],
    ["const a = anything(); a.with(0, 1);", ["with"]],
    ["Object.groupBy([], f); Map.groupBy([], f);", ["groupBy", "groupBy"]],
    ["await Array.fromAsync(list); Promise.withResolvers();", ["fromAsync", "withResolvers"]],
    ["new Set().isSubsetOf(other); new Set().symmetricDifference(other);", ["isSubsetOf", "symmetricDifference"]],
    ['import data from "./data.json" with { type: "json" };', ["attributes of an import"]],
    ["const here = import.meta.dirname;", ["import.meta.dirname"]],
    ['import { DatabaseSync } from "node:sqlite";', ["node:sqlite"]],
    ['import { globSync } from "node:fs";', ["fs.globSync"]],
    ['test("x", (t) => { t.plan(2); });', ["t.plan"]],
    ["[3].at(-1); [...list].sort(); Object.hasOwn(a, b); structuredClone(a);", []],
  ];
  for (const [text, expected] of cases) assert.deepEqual(found(text), expected, text);
});

test("the page's own code is checked against that edition of the language", () => {
  const settings = ts.readConfigFile(path.join(web, "tsconfig.json"), ts.sys.readFile).config.compilerOptions;
  assert.deepEqual([settings.target, settings.lib[0]], [`ES${edition}`, `ES${edition}`]);
});
