// Design: the verdict, the settings to enter, the figures and the plots of a job; its progress while it runs.
import { cancelJob } from "../api/jobs.ts";
import { isRangeRequest } from "../api/range.ts";
import { isFinal, nameOf } from "../api/types.ts";
import type { Entry, Job, Result, TuningRequest } from "../api/types.ts";
import { defaultDrawn, defaultOverlay, drawable, drawnEntries, entryNames, proposedEntry } from "../charts/drawn.ts";
import type { Drawn } from "../charts/drawn.ts";
import { recordFrame } from "../charts/record.ts";
import { LINEAR_NOTE, hasLinear } from "../charts/responses.ts";
import { h, keepFocus } from "../dom.ts";
import { readStep } from "../form/own_step.ts";
import type { StepTexts } from "../form/own_step.ts";
import { asksForAll, withCertificate, withLambda, withOwnStep } from "../form/tuning_request.ts";
import { plotGrid } from "../plot/grid.ts";
import { swatch } from "../plot/marks.ts";
import { rangeJobCard } from "../range/job_result.ts";
import { showRangeVerdict } from "../range/result_cards.ts";
import { formatRoute, rewriteAddress } from "../routes.ts";
import { shown } from "../store.ts";
import type { Store, Workspace } from "../store.ts";
import { figureGroups } from "../words/figures.ts";
import { unitNames } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { running } from "../words/running.ts";
import { cureButtons } from "./cures.ts";
import { operatingCard } from "./cards/operating_card.ts";
import { ownStepCard } from "./cards/own_step_card.ts";
import { progressCard } from "./cards/progress_card.ts";
import { replayCard } from "./cards/replay_card.ts";
import { reportCards, type ReportCard } from "./cards/report_cards.ts";
import { titleCard } from "./cards/title_card.ts";
import { isOfUltimate, showUltimate } from "./cards/ultimate_card.ts";
import { showFailure, showVerdict } from "./cards/verdict_card.ts";
import { createLegend } from "./drawn_entries.ts";
import { showEntryPlots } from "./entry_plots.ts";
import { figuresTable } from "./figures_table.ts";
import { jobActions } from "./job_actions.ts";
import type { JobEvents } from "./job_actions.ts";
import { modelResult } from "./model_result.ts";
import { showComputed, showNotes } from "./notes.ts";
import { ownController } from "./own_controller.ts";
import type { View } from "./start.ts";
import { modifiedDesign } from "./modified_design.ts";
import type { OnScreen } from "./modified_design.ts";

/** From this number of entries on, the figures are below the plots, across the page. */
const BROAD_FROM = 3;

/** For a job with more entries only those that are drawn or chosen are listed here: its comparison has them all. */
const MAX_LISTED = 8;

function listedEntries(count: number, drawn: Drawn[], selected: number): number[] {
  const every = [...Array(count).keys()];
  if (count <= MAX_LISTED) return every;
  return every.filter((index) => index === selected || drawn.some((item) => item.index === index));
}

/** A large comparison begins here with the rows that are ticked in its table. */
const drawnFirst = (result: Result): number[] =>
  result.controllers.length > MAX_LISTED ? defaultOverlay(result) : defaultDrawn(result);

/** The proposal from which a design was moved, in a look of its own; null if it is not drawn, or none is free. */
function proposalOf(entry: Entry, drawn: readonly Drawn[], index: number): Drawn | null {
  const look = ([3, 4, 2, 1] as const).find((free) => drawn.every((item) => item.look !== free));
  if (!look || !drawable(entry) || drawn.every((item) => item.index !== index)) return null;
  return { index: -1, name: "proposal", look, entry };
}

export interface DesignEvents extends JobEvents {
  /** Tunes another request and shows that job. */
  onTune(request: TuningRequest): Promise<void>;
  /** Tunes again and replaces this result; throws if the entry with that index gets none. */
  onRetune(request: TuningRequest, index: number, onWaiting: (job: Job) => void): Promise<Job | null>;
}

