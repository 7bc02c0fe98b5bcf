// Starts the page: its state, its head, the screen of the address, and the handling of unexpected errors.
import { sentenceOf, waitAfter } from "./api/client.ts";
import { getExamples, getMethods } from "./api/jobs.ts";
import { askForKeyWith } from "./api/key.ts";
import { watchPresses } from "./api/press.ts";
import { getProducts } from "./api/products.ts";
import { h } from "./dom.ts";
import { header } from "./header.ts";
import { jobFlow } from "./job_flow.ts";
import { shortcuts } from "./reach/shortcuts.ts";
import { rememberedMine } from "./my_controller.ts";
import { rememberedTest, rememberTest } from "./current_record.ts";
import { screens } from "./screens.ts";
import { createStore } from "./store.ts";
import { askInDialog } from "./views/key_dialog.ts";

const store = createStore({
  route: { screen: "start" },
  job: null,
  jobTrouble: "",
  selected: null,
  drawn: null,
  sort: "",
  rankMs: null,
  step: null,
  test: rememberedTest(),
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
const skip = h("a", { class: "skip", href: "#main" }, "Skip to the content");
const stage = h("div", { class: "stage" });

const NO_METHODS = "The service's list of methods could not be read; the default method is used.";

/** Repeated until it succeeds: a restart of the service must not lose typed text. */
async function readList<T>(ask: () => Promise<T>, take: (list: T) => void, trouble = ""): Promise<void> {
  const say = (before: string, now: string): void =>
    store.set((workspace) =>
      workspace.serviceTrouble === before ? { ...workspace, serviceTrouble: now } : workspace,
    );
  for (;;) {
    try {
      take(await ask());
      return say(trouble, "");
    } catch (error) {
      say("", trouble);
      const wait = waitAfter(error);
      if (wait === null) return;
      await new Promise((over) => setTimeout(over, wait));
    }
  }
}

/** Resolves when methods and examples are known. */
async function loadLists(): Promise<void> {
  // Without this list no product can be chosen; everything else works.
  void readList(getProducts, (products) => store.set((workspace) => ({ ...workspace, products })));
  await Promise.all([
    readList(getMethods, (methods) => store.set((workspace) => ({ ...workspace, methods })), NO_METHODS),
    readList(getExamples, (examples) => store.set((workspace) => ({ ...workspace, examples }))),
  ]);
}

store.subscribe((workspace, previous) => {
  if (workspace.test !== previous.test) rememberTest(workspace.test);
});

function fault(reason: unknown): void {
  const words = sentenceOf(reason);
  stage.prepend(
    h(
      "p",
      { class: "trouble", role: "alert" },
      `This page failed: ${words}. Reload it; the service keeps your jobs.`,
    ),
  );
}

window.addEventListener("error", (event) => fault(event.error ?? event.message));
window.addEventListener("unhandledrejection", (event) => fault(event.reason));
askForKeyWith(askInDialog);
watchPresses(document);
document.body.append(skip, header(store, shortcuts(store, announce)), stage, status);
const shownScreen = screens(store, jobFlow(store), stage, announce, loadLists());
skip.addEventListener("click", (event) => {
  event.preventDefault();
  shownScreen.focusHeading();
});
window.addEventListener("hashchange", () => shownScreen.go(false));
shownScreen.go(true);
