// Identify: a recorded test, the models that explain it, its quality, and the part of it that is used.
import { ApiError } from "../api/client.ts";
import { identify } from "../api/plants.ts";
import { previewRecord } from "../api/records.ts";
import { latest, newest } from "../api/latest.ts";
import type { FieldError, IdentifyRequest, Model, RecordedTest } from "../api/types.ts";
import { bareRecordFrame, identifiedFrame } from "../charts/identified.ts";
import { stepParts } from "../charts/record.ts";
import type { Samples } from "../charts/record.ts";
import { h } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { csvOf, recordFields, samplesOf } from "../form/record_fields.ts";
import { previewPanel } from "../form/record_preview.ts";
import { atRecordText, recordText } from "../form/record_text.ts";
import { tuneSubject } from "../form/tuning_request.ts";
import type { TuneSubject } from "../form/tuning_request.ts";
import { createPlot } from "../plot/plot.ts";
import type { Plot } from "../plot/plot.ts";
import { formatNumber, unitNames } from "../words/numbers.ts";
import { structureTitle } from "../words/plant.ts";
import { qualityOf, timeUnitDoubt } from "../words/quality.ts";
import { candidatesCard } from "./cards/candidates_card.ts";
import type { CandidateChoice } from "./cards/candidates_card.ts";
import { cycleCard } from "./cards/cycle_card.ts";
import { partCard } from "./cards/part_card.ts";
import { qualityCard } from "./cards/quality_card.ts";
import { requestMenu } from "./request_menu.ts";
import type { View } from "./start.ts";

/** Options for tuning the record. */
export interface TuningChoice {
  /** The cards of the controller and of today's settings. */
  ofLoop: HTMLElement;
  /** Names of the methods chosen on Start. */
  methods: string[];
  first: CandidateChoice;
}

export interface IdentifyEvents {
  /** The record and the options for reading it, whenever the reader changes something. */
  onChange(request: IdentifyRequest): void;
  /** The record of a loop in automatic, as it was identified; null: of another. */
  onLoop(record: RecordedTest | null): void;
  /** Starts a tuning job; returns the faults that prevent it. */
  /** `all`: by every method. */
  onTune(subject: TuneSubject, all: boolean): Promise<FieldError[]>;
  /** The choice among its results. */
  onRemember(choice: CandidateChoice): void;
}

