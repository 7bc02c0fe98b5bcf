// Hash routes: the server needs no rewriting, and a plant never appears in an access log.
import type { StepTexts } from "./form/own_step.ts";
import type { StartTexts } from "./views/start.ts";

/** Longer links are cut by mail and chat programs. */
const MAX_LINK = 4000;

export type Route =
  | { screen: "start" }
  | { screen: "new"; plant: string; values: Record<string, string> }
  | { screen: "example"; id: string }
  | { screen: "edit"; job: string }
  /** A recorded test: of that job, or the current one. */
  | { screen: "identify"; job: string | null }
  /** An operating range: of an example, of that job, or the current content. */
  | { screen: "range"; example: string; job: string | null }
  | CheckRoute
  | StructureRoute
  | RulesRoute
  | { screen: "relay"; plant: string; values: Record<string, string> }
  /** `values`: the positions of its sliders, if they differ from the proposal. `step`: the user's own step, if it was
      typed. */
  | { screen: "design"; job: string; entry: number | null; values?: Record<string, string>; step?: StepTexts }
  /**
   * The comparison of a job. `sort`: a column's id, with a minus for descending order; "" is the ranking. `rankMs`: the
   * limit on Ms for the ranking, if it differs from the request's.
   */
  | { screen: "compare"; job: string; sort: string; rows: number[] | null; rankMs?: number | null }
  /** The jobs that have this text in their name, id or method. */
  | { screen: "jobs"; text: string }
  /** The loops of a batch, in an order as in compare. */
  | { screen: "batch"; id: string; sort: string }
  /** The methods of the service, or one of them. */
  | { screen: "methods"; id: string }
  /** The API: the call with that id, or the one with which to begin. */
  | { screen: "docs"; call: string };

/** A check is a job, or a batch with a job for each loop. */
export interface CheckedBy {
  kind: "job" | "batch";
  id: string;
}

/**
 * Loops in operation. `of`: what checked them; null: the form, filled with the loops of the job `from` if there is one.
 * `before`: an earlier batch to compare with. `loop`: the place of the loop whose page is shown; null: the work list.
 * `other`: the place of a loop that is drawn with it.
 * `list`: what is shown of that, by the names of `LIST_PARTS`.
 */
export interface CheckRoute {
  screen: "check";
  of: CheckedBy | null;
  from: string | null;
  before: string | null;
  loop: number | null;
  other: number | null;
  list: ListView;
}

/** Loops around the loop. `id`: the structure; "": the current content. `values`: the whole question as texts; `job`: of
 * that job instead. */
export interface StructureRoute {
  screen: "structure";
  id: string;
  values: Record<string, string>;
  job: string | null;
}

/** A rule and its problems, as texts; none: the current content. */
export interface RulesRoute {
  screen: "rules";
  values: Record<string, string>;
}

const LIST_PARTS = ["sort", "cause", "owner", "text"] as const;

/** The loops that are shown of a work list, and their order. */
export interface ListView {
  /** A column's id, with a minus for descending order; "" is the service's order. */
  sort: string;
  cause: string;
  owner: string;
  /** A part of the name. */
  text: string;
}

export const WHOLE_LIST: ListView = { sort: "", cause: "", owner: "", text: "" };

export type JobScreen = "design" | "compare";
export type JobRoute = Extract<Route, { screen: JobScreen }>;

export const showsJob = (route: Route): route is JobRoute => route.screen === "design" || route.screen === "compare";

/** Start's own addresses: with its current content, or filled from elsewhere. */
export const showsStart = (route: Route): boolean => ["start", "new", "example", "edit"].includes(route.screen);

/** A job's screen before anything was chosen on it. */
export const addressOfJob = (job: string, screen: JobScreen): string =>
  formatRoute(screen === "design" ? { screen, job, entry: null } : { screen, job, sort: "", rows: null });

/** The result of a check. */
export const addressOfCheck = (id: string, kind: CheckedBy["kind"] = "job"): string =>
  formatRoute({ screen: "check", of: { kind, id }, from: null, before: null, loop: null, other: null, list: WHOLE_LIST });

/** The question and the answer of a job about a structure. */
export const addressOfStructure = (job: string): string => formatRoute({ screen: "structure", id: "", values: {}, job });

export const sameCheck = (a: CheckedBy | null, b: CheckedBy | null): boolean => a?.kind === b?.kind && a?.id === b?.id;

