// A job's entry that sliders modify: their start, and the job's result with the newest answer.
import { sentenceOf } from "../api/client.ts";
import { effect, untracked } from "@preact/signals-core";
import { callSubject } from "../api/live.ts";
import { isFinal } from "../api/types.ts";
import type { Entry, Job, Method, Plant, Result, TuningRequest } from "../api/types.ts";
import { h, passFocus } from "../dom.ts";
import { rowsOf, tuneEntryOf } from "../form/tuning_request.ts";
import type { SliderSpec } from "../live/sliders.ts";
import { liveDesign } from "../live/live.ts";
import type { Answer } from "../live/live.ts";
import { firstStep, pointOf, samePoint, stepTo, tiedAt, valuesOf } from "../live/point.ts";
import type { Point, Steps } from "../live/point.ts";
import { rewriteAddress } from "../routes.ts";
import type { Store } from "../store.ts";
import { keptOtherwise } from "../words/kept.ts";
import { formatNumber, unitNames } from "../words/numbers.ts";
import type { SettingsByHand } from "./typed_settings.ts";
import { controlsCard } from "./cards/controls_card.ts";
import { frontCard } from "./cards/front_card.ts";
import type { FrontSubject } from "./cards/front_card.ts";
import { plotGrips } from "./grips.ts";
import type { Grips } from "./grips.ts";

/** A displayed result, and the request for it. */
export interface OnScreen {
  result: Result;
  /** Index of the entry that is shown. */
  index: number;
  /** The indices of the entries in the job's own result. */
  origin: number[];
  request: TuningRequest | undefined;
}

export interface ModifiedDesign {
  controls: HTMLElement;
  front: HTMLElement;
  /** Creates sliders for that entry of the job. */
  show(job: Job, result: Result, index: number): void;
  /** With the newest answer, if the displayed entry was modified; otherwise the job's own result. */
  onScreen(job: Job, result: Result, index: number): OnScreen;
  /** The newest answer, if the entry was modified. */
  answer(): Answer | null;
  /** How the displayed settings came about if they are not the job's; else "". */
  mark(): string;
  /** How the plots are dragged; null: nothing can follow. */
  grips(): Grips | null;
  /** The entry has sliders, hence other settings can be shown in its place. */
  isMovable(): boolean;
  /** Shows these settings, as one step. */
  setByHand(settings: SettingsByHand): void;
  /** A design is kept only after the settings that are being read. */
  waitFor(reading: Promise<void>): void;
  /** The displayed design is that of the sliders and of the settings typed last. */
  isCurrent(): boolean;
  dispose(): void;
}

export interface ModifiedDesignEvents {
  /** A newer answer, or the proposal again; `held`: more will follow at once. */
  onAnswer(held: boolean): void;
  /** The plots are outdated: the answer takes long. */
  onLate(late: boolean): void;
  onHold(held: boolean): void;
  /** Creates a job for the displayed design; returns it with the index of the entry, null if another one has
      replaced it. */
  onKeep(request: TuningRequest, index: number): Promise<{ job: Job; index: number } | null>;
}

const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** Measured points have no responses over time, hence no frontier. */
const hasFront = (plant: Plant): boolean => plant.type !== "frequency_response";

