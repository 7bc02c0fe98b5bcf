// The screen for the address: created, kept or created again, and the data that screens pass to each other.
import { notConnected, sentenceOf, whenBack } from "./api/client.ts";
import { getJob, getRecentJobs, postJob } from "./api/jobs.ts";
import { isCheckRequest } from "./api/check.ts";
import { isRangeRequest } from "./api/range.ts";
import type { Batch, FieldError, IdentifyRequest, Job, TuningRequest, Units } from "./api/types.ts";
import type { CheckView } from "./check/view.ts";
import { h } from "./dom.ts";
import type { TuneSubject } from "./form/tuning_request.ts";
import { isStructureRequest } from "./api/structure.ts";
import type { JobFlow } from "./job_flow.ts";
import type { RangeView } from "./range/view.ts";
import { addressOfJob, addressOfStructure, entryState, formatRoute, keepInEntry, parseRoute, rewriteAddress, showsJob, showsStart, WHOLE_LIST } from "./routes.ts";
import type { CheckRoute, JobRoute, Route, RulesRoute, StructureRoute } from "./routes.ts";
import type { Store } from "./store.ts";
import type { RulesView } from "./rules/view.ts";
import type { StructureView } from "./structure/view.ts";
import type { CandidateChoice } from "./views/cards/candidates_card.ts";
import type { RelayView } from "./views/relay.ts";
import { startView } from "./views/start.ts";
import type { StartView, View } from "./views/start.ts";

const loadDesign = () => import("./views/design.ts");

export interface Screens {
  /** Shows the screen of the address. `first`: nothing was shown before, and the focus stays. */
  go(first: boolean): void;
  focusHeading(): void;
}

/** Shown if the code of a screen could not be loaded. */
function awayView(title: string): View {
  const heading = h("h1", { tabindex: -1 }, title);
  const trouble = h("p", { class: "trouble", role: "status" }, sentenceOf(notConnected()));
  return { element: h("main", { id: "main" }, heading, trouble), heading, dispose: () => undefined };
}

