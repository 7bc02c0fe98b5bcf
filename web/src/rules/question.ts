// The typed texts of a rule to its request, to the address, and back. No DOM.
import type { ProblemScore, ScoreRequest, SubmittedSettings } from "../api/score.ts";
import type { FieldError, TuneEntry, TuningRequest } from "../api/types.ts";
import { place } from "../form/cases.ts";
import { readField } from "../form/fields.ts";
import type { FieldSpec } from "../form/fields.ts";
import { parseNumber } from "../form/number.ts";
import type { KnownProblem } from "./words.ts";

/** By the names of the fields; options of a method begin with `OPTION`. */
export type RuleTexts = Record<string, string>;

export const KINDS = ["formula", "method", "settings"] as const;
export type RuleKind = (typeof KINDS)[number];

export const FORMULAS = ["Kp", "Ti", "Td"] as const;
export const OPTION = "option.";

export const kindOf = ({ kind }: RuleTexts): RuleKind => KINDS.find((one) => one === kind) ?? "formula";

/** A rule to begin with, and its problems. */
export const FIRST_RULE: RuleTexts = { kind: "formula", Kp: "0.3/(Kv*L)", Ti: "min(T + L/3, 8*L)", structure: "pi", Ms: "1.6" };

const FILTERS = ["family", "structure", "Ms"];
const OF_KIND: Record<RuleKind, (name: string) => boolean> = {
  formula: (name) => (FORMULAS as readonly string[]).includes(name),
  method: (name) => name === "method" || name.startsWith(OPTION),
  settings: (name) => name === "settings",
};

/** What a link has to hold: the texts of the chosen kind. */
export function linkedTexts(texts: RuleTexts): RuleTexts {
  const kind = kindOf(texts);
  const wanted = Object.entries(texts).filter(([name, text]) => text.trim() !== "" && ([...FILTERS, "name"].includes(name) || OF_KIND[kind](name)));
  return { kind, ...Object.fromEntries(wanted) };
}

/** Settings of a text: columns problem, Kp, Ti and, for a PID, Td, in any order. */
export function readSettings(text: string): { settings: SubmittedSettings[]; lines: number[]; fault: string } {
  // Numbers with a decimal comma stand between semicolons or tabs.
  const mark = ["\t", ";"].find((one) => text.split("\n", 1)[0]!.includes(one)) ?? ",";
  const rows = text.split(/\r?\n/).map((line, index) => ({ line: index + 1, cells: line.split(mark).map((cell) => cell.trim()) }));
  const [head, ...others] = rows.filter(({ cells }) => cells.some((cell) => cell !== ""));
  const none = { settings: [], lines: [] };
  const names = head?.cells.map((cell) => cell.toLowerCase()) ?? [];
  const at = (name: string): number => names.indexOf(name.toLowerCase());
  const missing = ["problem", "Kp", "Ti"].filter((name) => at(name) < 0);
  if (missing.length > 0) return { ...none, fault: `The first line has no column ${missing.join(", ")}. It must name the columns: problem, Kp, Ti and, for a PID, Td.` };
  if (others.length === 0) return { ...none, fault: "There are no settings below the names of the columns." };
  const settings: SubmittedSettings[] = [];
  for (const { line, cells } of others) {
    const numbers: Record<string, number> = {};
    for (const name of FORMULAS) {
      const cell = cells[at(name)] ?? "";
      if (name === "Td" && cell === "") continue;
      const parsed = parseNumber(cell, name);
      if (!parsed.ok) return { ...none, fault: `Line ${line}: ${cell === "" ? `${name} is missing.` : parsed.sentence}` };
      numbers[name] = parsed.value;
    }
    settings.push({ problem: cells[at("problem")] ?? "", ...numbers } as unknown as SubmittedSettings);
  }
  return { settings, lines: others.map(({ line }) => line), fault: "" };
}

export interface RuleQuestion {
  request: ScoreRequest;
  errors: FieldError[];
  /** Lines of the settings' text, by their place in the request. */
  lines: number[];
}

function readProblems(texts: RuleTexts, errors: FieldError[]): ScoreRequest["problems"] {
  const Ms = readField(MS, texts["Ms"] ?? "");
  if (!Ms.ok) errors.push({ pointer: "/problems/Ms", detail: Ms.sentence });
  const [name, structure] = [texts["family"], texts["structure"]];
  return {
    ...(name ? { name } : {}),
    ...(structure ? { structure: structure as KnownProblem["structure"] } : {}),
    ...(Ms.ok && Ms.value !== undefined ? { Ms: Ms.value as number } : {}),
  };
}

const MS: FieldSpec = { path: ["Ms"], label: "Ms", hint: "", unit: "", kind: "number", choices: [], words: [], lead: "", defaultText: "" };

/** `options`: those of the chosen method. */
export function readRule(texts: RuleTexts, options: readonly FieldSpec[]): RuleQuestion {
  const errors: FieldError[] = [];
  const name = (texts["name"] ?? "").trim();
  const problems = readProblems(texts, errors);
  const shared = { ...(name ? { name } : {}), problems };
  const kind = kindOf(texts);
  if (kind === "settings") {
    const { settings, lines, fault } = readSettings(texts["settings"] ?? "");
    if (fault) errors.push({ pointer: "/settings", detail: fault });
    return { request: { ...shared, settings } as ScoreRequest, errors, lines };
  }
  const tune: TuneEntry = { method: kind === "formula" ? "formula" : (texts["method"] ?? "") };
  if (kind === "formula") {
    for (const of of FORMULAS) if ((texts[of] ?? "").trim() !== "") tune[of] = texts[of]!.trim();
    if (tune["Kp"] === undefined) errors.push({ pointer: "/tune/Kp", detail: "Kp has no formula." });
  } else {
    for (const spec of options) {
      const parsed = readField(spec, texts[OPTION + spec.path.join(".")] ?? "");
      if (parsed.ok) place(tune, spec.path, parsed.value);
      else errors.push({ pointer: `/tune/${spec.path.join("/")}`, detail: parsed.sentence });
    }
  }
  return { request: { ...shared, tune } as ScoreRequest, errors, lines: [] };
}

/** Faults of settings, with the line of the text. */
export const atLines = (errors: readonly FieldError[], lines: readonly number[]): FieldError[] =>
  errors.map((error) => {
    const [, index] = /^\/settings\/(\d+)/.exec(error.pointer) ?? [];
    return index === undefined ? error : { pointer: "/settings", detail: `Line ${lines[Number(index)] ?? "?"}: ${error.detail}` };
  });

/** The design of a problem: the robust optimum within its limits, next to the controller that was scored. */
export function designRequest(name: string, { plant, structure, Tf, Ms, Mt }: KnownProblem, scored: ProblemScore): TuningRequest {
  const filter = structure === "pid_tied" ? { filter: { Tf_over_Td: TIED } } : Tf ? { filter: { Tf } } : {};
  const robust = { method: "robust", controller: structure === "pi" ? "PI" : "PID", Ms, Mt, ...filter };
  const request = { name, plant, tune: [robust], ...(scored.controller ? { controllers: [scored.controller] } : {}) };
  return request as unknown as TuningRequest;
}

/** Tf/Td of pid_tied. */
const TIED = 0.1;