export function modifiedDesign(
  store: Store,
  announce: (sentence: string) => void,
  events: ModifiedDesignEvents,
): ModifiedDesign {
  let shown: { job: Job; result: Result; index: number } | null = null;
  let sliders: SliderSpec[] = [];
  let proposal: Point | null = null;
  /** The address describes the displayed entry. */
  let addressed = true;
  /** For the job's other entries: their changes before another one was chosen. */
  const left = new Map<number, Steps>();
  /** Settings that were typed and are being read. */
  let typing: Promise<void> = Promise.resolve();
  /** The point of the design that is being kept. */
  let kept: Point | null = null;
  const live = liveDesign(settled);
  const controls = controlsCard(live);
  const front = frontCard(announce, (Ms, released) => controls.turn("Ms", Ms, released), () => controls.setLowest(front.lowest()));
  const grips = plotGrips(controls, () => ({ entry: live.answer.peek()?.entry ?? base(), tune: live.answer.peek()?.point.tune ?? null }));
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const waits = h("p", { class: "hint", hidden: true });
  const about = h("p", {});
  const keep = h("button", { type: "button", onclick: () => keepIt() }, "Keep this design");
  const away = h("div", { class: "trouble", hidden: true }, about, h("p", { class: "actions" }, keep));
  controls.element.append(waits, trouble, away);

  const base = (): Entry | undefined => shown?.result.controllers[shown.index];
  const todayOf = (result: Result): Entry | undefined =>
    result.controllers.find((entry) => entry.method === "baseline" && !entry.error);

  /** After a step: writes it to the address. */
  function settled(point: Point): void {
    const route = store.get().route;
    if (route.screen !== "design" || !proposal) return;
    const { values: _before, ...bare } = route;
    const values = valuesOf(point, proposal, base()?.controller, sliders);
    const next = { ...bare, entry: store.get().selected, ...(Object.keys(values).length > 0 ? { values } : {}) };
    store.set((workspace) => ({ ...workspace, route: next }));
    rewriteAddress(route, next);
    showFront();
  }

  /** The button is removed; the focus stays at the sliders. */
  function keepIt(): void {
    passFocus(keep, controls.element.querySelector<HTMLElement>("input[type=range]"));
    void keepDesign();
  }

  /** The job's report and code belong to the proposal: a design that is kept gets its own job, with the displayed
      request. */
  async function keepDesign(): Promise<void> {
    keep.disabled = true;
    // The press that leaves a field comes before the answer to what was typed there.
    await typing;
    await live.settled();
    const shownNow = live.answer.peek();
    if (!shownNow || !live.current.peek()) {
      keep.disabled = false;
      return;
    }
    kept = shownNow.point;
    const before = shownNow.entry;
    try {
      const made = await events.onKeep(shownNow.request, shownNow.kept);
      const otherwise = made ? keptOtherwise(before, made.job, made.index) : "";
      if (otherwise) complain(otherwise);
    } catch (error) {
      complain(sentenceOf(error));
      kept = null;
    } finally {
      keep.disabled = false;
    }
  }

  function complain(sentence: string): void {
    trouble.textContent = sentence;
    trouble.hidden = false;
  }

  /** The limit on Ms for which a design was made; null by hand and for rules. */
  function limitAt(point: Point | null): number | null {
    const tune = point?.tune;
    if (!tune || point.manual || tune.method !== "robust") return null;
    return typeof tune["Ms"] === "number" ? tune["Ms"] : (sliders.find((spec) => spec.id === "Ms")?.value ?? null);
  }

  /** Shows how the displayed design differs from the job, and the possible actions. */
  function showAway(answer: Answer | null): void {
    away.hidden = !answer;
    if (!answer) return;
    const { manual } = answer.point;
    const above = manual && answer.entry.standing?.group === "above_limit" ? answer.entry.standing.why : "";
    const [these, own] = manual ? ["these settings", "their own"] : ["this design", "its own"];
    keep.textContent = `Keep ${these}`;
    about.textContent = `${above ? `${above} ` : ""}Report, change sheet and code still describe the job's design. Keep ${these} to get ${own}.`;
  }

  /** The limits of the curves other than Ms. */
  function frontTerms({ tune }: Point): Pick<FrontSubject, "kind" | "terms"> {
    const onRegion = shown?.job.request?.["uncertainty"] === "identified" || base()?.over_region;
    if (tune?.method !== "robust" || onRegion) return { kind: null, terms: { Mt: "tied" } };
    const { Mt, Mks, filter, objective = "load_iae", controller } = tune;
    const alone = Mks === undefined && objective === "load_iae";
    const kind = controller === "PI" ? "PI" : "PID";
    const tied = tiedAt({ tune, manual: null }, methodOf(base()!)) || typeof Mt !== "number";
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
    front.place(entry, limitAt(answered), todayOf(live.answer.peek()?.result ?? shown.result) ?? null);
  }

  /** Entries of one row of the request are modified together. */
  function leave(index: number, steps: Steps): void {
    left.set(index, steps);
    const request = shown?.job.request;
    if (!shown || !request) return;
    const rows = rowsOf(request, shown.result);
    for (const [other, row] of rows.entries()) {
      const tune = tuneEntryOf(request, shown.result, other);
      if (other === index || row < 0 || row !== rows[index]) continue;
      if (same(tune, steps.now.tune)) left.delete(other);
      else left.set(other, stepTo(firstStep({ tune, manual: null }), { tune: steps.now.tune, manual: null }));
    }
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
        if (held) grips.answered();
      });
    }),
    effect(() => events.onLate(live.late.value)),
    effect(() => {
      trouble.textContent = live.trouble.value;
      trouble.hidden = live.trouble.value === "";
    }),
    effect(() => {
      const ms = live.waits.value;
      waits.hidden = ms === 0;
      waits.textContent = ms === 0 ? "" : `Follows when you release the slider: this design takes about ${formatNumber(ms / 1000, 2)} s.`;
    }),
    effect(() => showAway(live.answer.value)),
  ];

  /** Not in a text field: there the key undoes typing. */
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

  /** `to`: the starting point of the sliders; by default that of the address. */
  function begin(to: Steps | null = null): void {
    const entry = base();
    if (!shown || !entry) return;
    const { job, result, index } = shown;
    const request = job.request ?? {};
    const usable = Boolean(callSubject(request, result) && entry.controller && !entry.error && isFinal(job.status));
    controls.element.hidden = !usable;
    front.element.hidden = !usable;
    if (!usable) return live.stop();
    proposal = { tune: job.request ? tuneEntryOf(job.request, result, index) : null, manual: null };
    sliders = controls.show(proposal, entry, methodOf(entry), unitNames(job.request?.units));
    const at = to ?? firstStep(addressedPoint(proposal, entry));
    live.start({ from: { request, result, index }, point: proposal }, at);
    if (addressed && !to) return showFront();
    addressed = true;
    settled(at.now);
  }

  function addressedPoint(from: Point, entry: Entry): Point {
    const route = store.get().route;
    const values = addressed && route.screen === "design" ? (route.values ?? {}) : {};
    return pointOf(values, from, entry.controller, sliders);
  }

  /** The point to which a slider moved while the design was being kept; null: it has not moved, or nothing was kept. */
  function movedOn(job: Job): Point | null {
    const from = kept;
    if (!from || shown?.job.id === job.id) return null;
    kept = null;
    const now = live.point.peek();
    return now && !samePoint(now, from) ? now : null;
  }

  // The sliders of a method need its options, which may arrive after the job.
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
      // The same entry, loaded again, is still the one of the address.
      addressed = shown === null || (shown.job.id === job.id && shown.index === index);
      const moved = movedOn(job);
      const before = live.steps.peek();
      if (shown?.job.id !== job.id) left.clear();
      else if (before) leave(shown.index, before);
      shown = { job, result, index };
      begin(moved ? firstStep(moved) : (left.get(index) ?? null));
    },
    onScreen(job, result, index) {
      const answer = live.answer.peek();
      const modified = answer && shown && shown.result === result && shown.index === index;
      return modified ? answer : { result, index, origin: [...result.controllers.keys()], request: job.request };
    },
    answer: () => live.answer.peek(),
    grips: () => (live.point.peek() !== null && !controls.element.hidden ? grips : null),
    isMovable: () => live.point.peek() !== null && !controls.element.hidden,
    setByHand({ controller, typed }) {
      live.settle({ tune: (live.point.peek() ?? proposal!).tune, manual: controller, ...(typed ? { typed } : {}) });
    },
    waitFor(reading) {
      typing = reading;
    },
    isCurrent: () => live.current.peek(),
    mark() {
      const answer = live.answer.peek();
      return !answer ? "" : answer.point.manual ? "set by hand" : "moved by the sliders";
    },
    dispose() {
      document.removeEventListener("keydown", onKey);
      for (const stop of leaving) stop();
      controls.dispose();
      front.dispose();
      live.dispose();
    },
  };
}