/** `listed`: resolves when methods and examples are known. */
export function screens(
  store: Store,
  flow: JobFlow,
  stage: HTMLElement,
  announce: (sentence: string) => void,
  listed: Promise<void>,
): Screens {
  let view: View | null = null;
  let start: StartView | null = null;
  let relay: RelayView | null = null;
  let range: RangeView | null = null;
  let check: CheckView | null = null;
  let structure: StructureView | null = null;
  let rules: RulesView | null = null;
  /** The loop on Start whose plant the relay test uses; null: it has one of its own. */
  let relayOf: { units: Units | undefined; loop: number } | null = null;
  const ofStart = (): boolean => relayOf !== null && relayOf.loop === startScreen().loops();
  /** The number of times that the form of Start was filled from elsewhere. */
  let fills = 0;
  /** The choice on Identify, for the record at that address. */
  let remembered: { address: string; choice: CandidateChoice } | null = null;

  function mount(next: View, title: string, focus: boolean): void {
    if (view !== next) {
      if (view && ![start, relay, range, check, structure, rules].includes(view as never)) view.dispose();
      if (next === start) start.takeBack();
      view = next;
      stage.replaceChildren(next.element);
      window.scrollTo(0, 0);
      if (focus) next.heading.focus();
    }
    document.title = title;
  }

  /** A typed plant is written to the address, if its screen is still shown when the service has parsed it. */
  function typed(own: (route: Route) => boolean, route: Route): void {
    const from = store.get().route;
    if (!own(from)) return;
    store.set((workspace) => ({ ...workspace, route }));
    rewriteAddress(from, route);
  }

  /** The start screen is kept: typed text is still there on return. */
  function startScreen(): StartView {
    if (start) return start;
    start = startView(store, {
      onJob: (job, all) => flow.open(job, all ? "compare" : "design"),
      onRecord: openRecord,
      onRelay(form, values) {
        relayOf = { units: startScreen().units(), loop: startScreen().loops() };
        location.hash = formatRoute({ screen: "relay", plant: form, values });
      },
      onChange: startChanged,
    });
    // Read before it is needed, as soon as somebody works here.
    for (const event of ["pointerdown", "focusin", "dragenter"])
      start.element.addEventListener(event, () => void loadDesign().catch(() => undefined), { once: true });
    return start;
  }

  /** The content of the form stays with this entry of the history. */
  function keepStart(): void {
    const { route } = store.get();
    if (start && (showsStart(route) || route.screen === "identify")) keepInEntry(route, { start: start.texts() });
  }

  /** And in the address, as far as that can hold it. */
  function startChanged(): void {
    const address = showsStart(store.get().route) ? start?.address() : null;
    if (address) typed(showsStart, { screen: "new", ...address });
    keepStart();
  }

  /** After Back, or a reload: the form as this entry of the history left it. False if it left none. */
  function restoreStart(): boolean {
    const { start: texts } = entryState();
    if (!texts) return false;
    const shown = startScreen();
    if (texts.id !== shown.texts().id) {
      shown.restore(texts);
      const { test } = store.get();
      if (texts.kind === "record" && test) shown.loadRecord(test.record, test.identify);
    } else keepStart();
    return true;
  }

  /** A screen in a file of its own, which most visits do not need; null if another is shown by now, or if it cannot
      be loaded. */
  async function later<Part>(load: Promise<Part>, route: Route, title: string, focus: boolean): Promise<Part | null> {
    const part = await load.catch(() => null);
    if (store.get().route !== route) return null;
    if (!part) mount(awayView(title), `${title} · Tunewright`, focus);
    return part;
  }

  /** Kept as well, with the design that it shows. */
  async function openRange(route: Extract<Route, { screen: "range" }>, focus: boolean): Promise<void> {
    const part = await later(import("./range/view.ts"), route, "Range", focus);
    if (!part) return;
    const { rangeView } = part;
    range ??= rangeView(store, announce, {
      onExample(id) {
        rewriteAddress(route, { screen: "range", example: id, job: null });
      },
      onJob: (request) => flow.tune(request as TuningRequest),
    });
    mount(range, "Range · Tunewright", focus);
    range.open(route);
  }

  /** Kept as well, with its files and its result. */
  async function openCheck(route: CheckRoute, focus: boolean): Promise<void> {
    const part = await later(import("./check/view.ts"), route, "Check", focus);
    if (!part) return;
    check ??= part.checkView(announce, {
      onList(next) {
        rewriteAddress(next, next);
      },
      onIdentify(test) {
        startScreen().beginLoop("record");
        openRecord(test);
      },
      async onTune(test) {
        fillForm(test);
        const [fault] = await tuneSubject({ record: test.record }, false);
        if (fault) throw new Error(fault.detail);
      },
    });
    mount(check, "Check · Tunewright", focus);
    check.open(route);
  }

  /** Kept as well; its address holds the whole question. */
  async function openStructure(route: StructureRoute, focus: boolean): Promise<void> {
    const part = await later(import("./structure/view.ts"), route, "Structure", focus);
    if (!part) return;
    structure ??= part.structureView(store, announce, {
      onQuestion(next) {
        rewriteAddress(next, next);
      },
    });
    mount(structure, "Structure · Tunewright", focus);
    structure.open(route);
  }

  async function openRules(route: RulesRoute, focus: boolean): Promise<void> {
    const part = await later(import("./rules/view.ts"), route, "Rules", focus);
    if (!part) return;
    rules ??= part.rulesView(store, announce, {
      onQuestion(next) {
        rewriteAddress(next, next);
      },
      onTune: flow.tune,
    });
    mount(rules, "Rules · Tunewright", focus);
    rules.open(route);
  }

  /** Kept too, with its typed text. */
  async function openRelay(route: Extract<Route, { screen: "relay" }>, focus: boolean): Promise<void> {
    const part = await later(import("./views/relay.ts"), route, "Relay test", focus);
    if (!part) return;
    relay ??= part.relayView(announce, {
      units: () => (ofStart() ? relayOf!.units : startScreen().typedUnits()),
      onIdentify(test) {
        if (!ofStart()) startScreen().beginLoop("record");
        openRecord(test);
      },
      onPlant: (plant, values) => typed(({ screen }) => screen === "relay", { screen: "relay", plant, values }),
    });
    mount(relay, "Relay test · Tunewright", focus);
    relay.open(route.plant, route.values);
  }

  function openRecord(test: IdentifyRequest): void {
    store.set((workspace) => ({ ...workspace, test }));
    const address = formatRoute({ screen: "identify", job: null });
    remembered = null;
    if (location.hash === address) go(false);
    else location.hash = address;
  }

  /** The result of Identify is tuned with the methods and settings of Start. */
  async function tuneSubject(subject: TuneSubject, all: boolean): Promise<FieldError[]> {
    await startScreen().settled();
    const { request, faults } = startScreen().compose(subject, all);
    startScreen().mark(faults);
    if (faults.length > 0) return faults;
    const job = await postJob(request);
    startScreen().endLoop();
    flow.open(job, all ? "compare" : "design");
    return [];
  }

  /** `test`: the record, or the reason why there is none ("": none was dropped). */
  async function openIdentify(route: Route, test: IdentifyRequest | string, focus: boolean, region = false): Promise<void> {
    const part = await later(import("./views/identify.ts"), route, "Identify", focus);
    if (!part) return;
    if (typeof test === "string") return mount(part.noRecordView(test), "Identify · Tunewright", focus);
    const address = location.hash;
    const first = remembered?.address === address ? remembered.choice : { structure: "", region };
    const view = part.identifyView(test, { ofLoop: startScreen().ofLoop, methods: startScreen().methods(), first }, announce, {
      onLoop: startScreen().offerRecord,
      onRemember(choice) {
        remembered = { address, choice };
      },
      onChange(changed) {
        store.set((workspace) => ({ ...workspace, test: changed }));
        startScreen().loadRecord(changed.record, changed.identify);
      },
      onTune: tuneSubject,
    });
    mount(view, "Identify · Tunewright", focus);
    keepStart();
  }

  /** A job's record, with the methods and settings of its request. */
  async function openJobRecord(id: string, focus: boolean): Promise<void> {
    const { route, job: known } = store.get();
    try {
      const job = known?.id === id && known.request ? known : await getJob(id);
      const { name, units, record, identify } = job.request ?? {};
      if (store.get().route !== route) return;
      if (!record || !job.request) return void openIdentify(route, "", focus);
      fillForm(job.request);
      const test: IdentifyRequest = {
        ...(name ? { name } : {}),
        ...(units ? { units } : {}),
        record,
        ...(identify ? { identify } : {}),
      };
      store.set((workspace) => ({ ...workspace, test }));
      void openIdentify(route, test, focus, job.request["uncertainty"] === "identified");
    } catch (error) {
      if (store.get().route === route) void openIdentify(route, sentenceOf(error), focus);
    }
  }

  async function refreshRecent(): Promise<void> {
    try {
      const recent = await getRecentJobs(6);
      store.set((workspace) => ({ ...workspace, recent }));
    } catch {
      // The list is optional: without it the page still works.
    }
  }

  function fillForm(request: TuningRequest, example = false): void {
    fills += 1;
    startScreen().load(request, example);
  }

  /** Identifies the content of the form; a reload of the page starts again. */
  const fillMark = (): string => `${performance.timeOrigin}/${fills}/${startScreen().loops()}`;

  /** An entry of the history remembers how it filled the form: Back finds the text typed since then. */
  function fillForEntry(request: TuningRequest, example: boolean): void {
    fillForm(request, example);
    restoreStart();
    keepInEntry(store.get().route, { fill: fillMark() });
    keepStart();
  }

  const isAsLeft = (): boolean => entryState().fill === fillMark();

  async function loadForm(route: Route): Promise<void> {
    if (isAsLeft()) return void restoreStart();
    if ((route.screen === "new" || route.screen === "start") && restoreStart()) return;
    if (route.screen === "new") {
      fills += 1;
      startScreen().loadTyped(route.plant, route.values);
      keepStart();
    }
    try {
      if (route.screen === "edit") {
        const known = store.get().job;
        const job = known?.id === route.job && known.request ? known : await getJob(route.job);
        if (store.get().route !== route) return;
        // A range is changed on its own screen.
        if (isRangeRequest(job.request))
          return location.replace(formatRoute({ screen: "range", example: "", job: job.id }));
        if (isStructureRequest(job.request)) return location.replace(addressOfStructure(job.id));
        if (isCheckRequest(job.request))
          return location.replace(formatRoute({ screen: "check", of: null, from: job.id, before: null, loop: null, other: null, list: WHOLE_LIST }));
        if (job.request) fillForEntry(job.request, false);
      }
      if (route.screen === "example") {
        await listed;
        if (store.get().route !== route) return;
        const example = store.get().examples.find((candidate) => candidate.id === route.id);
        if (example) fillForEntry(example.request, true);
        else store.set((workspace) => ({ ...workspace, serviceTrouble: `There is no example "${route.id}".` }));
      }
    } catch (error) {
      if (store.get().route !== route) return;
      const sentence = sentenceOf(error);
      store.set((workspace) => ({ ...workspace, serviceTrouble: sentence }));
      void whenBack(error, () => {
        store.set((workspace) => (workspace.serviceTrouble === sentence ? { ...workspace, serviceTrouble: "" } : workspace));
        if (store.get().route === route) void loadForm(route);
      });
    }
  }

  /** Search and order are written to the address, without a step in the history. */
  async function openList(route: Extract<Route, { screen: "jobs" | "batch" }>, focus: boolean): Promise<void> {
    const rename = (next: Route): void => rewriteAddress(route, next);
    const onBatch = (batch: Batch): void => {
      location.hash = formatRoute({ screen: "batch", id: batch.id, sort: "" });
    };
    if (route.screen === "batch") {
      const part = await later(import("./views/batch.ts"), route, "Jobs", focus);
      if (!part) return;
      const onSort = (sort: string): void => rename({ ...route, sort });
      return mount(part.batchView(route.id, route.sort, announce, { onBatch, onSort }), "Jobs · Tunewright", focus);
    }
    const part = await later(import("./views/jobs.ts"), route, "Jobs", focus);
    if (!part) return;
    const onSearch = (text: string): void => rename({ ...route, text });
    const onJob = (job: Job): void => flow.open(job);
    mount(part.jobsView(store, route.text, announce, { onBatch, onSearch, onJob }), "Jobs · Tunewright", focus);
  }

  async function openMethods(route: Extract<Route, { screen: "methods" }>, focus: boolean): Promise<void> {
    const part = await later(import("./views/methods.ts"), route, "Methods", focus);
    if (part) mount(part.methodsView(store, route.id), "Methods · Tunewright", focus);
  }

  async function openApi(route: Extract<Route, { screen: "docs" }>, focus: boolean): Promise<void> {
    const part = await later(import("./api_page/view.ts"), route, "API", focus);
    if (part) mount(part.apiView(route.call, announce), "API · Tunewright", focus);
  }

  async function openDesign(route: Route, focus: boolean): Promise<void> {
    const part = await later(loadDesign(), route, "Design", focus);
    const events = { onJob: flow.take, onTune: flow.tune, onRetune: flow.retune, onCompareAll: flow.compareAll };
    if (part) mount(part.designView(store, announce, events), "Design · Tunewright", focus);
  }

  async function openCompare(route: Route, focus: boolean): Promise<void> {
    const part = await later(import("./views/compare.ts"), route, "Compare", focus);
    const events = { onJob: flow.take, onCompareAll: flow.compareAll };
    if (part) mount(part.compareView(store, announce, events), "Compare · Tunewright", focus);
  }

  function openJobScreen(route: JobRoute, focus: boolean): void {
    const before = store.get();
    const same = before.job?.id === route.job;
    const kept = same ? before : { job: null, selected: null, drawn: null, sort: "", rankMs: null, step: null };
    store.set((workspace) => ({
      ...workspace,
      job: kept.job,
      jobTrouble: "",
      selected: (route.screen === "design" ? route.entry : null) ?? kept.selected,
      drawn: (route.screen === "compare" ? route.rows : null) ?? kept.drawn,
      sort: route.screen === "compare" ? route.sort : kept.sort,
      rankMs: (route.screen === "compare" ? route.rankMs : null) ?? kept.rankMs,
      step: (route.screen === "design" ? route.step : null) ?? kept.step,
    }));
    // A link to the table alone shows the earlier choices; its address then contains them.
    const { drawn: rows, rankMs } = store.get();
    if (route.screen === "compare") rewriteAddress(route, { ...route, rows, rankMs });
    if (route.screen === "design") void openDesign(route, focus);
    else void openCompare(route, focus);
    flow.follow(route.job);
  }

  function go(first: boolean): void {
    const route = parseRoute(location.hash);
    const before = store.get();
    store.set((workspace) => ({ ...workspace, route }));
    if (showsJob(route)) return openJobScreen(route, !first);
    flow.stop();
    if (route.screen === "identify") {
      if (route.job !== null) return void openJobRecord(route.job, !first);
      const test = before.test;
      // After a reload the record comes from the tab's memory.
      if (first && test && !entryState().start) fillForm({ ...test });
      restoreStart();
      return void openIdentify(route, test ?? "", !first);
    }
    if (route.screen === "range") return void openRange(route, !first);
    if (route.screen === "check") return void openCheck(route, !first);
    if (route.screen === "structure") return void openStructure(route, !first);
    if (route.screen === "rules") return void openRules(route, !first);
    if (route.screen === "relay") return void openRelay(route, !first);
    if (route.screen === "docs") return void openApi(route, !first);
    if (route.screen === "methods") return void openMethods(route, !first);
    if (route.screen === "jobs" || route.screen === "batch") return void openList(route, !first);
    mount(startScreen(), "Tunewright", !first);
    void loadForm(route);
    void refreshRecent();
  }

  // The address follows the choices, and the title follows the loop's name.
  store.subscribe((workspace, previous) => {
    const route = workspace.route;
    if (!showsJob(route)) return;
    const { selected, drawn, sort, rankMs, step } = workspace;
    const parts = ["selected", "drawn", "sort", "rankMs"] as const;
    const changed = parts.some((part) => workspace[part] !== previous[part]);
    if (changed && workspace.job?.id === previous.job?.id)
      rewriteAddress(
        route,
        route.screen === "design"
          ? { screen: "design", job: route.job, entry: selected, ...(step ? { step } : {}) }
          : { ...route, sort, rows: drawn, rankMs },
      );
    // A range has no comparison.
    if (route.screen === "compare" && workspace.job?.id === route.job && isRangeRequest(workspace.job.request))
      return location.replace(addressOfJob(route.job, "design"));
    const name = workspace.job?.name || workspace.job?.request?.name;
    const screen = route.screen === "design" ? "Design" : "Compare";
    document.title = name ? `${name} · ${screen} · Tunewright` : `${screen} · Tunewright`;
  });

  return { go, focusHeading: () => view?.heading.focus() };
}