export function identifyView(
  given: IdentifyRequest,
  tuning: TuningChoice,
  announce: (sentence: string) => void,
  events: IdentifyEvents,
): View {
  const units = unitNames(given.units);
  const errors = new FormErrors();
  let model: Model | null = null;
  // The request of the displayed model; the fields may have changed since.
  let answered: IdentifyRequest | null = null;
  // The record beyond the used part, from the answer about all of it.
  let whole: Samples | null = null;
  let samples = samplesOf(given.record);
  const givenText = csvOf(given.record);
  /** The text and the reading of the current extent; null before any request. */
  let askedExtent: [text: string, reading: string] | null = null;
  let plot: Plot | null = null;
  let plotTitle = "";
  const beginLook = newest();

  const heading = h("h1", { tabindex: -1 }, given.name ? `Identify: ${given.name}` : "Identify");
  const busy = h("p", { class: "hint busy", hidden: true }, "Fitting models to the record...");
  const text = recordText(
    {
      label: "The record as text",
      hint: "One row per sample: time, controller output u, measurement y.",
      rows: 8,
      wide: true,
      pointer: () => "/record/csv",
      value: givenText,
    },
    errors,
  );
  const fields = recordFields(errors, true);
  const shown = h("div", { class: "preview-slot" });
  const again = h("button", { type: "submit" }, "Identify again");
  const reading = h(
    "form",
    { class: "card reading", novalidate: true },
    h(
      "details",
      {},
      h("summary", {}, "How the record is read: columns, kind of test, model, method"),
      h("div", { class: "stack" }, shown, fields.elements, text.element, h("div", { class: "actions" }, again)),
    ),
  );
  const slot = h("div", { class: "record-slot" });
  const sentence = h("p", { class: "hint input-words" });
  const part = partCard(errors, draw, () => ask());
  part.setUnit(units.time);
  const record = h(
    "div",
    { class: "record-column" },
    h("h2", { class: "visually-hidden" }, "The record"),
    slot,
    part.element,
    sentence,
    tuning.ofLoop,
  );
  const candidates = candidatesCard(tuning.methods, tuning.first, {
    onRemember: events.onRemember,
    onChoose() {
      draw();
      const chosen = candidates.chosen();
      if (chosen) announce(`${structureTitle(chosen.plant)}, fit ${formatNumber(chosen.fit_percent)} %.`);
    },
    onTune: (all) => void tune(all),
  });
  const quality = qualityCard();
  const unitDoubt = h("p", { class: "trouble", role: "status" });
  const chooseUnit = h("button", { type: "button", onclick: () => fields.askUnit() }, "Choose the unit");
  const doubt = h("div", { class: "unit-doubt", hidden: true }, unitDoubt, chooseUnit);
  const cycle = cycleCard();
  const side = h("div", { class: "side" }, doubt, candidates.element, quality.element);
  const body = h("div", { class: "identify-body" }, record, side, cycle.element);
  const menu = requestMenu(announce);
  menu.show("", null);
  const element = h(
    "main",
    { class: "identify", id: "main" },
    h("div", { class: "identify-head" }, heading, busy, menu.element),
    errors.summary,
    reading,
    body,
  );
  body.hidden = true;

  function request(): { request: IdentifyRequest; errors: FieldError[] } {
    const read = fields.read();
    const chosen = part.read();
    // Unchanged text stands for the record as received.
    const base = text.read() === givenText ? samples : { csv: text.read() };
    return {
      request: { ...given, record: { ...base, ...read.record, ...(chosen ?? {}) }, identify: read.identify },
      errors: [...read.errors, ...part.faults()],
    };
  }

  const calls = latest<IdentifyRequest, Model>(identify, {
    onBusy(now) {
      busy.hidden = !now;
      element.toggleAttribute("data-busy", now);
      candidates.setBusy(now);
    },
    onAnswer(answer, asked) {
      errors.clear();
      model = answer;
      answered = asked;
      menu.show("v1/identify", asked);
      // In automatic the controller moves u, so that no move is a step by itself.
      const { closed_loop, move_times = [] } = answer.data_quality ?? {};
      if (isWhole(asked)) takeWhole(answer.fit, closed_loop ? [] : move_times);
      body.hidden = false;
      side.hidden = false;
      candidates.show(answer, units);
      quality.show(answer, units);
      unitDoubt.textContent = timeUnitDoubt(answer);
      doubt.hidden = unitDoubt.textContent === "";
      cycle.show(answer.limit_cycle, answer.ultimate_point, answer.frequency_points, units);
      const words = qualityOf(answer, units);
      sentence.textContent = words.input;
      draw();
      events.onLoop(answer.data_quality?.closed_loop ? asked.record : null);
      announce(`${structureTitle(answer.plant)}, fit ${formatNumber(answer.fit_percent)} %. ${words.head}`);
    },
    onError(error, asked) {
      const problem = error instanceof ApiError ? error.problem : {};
      const pointed = atRecordText(problem.errors ?? []).filter((fault) => fault.pointer !== "/record");
      model = null;
      events.onLoop(null);
      side.hidden = true;
      cycle.show(undefined, undefined, [], units);
      sentence.textContent = "Choose a part of it that a model can explain, or another model or method above.";
      if (isWhole(asked)) takeWhole(problem.record, problem.record?.move_times ?? []);
      body.hidden = whole === null;
      draw();
      if (!whole) void look();
      if (!whole) reading.querySelector("details")!.open = true;
      errors.fail(error, pointed);
    },
  });

  /** The record and the options that determine its times. */
  function extentKey(): [text: string, reading: string] {
    const { run, columns, time_unit, dt } = fields.read().record;
    return [text.read(), JSON.stringify([run, columns?.t, time_unit, dt])];
  }

  /** Another record, or run, has another extent: a part chosen in the previous one is not meaningful in it. */
  function forgetPart(): void {
    const key = extentKey();
    if (askedExtent !== null && (key[0] !== askedExtent[0] || key[1] !== askedExtent[1])) {
      whole = null;
      part.clear();
    }
    askedExtent = key;
  }

  function ask(): void {
    forgetPart();
    const now = request();
    errors.clear();
    if (now.errors.length > 0) return errors.show(now.errors);
    events.onChange(now.request);
    calls.send(now.request);
  }

  /** Requests the preview of the text, when it is needed. */
  async function look(): Promise<void> {
    const isNewest = beginLook();
    if (text.read().trim() === "") return;
    try {
      const preview = await previewRecord({ ...fields.read().record, csv: text.read() });
      if (!isNewest()) return;
      shown.replaceChildren(previewPanel(preview));
      fields.offer(preview);
    } catch {
      // The identification reports the fault.
    }
  }

  const isWhole = (asked: IdentifyRequest): boolean => asked.record.from === undefined && asked.record.to === undefined;

  /** `moves`: the times at which u moves. */
  function takeWhole(record: Samples | undefined, moves: readonly number[]): void {
    const { t = [], y = [], u } = record ?? {};
    if (t.length < 2) return;
    whole = { t, y, ...(u ? { u } : {}) };
    part.setExtent({ from: t[0]!, to: t[t.length - 1]! });
    part.setSteps(stepParts(t, moves));
  }

  function draw(): void {
    const frame = model
      ? identifiedFrame(model, candidates.chosen(), units, whole, part.read())
      : whole && bareRecordFrame(whole, units, part.read());
    if (!frame) return;
    frame.brush = (from, to) => {
      part.set({ from, to });
      draw();
      ask();
    };
    // With and without a model they are different plots: other panes, another legend.
    if (plot && plotTitle === frame.title) return plot.update(frame);
    plot?.dispose();
    plot = createPlot(frame, announce);
    plotTitle = frame.title;
    plot.element.classList.add("tall");
    slot.replaceChildren(plot.element);
  }

  async function tune(all: boolean): Promise<void> {
    if (!model || !answered) return;
    errors.clear();
    candidates.setBusy(true);
    try {
      const subject = tuneSubject(answered, model, candidates.chosen());
      const uncertainty = candidates.onRegion() ? ("identified" as const) : undefined;
      const faults = await events.onTune("plant" in subject ? subject : { ...subject, uncertainty }, all);
      if (faults.length > 0) errors.show(faults);
    } catch (error) {
      const problem = error instanceof ApiError ? error.problem : {};
      errors.fail(error, atRecordText(problem.errors ?? []));
    } finally {
      candidates.setBusy(false);
    }
  }

  fields.load(given.record, given.identify);
  // A choice applies at once; typed text waits until it is complete.
  reading.addEventListener("change", (event) => {
    void look();
    if (event.target instanceof HTMLSelectElement) ask();
  });
  reading.querySelector("details")!.addEventListener("toggle", () => {
    if (shown.childElementCount === 0) void look();
  });
  reading.addEventListener("submit", (event) => {
    event.preventDefault();
    ask();
  });

  const { from, to } = given.record;
  if (from !== undefined || to !== undefined) void askWithPart(from, to);
  else ask();

  /** A record with a chosen part: all of it is requested first, so that it can be drawn. */
  async function askWithPart(start: number | undefined, end: number | undefined): Promise<void> {
    const { from: _from, to: _to, ...record } = given.record;
    try {
      const { fit, data_quality } = await identify({ ...given, record });
      takeWhole(fit, data_quality?.move_times ?? []);
    } catch (error) {
      // The whole record cannot be identified, but the part may be.
      if (error instanceof ApiError) takeWhole(error.problem.record, error.problem.record?.move_times ?? []);
    }
    if (!whole) part.setExtent({ from: start ?? 0, to: end ?? (start ?? 0) + 1 });
    part.set({ from: start ?? -Infinity, to: end ?? Infinity });
    ask();
  }

  return {
    element,
    heading,
    dispose() {
      calls.drop();
      plot?.dispose();
    },
  };
}

/** Identify without a record: where to get one. */
export function noRecordView(trouble = ""): View {
  const heading = h("h1", { tabindex: -1 }, "Identify");
  const element = h(
    "main",
    { class: "identify", id: "main" },
    heading,
    trouble ? h("p", { class: "trouble", role: "status" }, trouble) : null,
    h(
      "p",
      {},
      "There is no recorded test here yet. ",
      h("a", { href: "#/" }, "Drop one on Start"),
      ": a step, a relay test, or any movement of the controller's output.",
    ),
  );
  return { element, heading, dispose: () => undefined };
}
