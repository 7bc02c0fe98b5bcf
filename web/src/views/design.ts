// Design: the verdict, the settings to enter, the figures and the plots of a job; its progress while it runs.
import { cancelJob } from "../api/jobs.ts";
import { isFinal } from "../api/types.ts";
import type { Entry, Job, Model, Plant, Result, TuningRequest } from "../api/types.ts";
import { defaultDrawn, drawnEntries, entryNames, MOST_DRAWN } from "../charts/drawn.ts";
import type { Drawn } from "../charts/drawn.ts";
import { nyquistFrame } from "../charts/nyquist.ts";
import { recordFrame } from "../charts/record.ts";
import { responseFrame } from "../charts/responses.ts";
import { sensitivityFrame } from "../charts/sensitivities.ts";
import { h, mathElement, node, svgElement } from "../dom.ts";
import { plantFormula } from "../form/formula.ts";
import { lineOf } from "../plot/marks.ts";
import type { Frame, Look } from "../plot/frame.ts";
import { createPlot } from "../plot/plot.ts";
import type { Plot } from "../plot/plot.ts";
import { formatRoute } from "../routes.ts";
import type { Store, Workspace } from "../store.ts";
import { figureGroups } from "../words/figures.ts";
import { commonLimits } from "../words/limits.ts";
import { formatNumber, unitNames } from "../words/numbers.ts";
import { plantTitle, plantWords } from "../words/plant.ts";
import { verdictOf } from "../words/verdict.ts";
import { figuresTable } from "./figures_table.ts";
import { modelResult } from "./model_result.ts";
import { progressCard } from "./progress_card.ts";
import { settingsCard } from "./settings_card.ts";
import type { View } from "./start.ts";

/** From so many entries on the column of the figures is broader, and from so many they stand across the page. */
const BROAD_FROM = 3;
const WIDE_FROM = 5;

