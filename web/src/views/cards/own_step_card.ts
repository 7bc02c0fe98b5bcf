// "Your own step" on Design: the step in the user's own units as fields, its course and figures with the drawn
// controllers, and what the verdict says of it.
import { ApiError, sentenceOf } from "../../api/client.ts";
import { latest } from "../../api/latest.ts";
import { ownStepsOf } from "../../api/live.ts";
import type { Entry, Finding, Implement, OwnStep, Plant, Result, TuningRequest } from "../../api/types.ts";
import type { Drawn } from "../../charts/drawn.ts";
import { ownStepFrame } from "../../charts/own_step.ts";
import { h, uniqueId } from "../../dom.ts";
import { FormErrors, staleMark } from "../../form/errors.ts";
import { proposedStep, readStep, sameStep, STEP_POINTER, textsOf } from "../../form/own_step.ts";
import type { StepTexts } from "../../form/own_step.ts";
import { ownStepFields } from "../../form/own_step_fields.ts";
import { plotGrid } from "../../plot/grid.ts";
import { swatch } from "../../plot/marks.ts";
import { withMinus } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";
import { ownStepGroups, stepFindings, withStepFindings } from "../../words/own_step.ts";
import { figuresTable } from "../figures_table.ts";
import { LEVEL_CLASS } from "./verdict_card.ts";

export interface OwnStepShown {
  /** The request and the result of the job. */
  request: TuningRequest;
  whole: Result;
  /** As displayed, modified or not; with the drawn entries and the chosen one. */
  result: Result;
  drawn: Drawn[];
  index: number;
  units: UnitNames;
  subject: string;
  /** The step as it was typed; null: that of the request, or the proposed one. */
  texts: StepTexts | null;
}

export interface OwnStepCard {
  element: HTMLElement;
  show(shown: OwnStepShown): void;
  /** The displayed result with what its verdicts say of the step that was typed, as far as it is known. */
  judged(result: Result): Result;
  /** The step of the card; null if it is not complete. */
  step(): OwnStep | null;
  dispose(): void;
}

export interface OwnStepEvents {
  announce(sentence: string): void;
  /** The step was changed; null: back to that of the request, or to the proposed one. */
  onChange(texts: StepTexts | null): void;
  /** There are new findings about the step that was typed. */
  onJudged(): void;
  /** Designs again in this job's place, with the step in its request. */
  onKeep(): Promise<void>;
}

interface Question {
  plant: Plant;
  implement: Implement | undefined;
  units: TuningRequest["units"];
  step: OwnStep;
  entries: Pick<Drawn, "index" | "entry">[];
}

/** The step of one controller, and the verdict with it. */
interface Simulated {
  controller: string;
  own_step: Entry["own_step"];
  verdict: Finding[];
}

/** By the indices of the entries. */
interface Answer {
  step: OwnStep;
  simulated: Map<number, Simulated>;
}

const simulatedOf = (entry: Entry, by: Entry = entry): Simulated => ({
  controller: JSON.stringify(entry.controller),
  own_step: by.own_step,
  verdict: by.verdict,
});

const ABOUT =
  "From rest the set point moves, and a load follows, within the limits of u: in your units, with the drawn controllers. Change any field; empty ones say what they mean.";
const NOT_KEPT = "The report does not have this step yet.";

