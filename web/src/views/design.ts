// Design: the verdict, the settings to enter, the figures and the plots of a job; its progress while it runs.
import { cancelJob } from "../api/jobs.ts";
import { isFinal } from "../api/types.ts";
import type { Job, Plant, Result, TuningRequest } from "../api/types.ts";
import { defaultDrawn, drawnEntries, entryNames } from "../charts/drawn.ts";
import type { Drawn } from "../charts/drawn.ts";
import { nyquistFrame } from "../charts/nyquist.ts";
import { recordFrame } from "../charts/record.ts";
import { responseFrame } from "../charts/responses.ts";
import { sensitivityFrame } from "../charts/sensitivities.ts";
import { h, mathElement } from "../dom.ts";
import { plantFormula } from "../form/formula.ts";
import { withLambda } from "../form/retune.ts";
import type { Frame } from "../plot/frame.ts";
import { createPlot } from "../plot/plot.ts";
import type { Plot } from "../plot/plot.ts";
import { swatch } from "../plot/swatch.ts";
import { formatRoute } from "../routes.ts";
import type { Store, Workspace } from "../store.ts";
import { figureGroups } from "../words/figures.ts";
import { commonLimits } from "../words/limits.ts";
import { unitNames } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { plantTitle, plantWords } from "../words/plant.ts";
import { figuresTable } from "./figures_table.ts";
import { createLegend } from "./legend.ts";
import { modelResult } from "./model_result.ts";
import { showComputed, showNotes } from "./notes.ts";
import { progressCard } from "./progress_card.ts";
import { rimcCard } from "./rimc_card.ts";
import { settingsCard } from "./settings_card.ts";
import type { View } from "./start.ts";
import { showFailure, showVerdict } from "./verdict_card.ts";

/** From so many entries on the column of the figures is broader, and from so many they stand across the page. */
const BROAD_FROM = 3;
const WIDE_FROM = 5;

export interface DesignEvents {
  onJob(job: Job): void;
  /** Tunes again and shows the answer in this one's place; throws where the entry of that index gets none. */
  onRetune(request: TuningRequest, index: number): Promise<void>;
}