function checkRoute(of: CheckedBy | null, values: Record<string, string>): CheckRoute {
  const { from, before } = values;
  const placeOf = (text = ""): number | null => (/^\d+$/.test(text) ? Number(text) : null);
  const list = Object.fromEntries(LIST_PARTS.map((part) => [part, values[part] ?? ""])) as unknown as ListView;
  return { screen: "check", of, from: from || null, before: before || null, loop: placeOf(values["loop"]), other: placeOf(values["with"]), list };
}

function formatCheck({ of, from, before, loop, other, list }: CheckRoute): string {
  const values = { loop: `${loop ?? ""}`, with: `${other ?? ""}`, ...list, from: from ?? "", before: before ?? "" };
  const query = new URLSearchParams(Object.entries(values).filter(([, text]) => text !== "")).toString();
  const folder = of?.kind === "batch" ? "batches" : "jobs";
  return `#/${of === null ? "check" : `${folder}/${encodeURIComponent(of.id)}/check`}${query ? `?${query}` : ""}`;
}

/** The route of a location hash; an unknown one leads to Start. */
export function parseRoute(hash: string): Route {
  const [path = "", query = ""] = hash.replace(/^#\/?/, "").split("?", 2);
  const parts = path.split("/").filter(Boolean).map(decode);
  const values = Object.fromEntries(new URLSearchParams(query));
  if (parts[0] === "new" && parts[1]) return { screen: "new", plant: parts[1], values };
  if (parts[0] === "examples" && parts[1]) return { screen: "example", id: parts[1] };
  if (parts[0] === "identify") return { screen: "identify", job: null };
  if (parts[0] === "range") return { screen: "range", example: parts[1] ?? "", job: null };
  if (parts[0] === "check") return checkRoute(null, values);
  if (parts[0] === "structure") return { screen: "structure", id: parts[1] ?? "", values, job: null };
  if (parts[0] === "rules") return { screen: "rules", values };
  if (parts[0] === "relay") return { screen: "relay", plant: parts[1] ?? "", values };
  if (parts[0] === "jobs" && !parts[1]) return { screen: "jobs", text: values["q"] ?? "" };
  if (parts[0] === "batches" && parts[1] && parts[2] === "check") return checkRoute({ kind: "batch", id: parts[1] }, values);
  if (parts[0] === "batches" && parts[1]) return { screen: "batch", id: parts[1], sort: values["sort"] ?? "" };
  if (parts[0] === "docs") return { screen: "docs", call: parts[1] ?? "" };
  if (parts[0] === "methods") return { screen: "methods", id: parts[1] ?? "" };
  if (parts[0] === "jobs" && parts[1]) {
    if (parts[2] === "compare") {
      const rows = values["rows"] ?? "";
      return {
        screen: "compare",
        job: parts[1],
        sort: values["sort"] ?? "",
        rows: /^\d+(\.\d+)*$/.test(rows) ? rows.split(".").map(Number) : null,
        ...(Number(values["Ms"]) > 1 ? { rankMs: Number(values["Ms"]) } : {}),
      };
    }
    if (parts[2] === "check") return checkRoute({ kind: "job", id: parts[1] }, values);
    if (parts[2] === "identify") return { screen: "identify", job: parts[1] };
    if (parts[2] === "range") return { screen: "range", example: "", job: parts[1] };
    if (parts[2] === "structure") return { screen: "structure", id: "", values: {}, job: parts[1] };
    if (parts[2] === "edit") return { screen: "edit", job: parts[1] };
    const { entry, ...others } = values;
    const [modified, step] = withoutStep(others);
    return {
      screen: "design",
      job: parts[1],
      entry: /^\d+$/.test(entry ?? "") ? Number(entry) : null,
      ...(Object.keys(modified).length > 0 ? { values: modified } : {}),
      ...(Object.keys(step).length > 0 ? { step } : {}),
    };
  }
  return { screen: "start" };
}

/** Begins the names of the user's own step in the address of a design. */
const STEP = "step.";

/** The values of an address without those of the step, and these by their own names. */
function withoutStep(values: Record<string, string>): [Record<string, string>, StepTexts] {
  const entries = Object.entries(values);
  return [
    Object.fromEntries(entries.filter(([name]) => !name.startsWith(STEP))),
    Object.fromEntries(entries.flatMap(([name, text]) => (name.startsWith(STEP) ? [[name.slice(STEP.length), text]] : []))),
  ];
}

/** With the plant, and what is typed about its loop as far as the link stays short. */
function formatPlant({ screen, plant, values }: Extract<Route, { screen: "new" | "relay" }>): string {
  const given = Object.entries(values).filter(([, value]) => value !== "");
  const address = (entries: [string, string][]): string => {
    const query = new URLSearchParams(entries).toString();
    return `#/${screen}${plant === "" ? "" : `/${encodeURIComponent(plant)}`}${query ? `?${query}` : ""}`;
  };
  for (const left of [/^$/, /^rest$/, /^(rest|how)\b/, /^(rest|how|today)\b/]) {
    const short = address(given.filter(([name]) => !left.test(name)));
    if (short.length <= MAX_LINK) return short;
  }
  return address(given.filter(([name]) => !ABOUT_LOOP.test(name)));
}

/** Names in an address that are about the loop and not about its plant. */
export const ABOUT_LOOP = /^(loop|today|controller|how|rest)\b/;

/** The hash that parseRoute reads back as the same route. */
export function formatRoute(route: Route): string {
  switch (route.screen) {
    case "start":
      return "#/";
    case "new":
    case "relay":
      return formatPlant(route);
    case "identify":
      return route.job === null ? "#/identify" : `#/jobs/${encodeURIComponent(route.job)}/identify`;
    case "range":
      if (route.job !== null) return `#/jobs/${encodeURIComponent(route.job)}/range`;
      return route.example === "" ? "#/range" : `#/range/${encodeURIComponent(route.example)}`;
    case "check":
      return formatCheck(route);
    case "structure": {
      if (route.job !== null) return `#/jobs/${encodeURIComponent(route.job)}/structure`;
      const query = new URLSearchParams(route.values).toString();
      return `#/structure${route.id === "" ? "" : `/${encodeURIComponent(route.id)}`}${query ? `?${query}` : ""}`;
    }
    case "rules": {
      const query = new URLSearchParams(route.values).toString();
      return `#/rules${query ? `?${query}` : ""}`;
    }
    case "example":
      return `#/examples/${encodeURIComponent(route.id)}`;
    case "edit":
      return `#/jobs/${encodeURIComponent(route.job)}/edit`;
    case "docs":
      return route.call === "" ? "#/docs" : `#/docs/${encodeURIComponent(route.call)}`;
    case "methods":
      return route.id === "" ? "#/methods" : `#/methods/${encodeURIComponent(route.id)}`;
    case "jobs":
      return route.text === "" ? "#/jobs" : `#/jobs?q=${encodeURIComponent(route.text)}`;
    case "batch":
      return `#/batches/${encodeURIComponent(route.id)}${route.sort ? `?sort=${encodeURIComponent(route.sort)}` : ""}`;
    case "compare": {
      const rows = route.rows && route.rows.length > 0 ? `rows=${route.rows.join(".")}` : "";
      const Ms = route.rankMs ? `Ms=${route.rankMs}` : "";
      const query = [route.sort && `sort=${encodeURIComponent(route.sort)}`, rows, Ms].filter(Boolean).join("&");
      return `#/jobs/${encodeURIComponent(route.job)}/compare${query ? `?${query}` : ""}`;
    }
    case "design": {
      const query = new URLSearchParams({
        ...(route.entry === null ? {} : { entry: String(route.entry) }),
        ...route.values,
        ...Object.fromEntries(Object.entries(route.step ?? {}).map(([name, text]) => [STEP + name, text])),
      }).toString();
      return `#/jobs/${encodeURIComponent(route.job)}/design${query ? `?${query}` : ""}`;
    }
  }
}

/**
 * After Back or a link, the address belongs to another screen before the page follows: it must not be rewritten then,
 * or that step of the history would be lost.
 */
function stillAt(from: Route): boolean {
  const now = parseRoute(location.hash);
  const same = showsStart(from) ? showsStart(now) : now.screen === from.screen;
  if (from.screen === "check" && now.screen === "check") return sameCheck(from.of, now.of);
  return same && (!showsJob(from) || !showsJob(now) || from.job === now.job);
}

/** Rewrites the address without a step in the history. `from`: the screen that the page shows. */
export function rewriteAddress(from: Route, next: Route): void {
  if (stillAt(from)) history.replaceState(history.state, "", formatRoute(next));
}

/** What this entry of the history keeps, beside its address: it is there after Back and after a reload. */
export interface EntryState {
  /** How it filled the form. */
  fill?: string;
  /** The content of the form. */
  start?: StartTexts;
}

export const entryState = (): EntryState => (history.state ?? {}) as EntryState;

/** `from`: the screen that the page shows. */
export function keepInEntry(from: Route, state: EntryState): void {
  if (stillAt(from)) history.replaceState({ ...entryState(), ...state }, "");
}

/** Adds a step to the history without leaving the screen: Back leads to `before`. */
export function stepAddress(from: Route, before: Route, next: Route): void {
  if (!stillAt(from)) return;
  history.replaceState(history.state, "", formatRoute(before));
  history.pushState(null, "", formatRoute(next));
}

function decode(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}
