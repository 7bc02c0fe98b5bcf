// Starts the page: header, routes, the job that is followed, and what happens when something unforeseen goes wrong.
import { getExamples, getJob, getMethods, getRecentJobs, postJob, postJobAndWait, watchJob } from "./api/jobs.ts";
import { askForKeyWith } from "./api/key.ts";
import { getProducts } from "./api/products.ts";
import { isFinal } from "./api/types.ts";
import type { FieldError, IdentifyRequest, Job, TuningRequest } from "./api/types.ts";
import { h } from "./dom.ts";
import { byAllMethods } from "./form/tuning_request.ts";
import type { TuneSubject } from "./form/tuning_request.ts";
import { rememberedMine } from "./my_controller.ts";
import { formatRoute, parseRoute } from "./routes.ts";
import type { Route } from "./routes.ts";
import { createStore } from "./store.ts";
import { applyTheme, themeButton } from "./theme.ts";
import { compareView } from "./views/compare.ts";
import { designView } from "./views/design.ts";
import { identifyView, noRecordView } from "./views/identify.ts";
import { askInDialog } from "./views/key_dialog.ts";
import { methodsView } from "./views/methods.ts";
import { relayView } from "./views/relay.ts";
import type { RelayView } from "./views/relay.ts";
import { startView } from "./views/start.ts";
import type { StartView, View } from "./views/start.ts";

const store = createStore({
  route: { screen: "start" },
  job: null,
  jobTrouble: "",
  selected: null,
  drawn: null,
  sort: "",
  test: null,
  methods: [],
  products: [],
  mine: rememberedMine(),
  examples: [],
  recent: [],
  serviceTrouble: "",
});

const status = h("p", { class: "visually-hidden", role: "status" });
const announce = (sentence: string): void => {
  status.textContent = sentence;
};
const links = {
  start: h("a", { href: "#/" }, "Start"),
  identify: h("a", { href: "#/identify" }, "Identify"),
  relay: h("a", { href: "#/relay" }, "Relay test"),
  design: h("a", { href: "#/", hidden: true }, "Design"),
  compare: h("a", { href: "#/", hidden: true }, "Compare"),
  methods: h("a", { href: "#/methods" }, "Methods"),
};
const skip = h("a", { class: "skip", href: "#main" }, "Skip to the content");
const stage = h("div", { class: "stage" });

let view: View | null = null;
let start: StartView | null = null;
let relay: RelayView | null = null;
let stopWatching: (() => void) | null = null;

askForKeyWith(askInDialog);
document.body.append(
  skip,
  h(
    "header",
    { class: "top" },
    h("a", { class: "brand", href: "#/" }, "Tunewright"),
    h("nav", { "aria-label": "Screens" }, Object.values(links)),
    h("div", { class: "tools" }, h("a", { href: "openapi.json" }, "API"), themeButton()),
  ),
  stage,
  status,
);
skip.addEventListener("click", (event) => {
  event.preventDefault();
  view?.heading.focus();
});

function mount(next: View, title: string, focus: boolean): void {
  if (view !== next) {
    if (view && view !== start && view !== relay) view.dispose();
    view = next;
    stage.replaceChildren(next.element);
    window.scrollTo(0, 0);
    if (focus) next.heading.focus();
  }
  document.title = title;
}

/** The start screen is kept: what was typed is still there when one comes back. */
function startScreen(): StartView {
  start ??= startView(store, {
    onJob: (job, all) => openJob(job, all ? "compare" : "design"),
    onRecord: openRecord,
    onRelay(form, values) {
      location.hash = formatRoute({ screen: "relay", plant: form, values });
    },
    onModel(form, values) {
      history.replaceState(null, "", formatRoute({ screen: "new", plant: form, values }));
    },
  });
  return start;
}

/** Kept too, with what was typed. */
function relayScreen(): RelayView {
  relay ??= relayView(announce, {
    units: () => startScreen().units(),
    onIdentify: openRecord,
    onPlant(form, values) {
      history.replaceState(null, "", formatRoute({ screen: "relay", plant: form, values }));
    },
  });
  return relay;
}

type JobScreen = "design" | "compare";
const addressOf = (job: string, screen: JobScreen): string =>
  formatRoute(screen === "design" ? { screen, job, entry: null } : { screen, job, sort: "", rows: null });

