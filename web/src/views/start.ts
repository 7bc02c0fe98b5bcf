// Start: a record, a model, or an example; all other fields are optional.
import { ApiError } from "../api/client.ts";
import { postJob } from "../api/jobs.ts";
import type { FieldError, IdentifyRequest, Job, RecordedTest, TuningRequest, Units } from "../api/types.ts";
import { h } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { keptNote, objectOf } from "../form/kept_note.ts";
import type { PlantReading } from "../form/plant.ts";
import { atRecordText } from "../form/record_text.ts";
import { byAllMethods, defined, EVERY_METHOD, withImplement } from "../form/tuning_request.ts";
import type { TuneSubject } from "../form/tuning_request.ts";
import { implementOf, inUnits, mineOfRequest, named, rememberMine } from "../my_controller.ts";
import type { MyController } from "../my_controller.ts";
import { ABOUT_LOOP, formatRoute } from "../routes.ts";
import type { Store, Workspace } from "../store.ts";
import { unitNames } from "../words/numbers.ts";
import { isOfLoop, namesOf } from "../words/record_names.ts";
import { equationsCard } from "./cards/equations_card.ts";
import { exampleElement } from "./cards/example_element.ts";
import { methodsCard } from "./cards/methods_card.ts";
import { modelCard } from "./cards/model_card.ts";
import { myControllerCard } from "./cards/my_controller_card.ts";
import { recordCard } from "./cards/record_card.ts";
import { todayCard } from "./cards/today_card.ts";
import { ultimateCard } from "./cards/ultimate_card.ts";

export interface View {
  element: HTMLElement;
  /** The heading that takes the focus when the screen changes. */
  heading: HTMLElement;
  dispose(): void;
}

export interface StartEvents {
  /** `all`: with every method. */
  onJob(job: Job, all: boolean): void;
  /** The content of the form has changed. */
  onChange(): void;
  /** A record to show on Identify. */
  onRecord(request: IdentifyRequest): void;
  /** A plant, as typed, for a simulated relay test. */
  onRelay(form: string, values: Record<string, string>): void;
}

/** The card that describes the loop. */
export type LoopKind = "model" | "equations" | "record" | "ultimate";

/** The content of the form as typed, without a record. */
export interface StartTexts {
  /** The loop that they describe: changes on Identify are its changes too. */
  id: string;
  kind: LoopKind | null;
  model: { form: string; values: Record<string, string> };
  equations: Record<string, string>;
  ultimate: Record<string, string>;
  /** Name, units, controller, today's settings, methods, and members without a field. */
  loop: Record<string, string>;
}

export interface StartView extends View {
  load(request: TuningRequest, example?: boolean): void;
  loadTyped(form: string, values: Record<string, string>): void;
  /** For the history; `restore` shows it again. */
  texts(): StartTexts;
  restore(texts: StartTexts): void;
  /** For the address: the kind of plant, and everything as typed; null if the loop is described by a record, which
      no address can hold, or by Ku and Pu. */
  address(): { plant: string; values: Record<string, string> } | null;
  loadRecord(record: RecordedTest, identify: Record<string, unknown> | undefined): void;
  /** A new loop, from elsewhere. */
  beginLoop(kind: LoopKind): void;
  /** A job was created from the content of the form. */
  endLoop(): void;
  /** A tuning request for this subject, with the methods (or all of them), units and settings of the form. */
  compose(subject: TuneSubject, all?: boolean): { request: TuningRequest; faults: FieldError[] };
  units(): Units | undefined;
  /** The units typed for a loop that is not tuned yet. */
  typedUnits(): Units | undefined;
  /** The controller and today's settings: cards of this screen until another one shows them. */
  ofLoop: HTMLElement;
  /** Takes these cards back. */
  takeBack(): void;
  /** The record of a loop in automatic, of which Identify has a model: today's settings are looked for in it. */
  offerRecord(record: RecordedTest | null): void;
  /** Resolves when they are known. */
  settled(): Promise<void>;
  /** Shows faults at the cards of the loop. */
  mark(faults: FieldError[]): void;
  /** The number of loops in the form so far. */
  loops(): number;
  /** Names of the chosen methods. */
  methods(): string[];
}