export function designView(store: Store, announce: (sentence: string) => void, events: DesignEvents): View {
  const comparison = h("a", { href: "#/" }, "Comparison table");
  const { all, trouble, cancel, complain } = jobActions(store, events, "quiet", () => (screenOf === store.get().job?.id ? screen?.request : undefined));
  const title = titleCard("Design", announce, comparison, all);
  const verdict = h("section", { class: "verdict", "aria-label": "Verdict" });
  const cures = cureButtons((request) => events.onTune(request).catch(complain));
  const range = rangeJobCard(announce);
  const progress = progressCard(announce, () => void (waiting ? cancelJob(waiting.id).catch(complain) : cancel()));
  /** The job that is to replace the displayed one. */
  let waiting: Job | null = null;
  let mainFigures: HTMLElement = h("div", {});
  let otherFigures: HTMLElement = h("div", {});
  const ofController = h("p", { class: "hint", hidden: true }, "On your controller, with its own rules and rounding.");
  const figures = h(
    "section",
    { class: "card figures-card", "aria-labelledby": "figures-title" },
    h("h2", { id: "figures-title" }, "Figures"),
    ofController,
    mainFigures,
    h("details", {}, h("summary", {}, "All figures"), otherFigures),
  );
  const model = h("div", { class: "slot", hidden: true });
  const notes = h("section", { class: "card", "aria-labelledby": "notes-title" });
  const computed = h("section", { class: "card computed", "aria-labelledby": "computed-title" });
  const own = ownController(store, {
    announce,
    retune: retuneWhole,
    onByHand: (settings) => modified.setByHand(settings),
    onJudged(entry) {
      if (entry === null && judged === null) return;
      judged = entry;
      if (finished) showMoving(finished.job, finished.result, store.get(), false);
    },
    onReading: (reading) => modified.waitFor(reading),
  });
  const reports = reportCards(announce, { onRetune: retune, onProve: prove, onTry: own.follow });
  const reportsAt = (place: ReportCard["place"]) => reports.filter((card) => card.place === place).map((card) => card.element);
  const legend = createLegend(store);
  const plots = plotGrid(announce);
  const replay = replayCard(plots);
  const ownStep = ownStepCard({
    announce,
    onChange: changeStep,
    onJudged: () => sayVerdict(),
    onKeep: keepStep,
  });
  const linearNote = h("p", { class: "hint", hidden: true }, LINEAR_NOTE);
  let finished: { job: Job; result: Result } | null = null;
  let screen: OnScreen | null = null;
  /** The displayed controller in a product for which it was not designed. */
  let judged: Entry | null = null;
  /** The job on the cards. */
  let screenOf = "";
  /** Shows the verdict, with what it says of the step that was typed. */
  let sayVerdict = (): void => undefined;
  const said = h("div", { class: "verdict-column" }, trouble, verdict, cures.element, progress.element, range.element, legend.element);
  const head = h("div", { class: "design-head" }, own.answer, said);
  const modified = modifiedDesign(store, announce, {
    onAnswer: showModified,
    onLate: (late) => {
      plots.setBusy(late);
      for (const part of [verdict, figures, own.answer]) part.classList.toggle("late", late);
    },
    onHold: holdStill,
    onKeep: async (request, index) => {
      const job = await replace(withStep(request), index, "Keeping this design");
      return job && { job, index };
    },
  });
  const main = h("div", { class: "main-column" }, linearNote, plots.element);
  const aside = h("div", { class: "side" }, figures);
  const more = h(
    "details",
    { class: "more", open: store.get().mine !== null },
    h("summary", {}, "More: code, how my controller computes, set point against load, how it was computed"),
    h("div", { class: "more-cards" }, ...reportsAt("below"), ...own.below, computed),
  );
  const followsLater = h("p", { class: "hint", hidden: true }, "The figures below follow when you release the slider.");
  const below = h("div", { class: "below" }, followsLater, replay.element, model, ...reportsAt("above"), notes, h("div", { class: "folds" }, ownStep.element, ...reportsAt("folded"), more));
  const left = h("div", { class: "left-column" }, modified.controls, modified.front);
  const element = h("main", { class: "design", id: "main" }, title.element, head, left);
  const bodyParts = [main, aside, below];

  /** Everything below the verdict, and the settings next to it. */
  function showBody(there: boolean): void {
    for (const part of [own.answer, legend.element, modified.controls, modified.front]) part.classList.toggle("absent", !there);
    if (!there) for (const part of bodyParts) part.remove();
    else if (!main.isConnected) element.append(...bodyParts);
  }

  /** While a slider or a curve is held nothing above the plots changes its height, so that they stay under the
      pointer. */
  function holdStill(held: boolean): void {
    plots.hold(held);
    const above = [title.element, head];
    const heights = held ? above.map((part) => part.getBoundingClientRect().height) : [];
    above.forEach((part, index) => {
      if (held && part.style.height !== "") return;
      part.style.height = held ? `${heights[index]}px` : "";
      part.classList.toggle("still", held);
    });
  }

  /** The entry whose settings are shown. */
  function selectedEntry(result: Result, workspace: Workspace): number {
    return Math.min(workspace.selected ?? proposedEntry(result), result.controllers.length - 1);
  }

  async function retune(lambda: number): Promise<void> {
    if (!finished || !screen) return;
    const request = screen.request ?? {};
    const index = asksForAll(request.tune) ? 0 : screen.index;
    await replace(withLambda(request, screen.result, screen.index, lambda, store.get().methods), index);
  }

  async function prove(gap: number): Promise<void> {
    if (!finished || !screen) return;
    const request = screen.request ?? {};
    const index = asksForAll(request.tune) ? 0 : screen.index;
    await replace(withCertificate(request, screen.result, screen.index, gap), index, "Proving");
  }

  /** Designs again in this job's place; a search that takes long shows its progress, and can be stopped. */
  async function replace(request: TuningRequest, index: number, what = ""): Promise<Job | null> {
    const showWaiting = (job: Job | null): void => {
      waiting = job;
      progress.element.hidden = !job;
      if (job) progress.show(job, what);
    };
    try {
      return await events.onRetune(request, index, showWaiting);
    } finally {
      showWaiting(null);
    }
  }

  /** With the step that was typed. */
  function withStep(request: TuningRequest): TuningRequest {
    const { step: texts } = store.get();
    const step = texts && readStep(texts).step;
    return step ? withOwnStep(request, step) : request;
  }

  /** The address follows the step as typed. */
  function changeStep(step: StepTexts | null): void {
    const { route } = store.get();
    if (route.screen !== "design") return;
    const { step: _before, ...bare } = route;
    const next = { ...bare, ...(step ? { step } : {}) };
    store.set((workspace) => ({ ...workspace, step, route: next }));
    rewriteAddress(route, next);
  }

  async function keepStep(): Promise<void> {
    const step = ownStep.step();
    if (!screen || !step) return;
    await replace(withOwnStep(screen.request ?? {}, step), modified.answer()?.kept ?? screen.index);
  }

  async function retuneWhole(request: TuningRequest): Promise<void> {
    if (screen) await replace(request, screen.index);
  }

  function showFigures(
    result: Result,
    listed: number[],
    drawn: Drawn[],
    before: Drawn | null,
    names: string[],
    units: UnitNames,
    held: boolean,
  ): void {
    const columns = listed.map((index) => {
      const shown = drawn.find((item) => item.index === index);
      const entry = running(result.controllers[index]!);
      return { name: names[index]!, entry, swatch: () => (shown ? swatch(shown.look) : null) };
    });
    const room = listed.length + 1 < BROAD_FROM || element.classList.contains("broad");
    if (before && room) columns.push({ name: before.name, entry: before.entry, swatch: () => swatch(before.look) });
    const groups = figureGroups(
      units,
      columns.some(({ entry }) => entry.region),
      columns.some(({ entry }) => entry.controller?.form === "npid"),
    );
    keepFocus(figures, () => {
      const main = figuresTable("Main figures", columns, groups.filter((group) => group.main));
      mainFigures.replaceWith(main);
      mainFigures = main;
      ofController.hidden = !columns.some(({ entry }) => entry.implemented);
      // Folded parts are updated on release.
      if (held) return;
      const others = figuresTable("All other figures", columns, groups.filter((group) => !group.main));
      otherFigures.replaceWith(others);
      otherFigures = others;
    });
  }

  /** With the loop of the product into which the settings are to be typed, where it is not that of the job. */
  function asTyped(result: Result, index: number): Result {
    const entry = result.controllers[index]!;
    if (!judged || JSON.stringify(judged.controller) !== JSON.stringify(entry.controller)) return result;
    const { implemented, verdict = [], warnings = [] } = judged;
    const typed = { ...entry, verdict, warnings, ...(implemented ? { implemented } : {}) };
    return { ...result, controllers: result.controllers.map((other, at) => (at === index ? typed : other)) };
  }

  /** Moving an entry does not change the arrangement. */
  const isBroad = (whole: Result, workspace: Workspace): boolean => {
    const drawn = drawnEntries(whole, workspace.drawn ?? drawnFirst(whole));
    return listedEntries(whole.controllers.length, drawn, selectedEntry(whole, workspace)).length >= BROAD_FROM;
  };

  /** Updates the parts that follow a slider: verdict, settings, figures and plots. */
  function showMoving(job: Job, whole: Result, workspace: Workspace, held: boolean): { drawn: Drawn[]; before: Drawn | null } {
    const modifiedNow = modified.onScreen(job, whole, selectedEntry(whole, workspace));
    screen = { ...modifiedNow, request: modifiedNow.request && withStep(modifiedNow.request) };
    const { index, origin } = screen;
    title.setShown(screen, screen.result === whole && !workspace.step);
    const result = asTyped(screen.result, index);
    const entries = result.controllers;
    const names = namesNow(whole, origin);
    const units = unitNames(job.request?.units);
    const drawn = drawnNow(whole, workspace);
    const listed = listedEntries(entries.length, drawn, index);
    const before = screen.result === whole ? null : proposalOf(whole.controllers[selectedEntry(whole, workspace)]!, drawn, index);
    const record = formatRoute({ screen: "identify", job: job.id });
    sayVerdict = () => keepFocus(verdict, () => showVerdict(verdict, ownStep.judged(result), names, index, listed, record, units));
    sayVerdict();
    if (held) own.move(ownShown(job, whole, index, names[index]!, units));
    showFigures(result, listed, drawn, before, names, units, held);
    linearNote.hidden = !hasLinear(drawn);
    plots.setSubject(nameOf(job));
    showEntryPlots(plots, drawn, job.request, { index, grips: modified.grips(), before });
    replay.show(whole, drawn, units);
    return { drawn, before };
  }

  /** The entries have the names of the job's, also after they moved. */
  function namesNow(whole: Result, origin: number[]): string[] {
    const names = entryNames(whole.controllers);
    return origin.map((index) => names[index]!);
  }

  /** The drawn entries of the job with the newest answer, each in its own look; if two replace one, the first. */
  function drawnNow(whole: Result, workspace: Workspace): Drawn[] {
    const { result, origin } = screen!;
    return drawnEntries(whole, workspace.drawn ?? drawnFirst(whole)).flatMap((item) => {
      const index = origin.indexOf(item.index);
      const entry = result.controllers[index];
      return drawable(entry) ? [{ ...item, index, entry: entry! }] : [];
    });
  }

  const ownShown = (job: Job, whole: Result, index: number, name: string, units: UnitNames) => ({
    job,
    request: screen!.request ?? {},
    result: screen!.result,
    index,
    name,
    units,
    code: screen!.result === whole ? index : null,
    mark: modified.mark(),
    typeable: modified.isMovable(),
    isCurrent: () => modified.isCurrent(),
  });

  function showResult(job: Job, whole: Result, workspace: Workspace): void {
    const selected = selectedEntry(whole, workspace);
    screenOf = job.id;
    modified.show(job, whole, selected);
    showBody(true);
    element.classList.toggle("broad", isBroad(whole, workspace));
    const { drawn, before } = showMoving(job, whole, workspace, false);
    const { result, index, origin } = screen!;
    const entries = result.controllers;
    const names = namesNow(whole, origin);
    const units = unitNames(job.request?.units);
    // The record does not change while a slider moves.
    plots.show("record", result.model ? recordFrame(result.model, job.request) : null);
    ownStep.show({ request: job.request ?? {}, whole, result, drawn, index, units, subject: nameOf(job), texts: workspace.step });
    const listed = listedEntries(entries.length, drawn, index);
    // Rules and robustness of a nonlinear plant use its linear model.
    const linear = result.model?.plant ?? result.linear_model ?? job.request?.plant;
    const reported = { name: names[index]!, entry: entries[index]!, model: linear, request: job.request, stored: result === whole ? { job: job.id, index } : null, units };
    for (const card of reports) card.show(reported);
    own.show(ownShown(job, whole, index, names[index]!, units));
    if (model.childElementCount === 0) {
      const about = result.model ? modelResult(result.model, units) : operatingCard(result, job.request);
      model.replaceChildren(...(about ? [about] : []));
    }
    model.hidden = model.childElementCount === 0;
    showNotes(
      notes,
      listed.map((at) => entries[at]!),
      listed.map((at) => names[at]!),
    );
    showComputed(computed, result, entries[index]!, names, units);
    legend.show({ entries, listed, names, drawn, selected: index, origin, before });
  }

  /** An answer to the sliders is drawn when it arrives, not in a later frame; parts below are updated on release. */
  function showModified(held: boolean): void {
    if (!finished) return;
    const { job, result } = finished;
    const workspace = store.get();
    followsLater.hidden = !held;
    below.classList.toggle("late", held);
    if (!held) showResult(job, result, workspace);
    else showMoving(job, result, workspace, true);
    if (!held && modified.answer()) announce(verdict.textContent ?? "");
  }

  let announced: Result | null = null;
  function show(workspace: Workspace): void {
    const job = workspace.job;
    trouble.hidden = workspace.jobTrouble === "";
    trouble.textContent = workspace.jobTrouble;
    progress.element.hidden = !waiting && (!job || isFinal(job.status));
    verdict.hidden = !job || !isFinal(job.status);
    title.show(job, job?.result?.controllers?.length ? selectedEntry(job.result, workspace) : null);
    cures.show(job);
    if (!job) return;
    comparison.href = formatRoute({ screen: "compare", job: job.id, sort: workspace.sort, rows: workspace.drawn });
    comparison.hidden = (job.result?.controllers?.length ?? 0) < 2;
    all.hidden = !comparison.hidden || isRangeRequest(job.request);
    range.element.hidden = !job.result?.range;
    finished = null;
    if (!isFinal(job.status)) {
      // The cards still show the previous job.
      if (screenOf !== job.id) showBody(false);
      progress.show(job);
    } else if (job.result?.range) {
      showRangeVerdict(verdict, job.result.range);
      range.show(job, job.result.range);
      announce(verdict.textContent ?? "");
    } else if (job.result && isOfUltimate(job.request)) {
      showBody(false);
      comparison.hidden = all.hidden = true;
      showUltimate(verdict, job.result, unitNames(job.request?.units));
      announce(verdict.textContent ?? "");
    } else if (job.result && job.result.controllers.length > 0) {
      finished = { job, result: job.result };
      showResult(job, job.result, workspace);
      if (announced !== job.result) announce(verdict.textContent ?? "");
      announced = job.result;
    } else {
      showBody(false);
      showFailure(verdict, job);
    }
  }

  const parts = (["job", "jobTrouble", "selected", "drawn", "sort", "step"] as const).map((name) =>
    store.pick((workspace) => workspace[name]),
  );
  showBody(false);
  const leave = shown(
    () => parts.map((part) => part.value),
    () => show(store.get()),
  );
  return {
    element,
    heading: title.heading,
    dispose() {
      leave();
      modified.dispose();
      for (const card of reports) card.dispose();
      own.dispose();
      ownStep.dispose();
      range.dispose();
      plots.dispose();
    },
  };
}