export function designView(store: Store, announce: (sentence: string) => void, events: DesignEvents): View {
  const heading = h("h1", { tabindex: -1 }, "Design");
  const plantLine = h("p", { class: "hint" });
  const formula = h("div", { class: "formula small" });
  const editLink = h("a", { href: "#/" }, "Change the request");
  const recordLink = h("a", { href: "#/" }, "Look at the record");
  const titleCard = h(
    "section",
    { class: "card title" },
    heading,
    plantLine,
    formula,
    h("p", { class: "actions" }, editLink, recordLink),
  );
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const verdict = h("section", { class: "verdict", "aria-label": "Verdict" });
  const progress = progressCard(announce, () => void cancel());
  const settings = settingsCard(announce);
  const figures = h("section", { class: "card figures-card", "aria-labelledby": "figures-title" });
  const model = h("div", { class: "slot", hidden: true });
  const notes = h("section", { class: "card", "aria-labelledby": "notes-title" });
  const computed = h("section", { class: "card computed", "aria-labelledby": "computed-title" });
  const rimc = rimcCard(announce, retune);
  const legend = createLegend(store);
  const plotGrid = h("div", { class: "plots" });
  const side = h("div", { class: "side" }, settings.element, figures, model, notes, computed);
  const main = h("div", { class: "main-column" }, rimc.element, legend.element, plotGrid);
  const body = h("div", { class: "design-body" });
  const headRight = h("div", { class: "head-right" }, trouble, verdict, progress.element);
  const element = h(
    "main",
    { class: "design", id: "main" },
    h("div", { class: "design-head" }, titleCard, headRight),
    body,
  );
  const plots = new Map<string, Plot>();

  async function cancel(): Promise<void> {
    const job = store.get().job;
    if (!job) return;
    try {
      events.onJob(await cancelJob(job.id));
    } catch (error) {
      trouble.textContent = error instanceof Error ? error.message : String(error);
      trouble.hidden = false;
    }
  }

  /** The entry whose settings are shown. */
  function selectedEntry(result: Result, workspace: Workspace): number {
    const firstAnswer = result.controllers.findIndex((candidate) => !candidate.error);
    return Math.min(workspace.selected ?? Math.max(0, firstAnswer), result.controllers.length - 1);
  }

  async function retune(lambda: number): Promise<void> {
    const workspace = store.get();
    const { request, result } = workspace.job ?? {};
    if (!request || !result) return;
    const index = selectedEntry(result, workspace);
    await events.onRetune(withLambda(request, result, index, lambda), index);
  }

  function showHead(job: Job): void {
    const request = job.request;
    const plant = job.result?.model?.plant ?? request?.plant;
    heading.textContent = job.name || request?.name || "Design";
    plantLine.textContent = plant
      ? [...new Set([plantTitle(plant.type), plantWords(plant, unitNames(request?.units))])].join(": ")
      : "from a recorded test";
    const tree = plant && !job.result?.model && hasFormulaOnly(plant) ? plantFormula(plant) : null;
    formula.replaceChildren(...(tree ? [mathElement(tree)] : []));
    formula.hidden = tree === null;
    editLink.href = formatRoute({ screen: "edit", job: job.id });
    recordLink.href = formatRoute({ screen: "identify", job: job.id });
    recordLink.hidden = !request?.record;
  }

  function showFigures(result: Result, drawn: Drawn[], names: string[], units: UnitNames): void {
    const columns = result.controllers.map((entry, index) => {
      const shown = drawn.find((item) => item.index === index);
      return { name: names[index]!, entry, swatch: () => (shown ? swatch(shown.look) : null) };
    });
    const groups = figureGroups(
      units,
      result.controllers.some((entry) => entry.region),
    );
    const mainGroups = groups.filter((group) => group.main);
    const otherGroups = groups.filter((group) => !group.main);
    const open = figures.querySelector("details")?.open ?? false;
    figures.replaceChildren(
      h("h2", { id: "figures-title" }, "Figures"),
      figuresTable("Main figures", columns, mainGroups),
      h("details", { open }, h("summary", {}, "All figures"), figuresTable("All other figures", columns, otherGroups)),
    );
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

  function showPlots(job: Job, result: Result, drawn: Drawn[]): void {
    const request = job.request;
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
    const entries = result.controllers;
    const names = entryNames(entries);
    const units = unitNames(job.request?.units);
    const drawn = drawnEntries(result, workspace.drawn ?? defaultDrawn(result));
    const selected = selectedEntry(result, workspace);
    if (!side.isConnected) body.replaceChildren(side, main);
    element.classList.toggle("broad", entries.length >= BROAD_FROM && entries.length < WIDE_FROM);
    body.classList.toggle("wide", entries.length >= WIDE_FROM);
    showVerdict(verdict, job, result, names, selected);
    settings.show(entries[selected]!, names[selected]!, units);
    showFigures(result, drawn, names, units);
    rimc.show(entries[selected]!, result.model?.plant ?? job.request?.plant, units);
    model.hidden = !result.model;
    if (result.model && model.childElementCount === 0) model.replaceChildren(modelResult(result.model, units));
    showNotes(notes, entries, names);
    showComputed(computed, result, entries[selected]!, names, units);
    legend.show(entries, names, drawn, selected);
    showPlots(job, result, drawn);
  }

  let announced: Result | null = null;
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
    } else if (job.result && job.result.controllers.length > 0) {
      showResult(job, job.result, workspace);
      if (announced !== job.result) announce(verdict.textContent ?? "");
      announced = job.result;
    } else {
      body.replaceChildren();
      showFailure(verdict, job);
    }
  }

  show(store.get());
  const leave = store.subscribe(show);
  return {
    element,
    heading,
    dispose() {
      leave();
      rimc.dispose();
      for (const plot of plots.values()) plot.dispose();
    },
  };
}

/** Plants whose one-line words say less than their formula. */
const hasFormulaOnly = (plant: Plant): boolean => ["transfer_function", "zpk", "state_space"].includes(plant.type);