export function designView(store: Store, announce: (sentence: string) => void, onJob: (job: Job) => void): View {
  const heading = h("h1", { tabindex: -1 }, "Design");
  const plantLine = h("p", { class: "hint" });
  const formula = h("div", { class: "formula small" });
  const editLink = h("a", { href: "#/" }, "Change the request");
  const titleCard = h("section", { class: "card title" }, heading, plantLine, formula, h("p", { class: "actions" }, editLink));
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const verdict = h("section", { class: "verdict", "aria-label": "Verdict" });
  const progress = progressCard(announce, () => void cancel());
  const settings = settingsCard(announce);
  const figures = h("section", { class: "card figures-card", "aria-labelledby": "figures-title" });
  const model = h("div", { class: "slot", hidden: true });
  const notes = h("section", { class: "card", "aria-labelledby": "notes-title" });
  const computed = h("section", { class: "card computed", "aria-labelledby": "computed-title" });
  const legend = h("fieldset", { class: "legend" });
  const plotGrid = h("div", { class: "plots" });
  const body = h("div", { class: "design-body" });
  const element = h("main", { class: "design", id: "main" }, h("div", { class: "design-head" }, titleCard, h("div", { class: "head-right" }, trouble, verdict, progress.element)), body);
  const side = h("div", { class: "side" }, settings.element, figures, model, notes, computed);
  const main = h("div", { class: "main-column" }, legend, plotGrid);
  const plots = new Map<string, Plot>();

  async function cancel(): Promise<void> {
    const job = store.get().job;
    if (!job) return;
    try {
      onJob(await cancelJob(job.id));
    } catch (error) {
      trouble.textContent = error instanceof Error ? error.message : String(error);
      trouble.hidden = false;
    }
  }

  function showPlot(key: string, frame: Frame | null): void {
    const existing = plots.get(key);
    if (!frame) {
      existing?.element.remove();
      existing?.dispose();
      plots.delete(key);
      return;
    }
    if (existing) return existing.update(frame);
    const plot = createPlot(frame, announce);
    plots.set(key, plot);
    plotGrid.append(plot.element);
  }

  function showHead(job: Job): void {
    const request = job.request;
    const units = unitNames(request?.units);
    heading.textContent = job.name || request?.name || "Design";
    const plant = job.result?.model?.plant ?? request?.plant;
    plantLine.textContent = plant ? `${plantTitle(plant.type)}: ${plantWords(plant, units)}` : request?.record ? "from a recorded test" : "";
    const tree = plant && !job.result?.model && hasFormulaOnly(plant) ? plantFormula(plant) : null;
    formula.replaceChildren(...(tree ? [mathElement(tree)] : []));
    formula.hidden = tree === null;
    editLink.href = formatRoute({ screen: "edit", job: job.id });
  }

  function showFailure(job: Job): void {
    const error = job.error;
    const head = job.status === "cancelled" ? "Stopped before a controller was found." : "This could not be done.";
    verdict.className = "verdict bad";
    verdict.replaceChildren(
      h("h2", {}, head),
      h("p", {}, error?.detail ?? error?.title ?? (job.status === "cancelled" ? "Nothing is kept of it; the request is." : "The service gave no reason.")),
      (error?.errors ?? []).length > 0 ? h("ul", {}, (error?.errors ?? []).map((fault) => h("li", {}, fault.detail, h("code", {}, ` ${fault.pointer}`)))) : "",
    );
  }

  function showVerdict(result: Result, selected: number, names: string[], request: TuningRequest | undefined, status: Job["status"]): void {
    const entry = result.controllers[selected];
    if (!entry) return;
    const today = result.controllers.find((candidate) => candidate.method === "baseline");
    const words = verdictOf(entry, today, request);
    const sentences = [...words.sentences];
    if (status === "cancelled" || result.partial) sentences.unshift("Stopped early: this is the best found until then.");
    verdict.className = `verdict ${words.level}`;
    verdict.replaceChildren(h("h2", {}, result.controllers.length > 1 ? h("span", { class: "who" }, `${names[selected]}: `) : null, words.head), h("p", {}, sentences.join(" ")));
    const failures = result.controllers.flatMap((candidate, index) => (candidate.error && index !== selected ? [{ name: names[index]!, error: candidate.error }] : []));
    if (failures.length > 0) {
      verdict.append(h("ul", {}, failures.map(({ name, error }) => h("li", {}, h("strong", {}, `${name}: `), error.detail ?? error.title ?? "no answer"))));
    }
  }

  function showFigures(result: Result, drawn: Drawn[], names: string[], request: TuningRequest | undefined): void {
    const units = unitNames(request?.units);
    const columns = result.controllers.map((entry, index) => {
      const shown = drawn.find((item) => item.index === index);
      return { name: names[index]!, entry, swatch: () => (shown ? swatch(shown.look) : null) };
    });
    const groups = figureGroups(units);
    const open = figures.querySelector("details")?.open ?? false;
    figures.replaceChildren(
      h("h2", { id: "figures-title" }, "Figures"),
      figuresTable("Main figures", columns, groups.filter((group) => group.main)),
      h("details", { open }, h("summary", {}, "All figures"), figuresTable("All other figures", columns, groups.filter((group) => !group.main))),
    );
  }

  function showNotes(result: Result, names: string[]): void {
    const lines = result.controllers.flatMap((entry, index) => (entry.warnings ?? []).map((warning) => ({ name: names[index]!, warning })));
    notes.hidden = lines.length === 0;
    notes.replaceChildren(
      h("h2", { id: "notes-title" }, lines.length === 1 ? "1 note" : `${lines.length} notes`),
      h("ul", { class: "notes" }, lines.map(({ name, warning }) => h("li", {}, result.controllers.length > 1 ? h("strong", {}, `${name}: `) : null, warning.detail))),
    );
  }

  function showComputed(result: Result, entry: Entry, names: string[]): void {
    const binding = entry.robustness?.binding;
    const verification = Object.entries(entry.verification ?? {}).filter(([, value]) => value !== null);
    const facts: [string, string][] = [];
    if (entry.title) facts.push(["Method", entry.title]);
    if (entry.source) facts.push(["Source", entry.source]);
    if (entry.reduced_model) facts.push(["Reduced model", `${plantTitle(entry.reduced_model.type)}: ${plantWords(entry.reduced_model, unitNames(undefined))}`]);
    if (binding) facts.push(["Binding", binding]);
    for (const [name, value] of verification) facts.push([name.replaceAll("_", " "), typeof value === "number" ? formatNumber(value, 2) : value === true ? "yes" : value === false ? "no" : String(value)]);
    if (result.ranking && result.ranking.length > 1) facts.push(["Ranking", `${result.ranking.map((index) => names[index]).join(", ")}${result.ranking_by ? ` (${result.ranking_by})` : ""}`]);
    if (typeof entry.compute_ms === "number") facts.push(["Computed in", `${formatNumber(entry.compute_ms, 2)} ms`]);
    if (result.version) facts.push(["Version", result.version]);
    if (result.request_hash) facts.push(["Request hash", result.request_hash.slice(0, 16)]);
    const open = computed.querySelector("details")?.open ?? false;
    computed.replaceChildren(h("details", { open }, h("summary", { id: "computed-title" }, "How it was computed"), h("dl", {}, facts.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]))));
  }

  function showLegend(result: Result, drawn: Drawn[], names: string[], selected: number): void {
    const single = result.controllers.length === 1;
    legend.hidden = single;
    const indices = drawn.map((item) => item.index);
    legend.replaceChildren(
      h("legend", { class: "visually-hidden" }, "Which controllers to draw, and whose settings to show"),
      ...result.controllers.map((entry, index) => {
        const item = drawn.find((candidate) => candidate.index === index);
        const full = !item && indices.length >= MOST_DRAWN;
        const box = h("input", { type: "checkbox", checked: Boolean(item), disabled: full || Boolean(entry.error) || !(entry.responses || entry.frequency), "aria-label": `Draw ${names[index]}` });
        box.addEventListener("change", () => {
          const next = box.checked ? [...indices, index].sort((a, b) => a - b) : indices.filter((other) => other !== index);
          store.set((workspace) => ({ ...workspace, drawn: next }));
        });
        const choose = h("button", { type: "button", class: "quiet", "aria-pressed": String(index === selected), title: "Show its settings and verdict" }, item ? swatch(item.look) : null, names[index]!);
        choose.addEventListener("click", () => store.set((workspace) => ({ ...workspace, selected: index })));
        return h("span", { class: index === selected ? "legend-item selected" : "legend-item" }, box, choose);
      }),
      result.controllers.length > MOST_DRAWN ? h("span", { class: "hint" }, `At most ${MOST_DRAWN} are drawn.`) : "",
    );
  }

  function showPlots(drawn: Drawn[], result: Result, request: TuningRequest | undefined): void {
    const responses = drawn.some((item) => item.entry.responses);
    const frequency = drawn.some((item) => item.entry.frequency);
    const limits = commonLimits(drawn.map((item) => item.entry));
    showPlot("setpoint", responses ? responseFrame("setpoint", drawn, request) : null);
    showPlot("load", responses ? responseFrame("load", drawn, request) : null);
    showPlot("nyquist", frequency ? nyquistFrame(drawn, limits, request) : null);
    showPlot("sensitivities", frequency ? sensitivityFrame(drawn, limits, request) : null);
    showPlot("record", result.model ? recordFrame(result.model, request) : null);
  }

  function showResult(job: Job, result: Result, workspace: Workspace): void {
    const names = entryNames(result.controllers);
    const indices = workspace.drawn ?? defaultDrawn(result);
    const drawn = drawnEntries(result, indices);
    const answered = Math.max(0, result.controllers.findIndex((candidate) => !candidate.error));
    const selected = Math.min(workspace.selected ?? answered, result.controllers.length - 1);
    const entry = result.controllers[selected];
    if (!entry) return;
    const focused = document.activeElement instanceof HTMLElement && legend.contains(document.activeElement) ? controlsOf(legend).indexOf(document.activeElement) : -1;
    if (!side.isConnected) body.replaceChildren(side, main);
    const entries = result.controllers.length;
    element.classList.toggle("broad", entries >= BROAD_FROM && entries < WIDE_FROM);
    body.classList.toggle("wide", entries >= WIDE_FROM);
    showVerdict(result, selected, names, job.request, job.status);
    settings.show(entry, names[selected]!, unitNames(job.request?.units));
    showFigures(result, drawn, names, job.request);
    showModel(model, result.model, job);
    showNotes(result, names);
    showComputed(result, entry, names);
    showLegend(result, drawn, names, selected);
    if (focused >= 0) controlsOf(legend)[focused]?.focus();
    showPlots(drawn, result, job.request);
  }

  let resultShown: Result | null = null;
  function show(workspace: Workspace): void {
    const job = workspace.job;
    trouble.hidden = workspace.jobTrouble === "";
    trouble.textContent = workspace.jobTrouble;
    progress.element.hidden = !job || isFinal(job.status);
    verdict.hidden = !job || !isFinal(job.status);
    titleCard.hidden = !job;
    if (!job) return;
    showHead(job);
    if (!isFinal(job.status)) {
      progress.show(job);
      return;
    }
    if (job.result && job.result.controllers.length > 0) {
      showResult(job, job.result, workspace);
      if (resultShown !== job.result) announce(verdict.textContent ?? "");
      resultShown = job.result;
    } else {
      body.replaceChildren();
      showFailure(job);
    }
  }

  show(store.get());
  const leave = store.subscribe(show);
  return {
    element,
    heading,
    dispose() {
      leave();
      for (const plot of plots.values()) plot.dispose();
    },
  };
}

function showModel(slot: HTMLElement, identified: Model | undefined, job: Job): void {
  slot.hidden = !identified;
  if (identified && slot.childElementCount === 0) slot.replaceChildren(modelResult(identified, unitNames(job.request?.units)));
}

const controlsOf = (element: HTMLElement): HTMLElement[] => [...element.querySelectorAll<HTMLElement>("input, button")];

/** Plants whose one-line words say less than their formula. */
const hasFormulaOnly = (plant: Plant): boolean => ["transfer_function", "zpk", "state_space"].includes(plant.type);

function swatch(look: Look): Element {
  return svgElement(node("svg", { width: 28, height: 10, viewBox: "0 0 28 10", "aria-hidden": "true", focusable: "false" }, node("path", { d: "M1 5H27", fill: "none", ...lineOf(look) })));
}