export function ownStepCard(events: OwnStepEvents): OwnStepCard {
  let shown: OwnStepShown | null = null;
  /** The question whose answer is shown or in progress. */
  let asked = "";
  let answered: Answer | null = null;
  /** The texts of the fields as they were reported. */
  let typed: StepTexts | null = null;
  const errors = new FormErrors();
  const fields = ownStepFields(errors, () => events.onChange((typed = fields.texts())));
  const plots = plotGrid(events.announce);
  const figures = h("div", {});
  const findings = h("ul", { class: "notes step-findings" });
  const results = h("div", { class: "own-step-results" }, plots.element, findings, figures);
  const stale = staleMark(() => results);
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const back = h("button", { type: "button", class: "quiet", onclick: () => events.onChange(null) }, "Reset the step");
  const keep = h("button", { type: "button", onclick: () => void keepStep() }, "Keep this step");
  const keepNote = h("span", { class: "hint" }, NOT_KEPT);
  const actions = h("p", { class: "actions" }, keep, back, keepNote);
  const title = h("h2", { id: uniqueId("own-step") }, "Your own step");
  const fold = h(
    "details",
    {},
    h("summary", {}, title),
    h("p", { class: "hint" }, ABOUT),
    h("div", { class: "own-step-body" }, h("div", { class: "own-step-form" }, fields.element, trouble, stale.element, actions), results),
  );
  const element = h("section", { class: "card own-step", "aria-labelledby": title.id, hidden: true }, fold);

  const calls = latest<Question, Answer>(
    async ({ step, entries, ...subject }, signal) => {
      const answers = await ownStepsOf({ ...subject, step, controllers: entries.map(({ entry }) => entry.controller!) }, signal);
      return { step, simulated: new Map(entries.map(({ index, entry }, at) => [index, simulatedOf(entry, answers[at])])) };
    },
    {
      onBusy: (busy) => plots.setBusy(busy),
      onAnswer: take,
      onError: refuse,
    },
  );

  function take(answer: Answer): void {
    answered = answer;
    complain("");
    stale.set(false);
    draw();
    if (shown?.texts) events.onJudged();
  }

  /** The service refuses the step: the last one stays, marked. */
  function refuse(error: unknown): void {
    const listed = error instanceof ApiError ? (error.problem.errors ?? []) : [];
    const others = errors.mark(STEP_POINTER, listed);
    complain(listed.length === 0 ? sentenceOf(error) : others.map(({ detail }) => detail).join(" "));
    stale.set(answered !== null);
    asked = "";
  }

  function complain(sentence: string): void {
    trouble.textContent = sentence;
    trouble.hidden = sentence === "";
  }

  async function keepStep(): Promise<void> {
    keep.disabled = true;
    try {
      await events.onKeep();
    } catch (error) {
      complain(sentenceOf(error));
    } finally {
      keep.disabled = false;
    }
  }

  /** The step of the card, with the faults of its texts at their fields. */
  function read(): OwnStep | null {
    const { step, errors: faults } = readStep(fields.texts());
    errors.mark(STEP_POINTER, faults);
    return step;
  }

  const ofRequest = (): OwnStep | undefined => shown?.request.evaluate?.own_step;

  /** The job's own entries have the step of its request. */
  function known(step: OwnStep, entries: Question["entries"]): Answer | null {
    if (!shown || shown.result !== shown.whole || !sameStep(step, ofRequest())) return null;
    if (!entries.every(({ entry }) => entry.own_step)) return null;
    return { step, simulated: new Map(entries.map(({ index, entry }) => [index, simulatedOf(entry)])) };
  }

  /** The drawn entries, and the chosen one. */
  function entriesAsked({ drawn, result, index }: OwnStepShown): Question["entries"] {
    const chosen = { index, entry: result.controllers[index]! };
    const all = drawn.some((item) => item.index === index) ? drawn : [...drawn, chosen];
    return all.filter(({ entry }) => entry.controller && !entry.error);
  }

  const plantOf = ({ whole, request }: OwnStepShown): Plant | undefined => whole.model?.plant ?? request.plant;

  function ask(): void {
    if (!shown || !fold.open) return;
    const step = read();
    stale.set(step === null && answered !== null);
    if (!step) {
      asked = "";
      return;
    }
    const entries = entriesAsked(shown);
    const { request, drawn, units } = shown;
    const looks = drawn.map(({ name, look }) => [name, look]);
    const key = JSON.stringify([step, plantOf(shown), request.implement, units, looks, entries.map(({ index, entry }) => [index, entry.controller])]);
    if (key === asked) return;
    asked = key;
    const own = known(step, entries);
    if (own) {
      calls.drop();
      plots.setBusy(false);
      return take(own);
    }
    calls.send({ plant: plantOf(shown)!, implement: request.implement, units: request.units, step, entries });
  }

  function draw(): void {
    if (!shown || !answered) return;
    const { step, simulated } = answered;
    const drawn = shown.drawn.flatMap((item): Drawn[] => {
      const own_step = simulated.get(item.index)?.own_step;
      return own_step ? [{ ...item, entry: { ...item.entry, own_step } }] : [];
    });
    plots.setSubject(shown.subject);
    plots.show("own-step", ownStepFrame(drawn, step, shown.units));
    const ran = drawn.filter(({ entry }) => !entry.own_step!.refused);
    const columns = ran.map(({ name, look, entry }) => ({ name, entry, swatch: () => swatch(look) }));
    figures.replaceChildren(...(columns.length > 0 ? [figuresTable("Figures of your own step", columns, ownStepGroups(step, shown.units))] : []));
    const lines = drawn.flatMap(({ name, index, entry }) => {
      const refused = entry.own_step!.refused?.text;
      const said = refused ? [h("span", {}, refused)] : stepFindings(simulated.get(index)!.verdict).map(finding);
      return said.length > 0 ? [h("li", {}, h("strong", {}, `${name}: `), said)] : [];
    });
    findings.replaceChildren(...lines);
    findings.hidden = lines.length === 0;
  }

  const finding = ({ code, level, text }: Finding): HTMLElement =>
    h("span", { class: LEVEL_CLASS[level], "data-code": code }, `${withMinus(text)} `);

  function showKeeping(): void {
    const kept = sameStep(readStep(fields.texts()).step ?? undefined, ofRequest());
    keep.hidden = keepNote.hidden = kept;
    back.hidden = shown?.texts === null;
    actions.hidden = keep.hidden && back.hidden;
  }

  fold.addEventListener("toggle", () => fold.open && ask());

  return {
    element,
    show(next) {
      const before = shown;
      shown = next;
      element.hidden = !plantOf(next);
      if (element.hidden) return calls.drop();
      fields.setUnits(next.units);
      const another = before?.whole !== next.whole;
      // Texts that were typed here stay as they are.
      if (another || (next.texts !== before!.texts && (next.texts === null || next.texts !== typed)))
        fields.set(next.texts ?? textsOf(ofRequest() ?? proposedStep(next.request, next.whole)));
      if (another) {
        answered = null;
        asked = "";
        fold.open ||= next.texts !== null || ofRequest() !== undefined || next.whole.model !== undefined;
      }
      showKeeping();
      ask();
    },
    judged(result) {
      if (!shown?.texts) return result;
      const controllers = result.controllers.map((entry, index) => {
        const about = answered?.simulated.get(index);
        const current = about && about.controller === JSON.stringify(entry.controller);
        return { ...entry, verdict: withStepFindings(entry.verdict, current ? about.verdict : []) };
      });
      return { ...result, controllers };
    },
    step: () => readStep(fields.texts()).step,
    dispose() {
      calls.drop();
      plots.dispose();
    },
  };
}