function openJob(job: Job, screen: JobScreen = "design"): void {
  store.set((workspace) => ({ ...workspace, job, jobTrouble: "", selected: null, drawn: null, sort: "" }));
  location.hash = addressOf(job.id, screen);
}

/** Every method on what this request is about. */
async function compareAll(request: TuningRequest): Promise<void> {
  openJob(await postJob(byAllMethods(request)), "compare");
}

/** A job in the place of the one that is shown: the screen stays, Back leads where it led before. */
async function retune(request: TuningRequest, index: number): Promise<void> {
  const from = store.get().route;
  const job = await postJobAndWait(request, 20);
  const failure = job.error ?? job.result?.controllers[index]?.error;
  if (failure) throw new Error(failure.detail ?? failure.title ?? "There is no such design.");
  if (store.get().route !== from || from.screen !== "design") return;
  const route: Route = { ...from, job: job.id };
  store.set((workspace) => ({ ...workspace, route, job, jobTrouble: "" }));
  history.replaceState(null, "", formatRoute({ ...route, entry: store.get().selected }));
  linkScreens(job.id);
  if (!isFinal(job.status)) follow(job.id);
}

function openRecord(test: IdentifyRequest): void {
  store.set((workspace) => ({ ...workspace, test }));
  const address = formatRoute({ screen: "identify", job: null });
  if (location.hash === address) go(false);
  else location.hash = address;
}

/** What Identify found goes to the tuner with the methods and settings that stand on Start. */
async function tuneSubject(subject: TuneSubject, all: boolean): Promise<FieldError[]> {
  const { request, faults } = startScreen().compose(subject, all);
  if (faults.length > 0) return faults;
  openJob(await postJob(request), all ? "compare" : "design");
  return [];
}

function identifyScreen(test: IdentifyRequest, region = false): View {
  return identifyView(test, { methods: startScreen().methods(), region }, announce, {
    onChange(changed) {
      store.set((workspace) => ({ ...workspace, test: changed }));
      startScreen().loadRecord(changed.record, changed.identify);
    },
    onTune: tuneSubject,
  });
}

/** A job's record, with the methods and settings of its request. */
async function openJobRecord(id: string, focus: boolean): Promise<void> {
  try {
    const known = store.get().job;
    const job = known?.id === id && known.request ? known : await getJob(id);
    const { name, units, record, identify } = job.request ?? {};
    const route = store.get().route;
    if (route.screen !== "identify" || route.job !== id) return;
    if (!record || !job.request) return mount(noRecordView(), "Identify · Tunewright", focus);
    startScreen().load(job.request);
    const test: IdentifyRequest = {
      ...(name ? { name } : {}),
      ...(units ? { units } : {}),
      record,
      ...(identify ? { identify } : {}),
    };
    store.set((workspace) => ({ ...workspace, test }));
    mount(identifyScreen(test, job.request["uncertainty"] === "identified"), "Identify · Tunewright", focus);
  } catch (error) {
    mount(noRecordView(error instanceof Error ? error.message : String(error)), "Identify · Tunewright", focus);
  }
}

function follow(id: string): void {
  stopWatching?.();
  stopWatching = watchJob(id, {
    onJob: takeJob,
    onTrouble: (sentence) => store.set((workspace) => ({ ...workspace, jobTrouble: sentence })),
  });
}

const showsJob = (route: Route): route is Extract<Route, { screen: JobScreen }> =>
  route.screen === "design" || route.screen === "compare";

function takeJob(job: Job): void {
  store.set((workspace) =>
    showsJob(workspace.route) && workspace.route.job === job.id ? { ...workspace, job, jobTrouble: "" } : workspace,
  );
}

async function refreshRecent(): Promise<void> {
  try {
    const recent = await getRecentJobs(6);
    store.set((workspace) => ({ ...workspace, recent }));
  } catch {
    // The list is a convenience: without it the page works as before.
  }
}

async function loadForm(route: Route): Promise<void> {
  const form = startScreen();
  if (route.screen === "new") form.loadTyped(route.plant, route.values);
  try {
    if (route.screen === "edit") {
      const known = store.get().job;
      const job = known?.id === route.job && known.request ? known : await getJob(route.job);
      if (job.request) form.load(job.request);
    }
    if (route.screen === "example") {
      await lists;
      const example = store.get().examples.find((candidate) => candidate.id === route.id);
      if (example) form.load(example.request);
      else store.set((workspace) => ({ ...workspace, serviceTrouble: `There is no example "${route.id}".` }));
    }
  } catch (error) {
    store.set((workspace) => ({
      ...workspace,
      serviceTrouble: error instanceof Error ? error.message : String(error),
    }));
  }
}