/** Examples that are visible; the others are folded. */
const EXAMPLES_SHOWN = 3;

export function startView(store: Store, events: StartEvents): StartView {
  const errors = new FormErrors();
  // Parts of a loaded request without a field: sent unchanged.
  let base: TuningRequest = {};
  // The kind of the current loop; null: nothing was filled in or tuned yet.
  let loop: LoopKind | null = null;
  let ofExample = false;
  /** Number of loops so far. */
  let loops = 0;
  let ids = 0;
  const nextId = (): string => `${performance.timeOrigin}/${(ids += 1)}`;
  let id = nextId();
  const kept = keptNote("the request", () => {
    base = {};
    showKept();
  });
  let busy = false;
  /** The form is being filled from elsewhere: its controller is not the user's choice. */
  let filling = false;
  let troubled = "";
  const heading = h("h1", { tabindex: -1 }, "What do you have?");
  const status = h("p", { class: "trouble", role: "status", hidden: true });
  // Faults of a plant belong to the card in which it was written.
  let subject: LoopKind = "model";
  const model = modelCard(errors, () => subject === "model", {
    onTune: () => void tuneModel(false),
    onCompare: () => void tuneModel(true),
    onChange: () => events.onChange(),
    onRelay: events.onRelay,
  });
  const equations = equationsCard(errors, () => subject === "equations", {
    onTune: () => void tuneEquations(false),
    onCompare: () => void tuneEquations(true),
    onChange: () => events.onChange(),
    onExample: (example) => load(example.request, true),
  });
  const record = recordCard(errors, {
    onIdentify: identifyRecord,
    onRead(preview) {
      today.propose(namesOf(preview));
      showMine(inUnits(mine, unitNames(today.readUnits())));
      followUnits();
      today.offerRecord(isOfLoop(preview) ? () => record.read().record : null);
      events.onChange();
    },
    onNew() {
      today.offerRecord(null);
      if (loop === null) loop = "record";
      else beginLoop("record");
    },
    onTune: () => void tuneRecord(false),
    onCompare: () => void tuneRecord(true),
  });
  const ultimate = ultimateCard(errors, () => void tuneUltimate());
  const methods = methodsCard(errors);
  function followUnits(): void {
    const units = unitNames(today.readUnits());
    model.setUnits(units);
    equations.setUnits(units);
    methods.setUnits(units);
    mineCard.setUnits(units);
  }
  const today = todayCard(errors, followUnits);
  let mine = store.get().mine;
  const mineCard = myControllerCard(errors, {
    forms: false,
    onChange(next) {
      mine = next;
      today.setMine(next);
      showKept();
      if (filling) return;
      rememberMine(next);
      store.set((workspace) => ({ ...workspace, mine: next }));
    },
  });
  // The controller and its settings also stand on Identify, where they can still be chosen.
  const ofLoop = h("div", { class: "of-loop" }, mineCard.element, today.element);
  const loopBar = h("div", { class: "loop-bar" }, today.names);
  const examples = h("div", { class: "examples" });
  const recent = h("p", { class: "recent", hidden: true });
  const element = h(
    "main",
    { class: "start", id: "main" },
    heading,
    h(
      "p",
      { class: "lead" },
      "Describe your process in one of five ways and press its button: you get settings, and how robust the loop is with them.",
    ),
    recent,
    status,
    kept.element,
    errors.summary,
    loopBar,
    h(
      "div",
      { class: "cards" },
      record.element,
      model.element,
      h(
        "section",
        { class: "card", "aria-labelledby": "examples-title" },
        h("h2", { id: "examples-title" }, "Nothing yet"),
        h("p", { class: "hint" }, "Try a ready-made example."),
        examples,
      ),
    ),
    equations.element,
    ultimate.element,
    methods.element,
  );
  loopBar.prepend(ofLoop);

  for (const [kind, card] of [["model", model], ["equations", equations], ["ultimate", ultimate]] as const)
    for (const event of ["input", "submit"]) card.element.addEventListener(event, () => turnTo(kind), true);
  // The fields follow first.
  for (const part of [element, ofLoop]) part.addEventListener("change", () => queueMicrotask(events.onChange));
  // Another model that replaces an example's is not a variation of it.
  model.element.addEventListener("input", ({ target }) => ofExample && model.isLine(target) && beginLoop("model"), true);

  /** A new loop does not inherit values of the previous loop or of a filled form; values typed since then are kept. */
  function beginLoop(kind: LoopKind): void {
    loops += 1;
    id = nextId();
    ofExample = false;
    loop = kind;
    base = {};
    for (const card of [today, methods, model]) card.beginLoop();
    showMine(inUnits(store.get().mine, unitNames(today.readUnits())));
  }

  /** The current loop is now described on another card. */
  function turnTo(kind: LoopKind): void {
    if (loop === null || loop === kind) loop = kind;
    else beginLoop(kind);
  }

  /** A job was created: the whole form belongs to that loop. */
  function endLoop(): void {
    id = nextId();
    for (const card of [today, methods, record]) card.endLoop();
  }

  /** `own`: the request comes from the form. */
  async function send(request: TuningRequest, faults: FieldError[], all: boolean, own = true): Promise<void> {
    errors.clear();
    if (faults.length > 0) return errors.show(faults);
    if (busy) return;
    busy = true;
    element.setAttribute("aria-busy", "true");
    try {
      const job = await postJob(request);
      if (own) endLoop();
      events.onJob(job, all);
    } catch (error) {
      errors.fail(error, error instanceof ApiError ? atRecordText(error.problem.errors ?? []) : []);
    } finally {
      busy = false;
      element.removeAttribute("aria-busy");
    }
  }

  function common(all: boolean): { request: TuningRequest; faults: FieldError[] } {
    const units = today.readUnits();
    const baseline = today.read();
    const chosen = all ? { tune: EVERY_METHOD, errors: [] } : methods.read();
    const { plant: _p, record: _r, identify: _i, uncertainty: _u, ultimate: _ultimate, ...kept } = base;
    const own = mineCard.read();
    // A program named in a loaded request is kept; it has no field here.
    const request: TuningRequest = own.mine || kept.implement?.product ? withImplement(kept, implementOf(own.mine)) : kept;
    delete request.name;
    delete request.units;
    delete request.baseline;
    if (today.readName()) request.name = today.readName();
    if (units) request.units = units;
    request.tune = chosen.tune;
    if (baseline.baseline) request.baseline = baseline.baseline;
    return { request, faults: [...chosen.errors, ...baseline.errors, ...own.errors] };
  }

  const showKept = (): void => kept.show(unshown());

  function compose(subject: TuneSubject, all = false): { request: TuningRequest; faults: FieldError[] } {
    const { request, faults } = common(all);
    // The region over which a loaded request holds its limits belongs to its record; Identify has its own choice.
    const held = "record" in subject && base.record ? { uncertainty: base["uncertainty"] } : {};
    // A plant alone has no record in which they could be found.
    if (!("record" in subject) && request.baseline === "from-record") delete request.baseline;
    return { request: { ...request, ...defined({ ...held, ...subject }) }, faults };
  }

  async function tunePlant(reading: PlantReading, all: boolean): Promise<void> {
    const { request, faults } = compose({ plant: reading.plant }, all);
    await send(request, [...reading.errors, ...faults], all);
  }

  async function tuneModel(all: boolean): Promise<void> {
    subject = "model";
    turnTo("model");
    await model.settled();
    await tunePlant(model.read(), all);
  }

  async function tuneEquations(all: boolean): Promise<void> {
    subject = "equations";
    turnTo("equations");
    await tunePlant(equations.read(), all);
  }

  async function tuneUltimate(): Promise<void> {
    turnTo("ultimate");
    const reading = ultimate.read();
    const { name, units } = common(true).request;
    const request: TuningRequest = { ...(name ? { name } : {}), ...(units ? { units } : {}), ultimate: reading.ultimate };
    await send(request, reading.errors, false);
  }

  async function tuneRecord(all: boolean): Promise<void> {
    turnTo("record");
    await today.settled();
    const reading = record.read();
    const { request, faults } = compose({ record: reading.record, identify: reading.identify }, all);
    await send(request, [...reading.errors, ...faults], all);
  }

  function identifyRecord(): void {
    turnTo("record");
    const reading = record.read();
    errors.clear();
    if (reading.errors.length > 0) return errors.show(reading.errors);
    const { record: test, identify } = reading;
    const name = today.readName();
    const units = today.readUnits();
    events.onRecord({ ...(name ? { name } : {}), ...(units ? { units } : {}), record: test, identify });
  }

  /** The members of the request without a field. */
  function unshown(): Record<string, unknown> {
    const { name: _name, units: _units, tune: _tune, baseline: _baseline, implement, ...others } = common(true).request;
    const { product: _product, y_span: _y, u_span: _u, sample_time: _time, ...built } = implement ?? {};
    return Object.keys(built).length > 0 ? { ...others, implement: built } : others;
  }

  function loopTexts(): Record<string, string> {
    const rest = unshown();
    return {
      ...today.texts(),
      ...mineCard.texts(),
      ...methods.texts(),
      rest: Object.keys(rest).length > 0 ? JSON.stringify(rest) : "",
    };
  }

  function showLoop(texts: Record<string, string>): void {
    filling = true;
    const { controller = "" } = texts;
    base = objectOf(texts["rest"]) as TuningRequest;
    if (controller !== "") {
      showMine({ product: controller, name: controller, needs: [] });
      base = { ...base, implement: { ...base.implement, product: controller } };
      mineCard.setTexts(texts);
      showMine(mineCard.read().mine);
    }
    today.setTexts(texts);
    methods.setTexts(texts);
    showKept();
    filling = false;
  }

  function restore(texts: StartTexts): void {
    errors.clear();
    loops += 1;
    id = texts.id;
    ofExample = false;
    loop = texts.kind;
    model.loadTyped(texts.model.form, texts.model.values);
    if (JSON.stringify(texts.equations) !== JSON.stringify(equations.typed())) equations.loadTyped(texts.equations);
    ultimate.setTexts(texts.ultimate);
    showLoop(texts.loop);
  }

  function address(): { plant: string; values: Record<string, string> } | null {
    if (loop === "record" || loop === "ultimate") return null;
    const { form, values } = loop === "equations" ? { form: "nonlinear", values: equations.typed() } : model.typed();
    const { "today.typed": _typed, "today.record": _record, ...typed } = loopTexts();
    return { plant: form, values: { ...values, ...(typed["today.form"] === "ideal" ? { ...typed, "today.form": "" } : typed) } };
  }

  function load(request: TuningRequest, example = false): void {
    errors.clear();
    endLoop();
    loops += 1;
    ofExample = example;
    base = request;
    loop = kindOf(request);
    status.hidden = true;
    today.offerRecord(null);
    showMine(mineOfRequest(request.implement, inUnits(store.get().mine, unitNames(request.units))));
    today.offerRecord(request.record && request.baseline === "from-record" ? () => record.read().record : null);
    today.load(request.units, request.baseline, request.name);
    methods.load(request.tune);
    if (request.record) record.load(request.record, request.identify);
    ultimate.load(request);
    if (request.plant && !equations.load(request.plant) && !model.load(request.plant)) {
      status.textContent = `A plant of type ${request.plant.type} in this shape has no form here; send it to the service's API, or choose another kind.`;
      status.hidden = false;
    }
  }

  /** Without reporting: the controller of a loaded request is not stored. */
  function showMine(next: MyController | null): void {
    mine = named(next, store.get().products);
    mineCard.set(mine);
    today.setMine(mine);
    showKept();
  }

  function showLists(workspace: Workspace): void {
    if (workspace.serviceTrouble !== troubled) {
      troubled = status.textContent = workspace.serviceTrouble;
      status.hidden = troubled === "";
    }
    const elements = workspace.examples.map((example) =>
      exampleElement(example, (all) =>
        void send(all ? byAllMethods(example.request) : example.request, [], all, false),
      ),
    );
    const [first, others] = [elements.slice(0, EXAMPLES_SHOWN), elements.slice(EXAMPLES_SHOWN)];
    equations.setExamples(workspace.examples);
    examples.replaceChildren(
      ...first,
      ...(others.length > 0
        ? [h("details", {}, h("summary", {}, `${others.length} more`), h("div", { class: "examples" }, others))]
        : []),
    );
    recent.hidden = workspace.recent.length === 0;
    recent.replaceChildren(
      "Recent: ",
      ...workspace.recent.flatMap((job, index) => [
        index > 0 ? " · " : "",
        h(
          "a",
          { href: formatRoute({ screen: "design", job: job.id, entry: null }) },
          job.name || `job ${job.id.slice(0, 8)}`,
        ),
      ]),
    );
  }

  methods.setMethods(store.get().methods);
  mineCard.setProducts(store.get().products);
  mineCard.setUnits(unitNames(today.readUnits()));
  showMine(inUnits(mine, unitNames(today.readUnits())));
  showLists(store.get());
  const leave = store.subscribe((workspace, previous) => {
    if (workspace.methods !== previous.methods) methods.setMethods(workspace.methods);
    if (workspace.products !== previous.products) {
      mineCard.setProducts(workspace.products);
      showMine(mine);
    }
    // Chosen on Design.
    if (workspace.mine !== previous.mine && workspace.mine !== mine)
      showMine(inUnits(workspace.mine, unitNames(today.readUnits())));
    const changed =
      workspace.examples !== previous.examples ||
      workspace.recent !== previous.recent ||
      workspace.serviceTrouble !== previous.serviceTrouble;
    if (changed) showLists(workspace);
  });
  return {
    element,
    heading,
    dispose: leave,
    load,
    loadTyped(form, values) {
      const kind = form === "nonlinear" ? "equations" : "model";
      const another = kind === "equations" ? equations.loadTyped(values) : model.loadTyped(form, values);
      if (another && loop !== null) beginLoop(kind);
      else if (another) loop = kind;
      if (Object.keys(values).some((name) => ABOUT_LOOP.test(name))) showLoop(values);
    },
    texts: () => ({
      id,
      kind: loop,
      model: model.typed(),
      equations: equations.typed(),
      ultimate: ultimate.texts(),
      loop: loopTexts(),
    }),
    restore,
    address,
    loadRecord: record.load,
    beginLoop,
    endLoop,
    loops: () => loops,
    compose,
    ofLoop,
    takeBack: () => loopBar.prepend(ofLoop),
    offerRecord: (given) => today.offerRecord(given && (() => given), true),
    settled: today.settled,
    mark(faults) {
      for (const scope of ["/implement", "/baseline"]) errors.mark(scope, faults);
    },
    units: today.readUnits,
    typedUnits: today.typedUnits,
    methods() {
      const { tune } = methods.read();
      return tune.map((entry) => entry.method.replaceAll("_", " "));
    },
  };
}

function kindOf({ record, ultimate, plant }: TuningRequest): LoopKind {
  if (record) return "record";
  if (ultimate) return "ultimate";
  return plant?.type === "nonlinear" ? "equations" : "model";
}
