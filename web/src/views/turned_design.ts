// A job's entry that is turned by sliders: what they start from, and the job's result as it reads with the newest answer.
import { sentenceOf } from "../api/client.ts";
import { effect, untracked } from "@preact/signals-core";
import type { LiveSubject } from "../api/live.ts";
import { isFinal } from "../api/types.ts";
import type { Entry, Job, Method, Plant, Result, TuningRequest } from "../api/types.ts";
import { h, passFocus } from "../dom.ts";
import { tuneEntryOf, withTune } from "../form/tuning_request.ts";
import type { Knob } from "../live/knobs.ts";
import { liveDesign } from "../live/live.ts";
import type { Answer } from "../live/live.ts";
import { firstStep, pointOf, samePoint, tiedAt, valuesOf } from "../live/point.ts";
import type { Point, Steps } from "../live/point.ts";
import { rewriteAddress } from "../routes.ts";
import type { Store } from "../store.ts";
import { formatNumber, unitNames } from "../words/numbers.ts";
import { controlsCard } from "./cards/controls_card.ts";
import { frontCard } from "./cards/front_card.ts";
import type { FrontSubject } from "./cards/front_card.ts";

export interface TurnedDesign {
  controls: HTMLElement;
  front: HTMLElement;
  /** Sliders for that entry of the job. */
  show(job: Job, result: Result, index: number): void;
  /** The result with the newest answer in the entry's place. */
  effective(result: Result): Result;
  /** The newest answer, if the entry was turned. */
  answer(): Answer | null;
  dispose(): void;
}

export interface TurnedEvents {
  /** A newer answer, or the proposal again; `held`: more will follow at once. */
  onAnswer(held: boolean): void;
  /** Plots are old: an answer is awaited for long. */
  onLate(late: boolean): void;
  onHold(held: boolean): void;
  onRetune(request: TuningRequest, index: number): Promise<void>;
}

/** Of a limit on Ms: an answer within it is not called above. */
const LIMIT_TOLERANCE = 1e-3;

/** Measured points have no responses over time, hence no front. */
const hasFront = (plant: Plant): boolean => plant.type !== "frequency_response";

