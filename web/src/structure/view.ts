// Structure: loops around the loop. The block diagram is the form; the design follows its fields and sliders.
import "../style/structure.css";
import { ApiError, sentenceOf } from "../api/client.ts";
import { getJob } from "../api/jobs.ts";
import { latest } from "../api/latest.ts";
import { parsePlant } from "../api/plants.ts";
import { designStructure, isStructure, isStructureRequest, STRUCTURES } from "../api/structure.ts";
import type { Designed, StructureAnswer, StructureId, StructureJob, StructureQuestion, StructureRequest } from "../api/structure.ts";
import { h } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { tabs } from "../form/tabs.ts";
import { addressOfStructure, formatRoute } from "../routes.ts";
import type { StructureRoute } from "../routes.ts";
import { copyButton } from "../views/copy.ts";
import { requestMenu } from "../views/request_menu.ts";
import type { Store } from "../store.ts";
import type { View } from "../views/start.ts";
import { structureDocuments } from "./documents.ts";
import { documentAddress } from "../words/documents.ts";
import { structureForm, unitsOf } from "./form.ts";
import { ownSettings } from "./own_settings.ts";
import { linkedTexts, objectPlants, readQuestion, textsOf, textsOfLink } from "./question.ts";
import { structureResult } from "./result.ts";
import { firstExample, STRUCTURE_SPECS } from "./structures.ts";
import type { Texts } from "./structures.ts";

export interface StructureView extends View {
  open(route: StructureRoute): void;
}

export interface StructureEvents {
  /** The address that holds the whole question. */
  onQuestion(route: StructureRoute): void;
}

interface Asked extends StructureQuestion {
  held: boolean;
}

/** An answer that takes longer is awaited only after the release of a slider. */
const LONGEST_FOLLOWING_MS = 1000;
const LATE_MS = 300;
/** Samples of each trace, and while a slider is held. */
const POINTS = 300;
const HELD_POINTS = 120;

const routeOf = (id: StructureId, texts: Texts): StructureRoute => ({ screen: "structure", id, values: linkedTexts(id, texts), job: null });