function markCurrent(route: Route): void {
  for (const [screen, link] of Object.entries(links)) {
    const shown = route.screen === screen || (screen === "start" && !(route.screen in links));
    if (shown) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
}

function linkScreens(job: string): void {
  for (const screen of ["design", "compare"] as const) {
    links[screen].href = addressOf(job, screen);
    links[screen].hidden = false;
  }
}

function openJobScreen(route: Extract<Route, { screen: JobScreen }>, focus: boolean): void {
  const before = store.get();
  const same = before.job?.id === route.job;
  const kept = same ? before : { job: null, selected: null, drawn: null, sort: "" };
  store.set((workspace) => ({
    ...workspace,
    job: kept.job,
    jobTrouble: "",
    selected: (route.screen === "design" ? route.entry : null) ?? kept.selected,
    drawn: (route.screen === "compare" ? route.rows : null) ?? kept.drawn,
    sort: route.screen === "compare" ? route.sort : kept.sort,
  }));
  linkScreens(route.job);
  if (route.screen === "design") {
    const events = { onJob: takeJob, onRetune: retune, onCompareAll: compareAll };
    mount(designView(store, announce, events), "Design · Tunewright", focus);
  } else {
    mount(compareView(store, announce, { onJob: takeJob, onCompareAll: compareAll }), "Compare · Tunewright", focus);
  }
  follow(route.job);
}

function go(first: boolean): void {
  const route = parseRoute(location.hash);
  const before = store.get();
  store.set((workspace) => ({ ...workspace, route }));
  markCurrent(route);
  if (showsJob(route)) return openJobScreen(route, !first);
  stopWatching?.();
  stopWatching = null;
  if (route.screen === "identify") {
    if (route.job !== null) return void openJobRecord(route.job, !first);
    const test = before.test;
    mount(test ? identifyScreen(test) : noRecordView(), "Identify · Tunewright", !first);
    return;
  }
  if (route.screen === "relay") {
    const screen = relayScreen();
    mount(screen, "Relay test · Tunewright", !first);
    screen.open(route.plant, route.values);
    return;
  }
  if (route.screen === "methods") {
    mount(methodsView(store, route.id), "Methods · Tunewright", !first);
    return;
  }
  mount(startScreen(), "Tunewright", !first);
  void loadForm(route);
  void refreshRecent();
}

// The address follows what is chosen, and the title the loop's name.
store.subscribe((workspace, previous) => {
  const route = workspace.route;
  if (!showsJob(route)) return;
  const { selected, drawn, sort } = workspace;
  const changed = selected !== previous.selected || drawn !== previous.drawn || sort !== previous.sort;
  if (changed && workspace.job?.id === previous.job?.id)
    history.replaceState(
      null,
      "",
      formatRoute(route.screen === "design" ? { ...route, entry: selected } : { ...route, sort, rows: drawn }),
    );
  const name = workspace.job?.name || workspace.job?.request?.name;
  const screen = route.screen === "design" ? "Design" : "Compare";
  document.title = name ? `${name} · ${screen} · Tunewright` : `${screen} · Tunewright`;
});

async function loadLists(): Promise<void> {
  const [methods, examples, products] = await Promise.allSettled([getMethods(), getExamples(), getProducts()]);
  store.set((workspace) => ({
    ...workspace,
    methods: methods.status === "fulfilled" ? methods.value : workspace.methods,
    examples: examples.status === "fulfilled" ? examples.value : workspace.examples,
    // Without the list a controller cannot be chosen; everything else works as before.
    products: products.status === "fulfilled" ? products.value : workspace.products,
    serviceTrouble:
      methods.status === "rejected"
        ? "The service's list of methods could not be read; the default method is used."
        : "",
  }));
}

function fault(reason: unknown): void {
  const words = reason instanceof Error ? reason.message : String(reason);
  stage.prepend(
    h(
      "p",
      { class: "trouble", role: "alert" },
      `Something went wrong in this page: ${words}. Reload it; your jobs are kept by the service.`,
    ),
  );
}

window.addEventListener("error", (event) => fault(event.error ?? event.message));
window.addEventListener("unhandledrejection", (event) => fault(event.reason));
window.addEventListener("hashchange", () => go(false));
applyTheme();
const lists = loadLists();
go(true);