export function turnedDesign(
  store: Store,
  announce: (sentence: string) => void,
  events: TurnedEvents,
): TurnedDesign {
  let shown: { job: Job; result: Result; index: number } | null = null;
  let knobs: Knob[] = [];
  let proposal: Point | null = null;
  /** The address speaks of the entry that is shown. */
  let addressed = true;
  /** Of the job's other entries: what was done to them before another one was chosen. */
  const left = new Map<number, Steps>();
  /** Where the design stood that is being kept. */
  let kept: Point | null = null;
  const live = liveDesign(settled);
  const controls = controlsCard(live);
  const front = frontCard(announce, controls.turnMs, () => controls.setLowest(front.lowest()));
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const about = h("p", {});
  const keep = h("button", { type: "button", onclick: () => keepIt() });
  const keeping = h("p", { class: "actions" }, keep);
  const away = h("div", { class: "trouble", hidden: true }, about, keeping);
  controls.element.append(trouble, away);

  const base = (): Entry | undefined => shown?.result.controllers[shown.index];
  const todayOf = (result: Result): Entry | undefined =>
    result.controllers.find((entry) => entry.method === "baseline" && !entry.error);

  function subjectOf(job: Job, result: Result): LiveSubject | null {
    const plant = result.model?.plant ?? job.request?.plant;
    if (!plant) return null;
    return { plant, request: job.request ?? {}, today: todayOf(result)?.controller ?? null };
  }

  /** One step was made: the address has it. */
  function settled(point: Point): void {
    const route = store.get().route;
    if (route.screen !== "design" || !proposal) return;
    const { values: _before, ...bare } = route;
    const values = valuesOf(point, proposal, base()?.controller, knobs);
    const next = { ...bare, entry: store.get().selected, ...(Object.keys(values).length > 0 ? { values } : {}) };
    store.set((workspace) => ({ ...workspace, route: next }));
    rewriteAddress(route, next);
    showFront();
  }

  /** The button goes with what it is about; the keyboard stays at the sliders. */
  function keepIt(): void {
    passFocus(keep, controls.element.querySelector<HTMLElement>("input[type=range]"));
    void keepDesign();
  }

  /** The job's report, request and code are the proposal's: a design that stays has a job of its own. */
  async function keepDesign(): Promise<void> {
    const tune = live.point.peek()?.tune;
    if (!shown?.job.request || !tune) return;
    keep.disabled = true;
    kept = live.point.peek();
    try {
      await events.onRetune(withTune(shown.job.request, shown.result, shown.index, tune), shown.index);
    } catch (error) {
      trouble.textContent = sentenceOf(error);
      trouble.hidden = false;
      kept = null;
    } finally {
      keep.disabled = false;
    }
  }

  /** The limit on Ms that a design was made for; null by hand and for rules. */
  function limitAt(point: Point | null): number | null {
    const tune = point?.tune;
    if (!tune || point.hand || tune.method !== "robust") return null;
    return typeof tune["Ms"] === "number" ? tune["Ms"] : (knobs.find((knob) => knob.id === "Ms")?.value ?? null);
  }

  /** What stands on the screen and not in the job, and what can be done about it. */
  function showAway(answer: Answer | null): void {
    away.hidden = !answer;
    if (!answer) return;
    const { hand } = answer.point;
    const everyModel = shown?.job.request?.["uncertainty"] === "identified";
    keeping.hidden = hand !== null;
    keep.textContent = everyModel ? "Hold the limits for every model" : "Keep this design";
    about.textContent = hand
      ? `${aboveLimit(answer)}Report, request and code are the proposal's; settings by hand have none.`
      : everyModel
        ? "Turned for the best model alone, not for every model consistent with the record. Report, request and code are the proposal's."
        : "Report, request and code are the proposal's. Keep this design to have its own.";
  }

  /** Settings by hand keep to no limit. */
  function aboveLimit({ entry, point }: Answer): string {
    const limit = limitAt({ tune: point.tune, hand: null });
    const Ms = entry.robustness?.Ms;
    if (limit === null || typeof Ms !== "number" || Ms <= limit * (1 + LIMIT_TOLERANCE)) return "";
    return `Ms is ${formatNumber(Ms)}, above the limit of ${formatNumber(limit)} that the design keeps to. `;
  }

  /** What the curves hold to, besides Ms. */
  function frontTerms({ tune }: Point): Pick<FrontSubject, "kind" | "terms"> {
    if (tune?.method !== "robust") return { kind: null, terms: { Mt: "tied" } };
    const { Mt, Mks, filter, objective = "load_iae", controller } = tune;
    const alone = Mks === undefined && objective === "load_iae";
    const kind = controller === "PI" ? "PI" : "PID";
    const tied = tiedAt({ tune, hand: null }) || typeof Mt !== "number";
    return { kind: alone ? kind : null, terms: { Mt: tied ? "tied" : Mt, ...(filter ? { filter } : {}) } };
  }

  function showFront(): void {
    const entry = base();
    const plant = shown ? (shown.result.model?.plant ?? shown.result.linear_model ?? shown.job.request?.plant) : null;
    const possible = Boolean(entry?.performance?.load && plant && hasFront(plant));
    front.element.hidden = !possible;
    if (!possible || !shown || !plant) return;
    front.show({
      plant,
      ...frontTerms(live.point.peek() ?? proposal!),
      load: shown.job.request?.evaluate?.load_step ?? 1,
      units: unitNames(shown.job.request?.units),
      entries: shown.result.controllers,
    });
    placeOnFront();
  }

  function placeOnFront(): void {
    const entry = live.answer.peek()?.entry ?? base();
    if (!entry || front.element.hidden || !shown) return;
    const answered = live.answer.peek()?.point ?? proposal;
    front.place(entry, limitAt(answered), live.answer.peek()?.today ?? todayOf(shown.result) ?? null);
  }

  const leaving = [
    effect(() => {
      const answer = live.answer.value;
      const held = live.held.value;
      untracked(() => {
        front.hold(held);
        events.onHold(held);
        if (!shown) return;
        placeOnFront();
        const entry = answer?.entry ?? base();
        if (entry) controls.follow(entry);
        events.onAnswer(held);
      });
    }),
    effect(() => events.onLate(live.late.value)),
    effect(() => {
      trouble.textContent = live.trouble.value;
      trouble.hidden = live.trouble.value === "";
    }),
    effect(() => showAway(live.answer.value)),
  ];

  /** Not where a text is typed: there it takes back letters. */
  function onKey(event: KeyboardEvent): void {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || event.key.toLowerCase() !== "z") return;
    const target = event.target as HTMLElement | null;
    if (target instanceof HTMLTextAreaElement || (target instanceof HTMLInputElement && target.type === "text")) return;
    event.preventDefault();
    if (event.shiftKey) live.redo();
    else live.undo();
  }
  document.addEventListener("keydown", onKey);

  const methodOf = (entry: Entry): Method | undefined => store.get().methods.find((item) => item.id === entry.method);

  /** `to`: where the sliders go on from; else where the address says. */
  function begin(to: Steps | null = null): void {
    const entry = base();
    if (!shown || !entry) return;
    const { job, result, index } = shown;
    const subject = subjectOf(job, result);
    const usable = Boolean(subject && entry.controller && !entry.error && isFinal(job.status));
    controls.element.hidden = !usable;
    front.element.hidden = !usable;
    if (!usable || !subject) return live.stop();
    proposal = { tune: job.request ? tuneEntryOf(job.request, result, index) : null, hand: null };
    knobs = controls.show(proposal, entry, methodOf(entry), unitNames(job.request?.units));
    const at = to ?? firstStep(addressedPoint(proposal, entry));
    live.start({ subject, point: proposal, entry }, at);
    if (addressed && !to) return showFront();
    addressed = true;
    settled(at.now);
  }

  function addressedPoint(from: Point, entry: Entry): Point {
    const route = store.get().route;
    const values = addressed && route.screen === "design" ? (route.values ?? {}) : {};
    return pointOf(values, from, entry.controller, knobs);
  }

  /** Where a slider went while the design was being kept; null: it stands where it was, or nothing was kept. */
  function movedOn(job: Job): Point | null {
    const from = kept;
    if (!from || shown?.job.id === job.id) return null;
    kept = null;
    const now = live.point.peek();
    return now && !samePoint(now, from) ? now : null;
  }

  // The sliders of a method need its options, which may come later than the job.
  const methods = store.pick((workspace) => workspace.methods);
  let known = methods.peek();
  leaving.push(
    effect(() => {
      const now = methods.value;
      if (now !== known && shown) untracked(() => begin());
      known = now;
    }),
  );

  return {
    controls: controls.element,
    front: front.element,
    show(job, result, index) {
      if (shown?.result === result && shown.index === index) return;
      // The same entry again, newly fetched, still stands where the address says.
      addressed = shown === null || (shown.job.id === job.id && shown.index === index);
      const moved = movedOn(job);
      const before = live.steps.peek();
      if (shown?.job.id !== job.id) left.clear();
      else if (before) left.set(shown.index, before);
      shown = { job, result, index };
      begin(moved ? firstStep(moved) : (left.get(index) ?? null));
    },
    effective(result) {
      const answer = live.answer.peek();
      if (!answer || !shown || shown.result !== result) return result;
      const controllers = result.controllers.map((entry, at) =>
        at === shown!.index ? answer.entry : entry.method === "baseline" && answer.today ? { ...answer.today, method: "baseline" } : entry,
      );
      return { ...result, controllers };
    },
    answer: () => live.answer.peek(),
    dispose() {
      document.removeEventListener("keydown", onKey);
      for (const leave of leaving) leave();
      controls.dispose();
      front.dispose();
      live.dispose();
    },
  };
}