export function structureView(store: Store, announce: (sentence: string) => void, events: StructureEvents): StructureView {
  const errors = new FormErrors();
  let id: StructureId = "cascade";
  let opened = "";
  /** When the last design was sent, and its duration, ms. */
  let began = 0;
  let cost = 0;
  let lateTimer: ReturnType<typeof setTimeout> | undefined;
  /** What was typed for each structure. */
  const typed = new Map<StructureId, Texts>();
  let answered = false;
  const heading = h("h1", { tabindex: -1 }, "Loops around the loop");
  const purpose = h("p", { class: "hint" });
  const busy = h("span", { class: "hint busy idle", role: "status" });
  const cancel = h("button", { type: "button", class: "quiet", hidden: true, onclick: stop }, "Cancel");
  const trouble = h("p", { class: "trouble", role: "alert", hidden: true });
  const menu = requestMenu(announce);
  const link = copyButton({ label: "Copy link", look: "quiet", text: () => new URL(formatRoute(routeOf(id, form.texts())), location.href).href }, announce);
  const form = structureForm(errors, changed);
  const documents = structureDocuments(announce);
  const own = ownSettings(store, announce, () => ask(false));
  const result = structureResult(announce, documents, own);
  const examples = h("p", { class: "structure-examples" });
  const body = h("div", { class: "structure-body" }, form.controls, result.element);
  const kinds = tabs(
    STRUCTURES.map((name) => ({ id: name, label: STRUCTURE_SPECS[name].title })),
    {
      label: "Structure",
      panel: [h("div", { class: "stack" }, purpose, examples, trouble, form.diagram, body)],
      onSelect: (name) => {
        if (name !== id) location.hash = formatRoute({ screen: "structure", id: name, values: {}, job: null });
      },
    },
  );
  const element = h("main", { class: "identify structure", id: "main" }, h("div", { class: "identify-head" }, heading, link, menu.element, cancel, busy), kinds.element);
  examples.append(
    "Examples: ",
    ...STRUCTURES.flatMap((of) =>
      Object.entries(STRUCTURE_SPECS[of].examples).map(([title, request]) => h("a", { href: formatRoute(routeOf(of, textsOf(of, request))) }, title)),
    ),
  );

  const calls = latest<Asked, Designed>(
    async (asked, signal) => {
      began = performance.now();
      const designed = await designStructure(asked, signal);
      cost = performance.now() - began;
      return designed;
    },
    {
      onBusy(now) {
        clearTimeout(lateTimer);
        if (now) lateTimer = setTimeout(() => setBusy(true), LATE_MS);
        else setBusy(false);
      },
      onAnswer({ answer, job }, asked) {
        take(answer, asked, job);
        if (!asked.held) announce(result.sentence());
      },
      onError: complain,
    },
    1,
  );

  function take(answer: StructureAnswer, { request, held }: Omit<Asked, "id">, job: string | null = null): void {
    errors.clear();
    trouble.hidden = true;
    answered = true;
    form.showAnswer(answer);
    const units = unitsOf(form.texts());
    result.show(answer, request, units, held);
    if (held) return;
    documents.about({ id, request }, units, job);
    menu.show(`v1/${id}`, request);
  }

  function setBusy(now: boolean): void {
    busy.textContent = now ? "Designing..." : "";
    cancel.hidden = !now;
    element.toggleAttribute("data-busy", now);
  }

  function stop(): void {
    calls.drop();
    clearTimeout(lateTimer);
    setBusy(false);
    result.setStale(answered);
  }

  function complain(error: unknown): void {
    const listed = error instanceof ApiError ? (error.problem.errors ?? []) : [];
    const others = errors.mark("", listed);
    trouble.textContent = listed.length > 0 ? others.map(({ detail }) => detail).join(" ") : sentenceOf(error);
    trouble.hidden = trouble.textContent === "";
    result.setStale(answered);
  }

  function changed(held: boolean): void {
    result.hold(held);
    if (held && cost > LONGEST_FOLLOWING_MS) return;
    ask(held);
    if (!held) holdInAddress();
  }

  function holdInAddress(): void {
    const route = routeOf(id, form.texts());
    opened = formatRoute(route);
    events.onQuestion(route);
  }

  function ask(held: boolean): void {
    typed.set(id, form.texts());
    const { question, errors: faults } = readQuestion(id, form.texts());
    errors.mark("", faults);
    const implement = held ? null : own.implement();
    const added = { evaluate: { points: held ? HELD_POINTS : POINTS }, ...(implement ? { implement } : {}) };
    if (faults.length > 0) return stop();
    // A slow design that is no longer wanted is not awaited.
    if (!held && performance.now() - began > LONGEST_FOLLOWING_MS) calls.drop();
    calls.send({ id, request: { ...question.request, ...added }, held });
  }

  /** `job`: one that has the answer. */
  function show(next: StructureId, texts: Texts, job: StructureJob | null = null): void {
    answered = false;
    stop();
    trouble.hidden = true;
    cost = 0;
    result.clear();
    menu.show("", null);
    id = next;
    kinds.select(id);
    const { purpose: words, section } = STRUCTURE_SPECS[id];
    purpose.replaceChildren(`${words} `, h("a", { href: documentAddress("structures", section), target: "_blank" }, "How it is designed"));
    form.show(id, texts);
    typed.set(id, texts);
    own.setUnits(unitsOf(texts));
    const { structure: _structure, ...request } = job?.request ?? { structure: id };
    if (job?.result) return take(job.result, { request, held: false }, job.id);
    ask(false);
    if (!job) holdInAddress();
  }

  /** Plants that are no texts are written by the service. */
  async function textsOfJob(of: StructureId, request: StructureRequest): Promise<Texts> {
    const plants = await Promise.all(objectPlants(of, request).map(async ([key, plant]) => [key, (await parsePlant({ plant })).text ?? ""] as const));
    return { ...textsOf(of, request), ...Object.fromEntries(plants) };
  }

  async function openJob(wanted: string): Promise<void> {
    try {
      const job = (await getJob(wanted)) as unknown as StructureJob;
      const { request } = job;
      if (!isStructureRequest(request)) throw new Error("This job is not about a structure.");
      show(request.structure, await textsOfJob(request.structure, request), job);
    } catch (error) {
      complain(error);
    }
  }

  return {
    element,
    heading,
    dispose() {
      calls.drop();
      form.dispose();
      result.dispose();
      documents.dispose();
      own.dispose();
    },
    open({ id: name, values, job }) {
      if (job !== null) {
        const here = addressOfStructure(job);
        if (here !== opened) void openJob(job);
        opened = here;
        return;
      }
      const next = isStructure(name) ? name : id;
      const asked = Object.keys(values).length > 0 ? textsOfLink(next, values) : (typed.get(next) ?? textsOf(next, firstExample(next)));
      // A user who returns finds the previous content.
      if (opened !== "" && next === id && formatRoute(routeOf(next, asked)) === formatRoute(routeOf(id, form.texts()))) holdInAddress();
      else show(next, asked);
    },
  };
}
