// The head of every screen: links to the screens, and the colour theme.
import { h } from "./dom.ts";
import { addressOfJob, formatRoute, showsJob } from "./routes.ts";
import type { Route } from "./routes.ts";
import { shown } from "./store.ts";
import type { Store } from "./store.ts";
import { themeButton } from "./theme.ts";

/** Marks the current screen, and links to the screens of the last job. `tools`: the buttons of help and search. */
export function header(store: Store, tools: HTMLElement[]): HTMLElement {
  const links = {
    start: h("a", { href: "#/" }, "Start"),
    identify: h("a", { href: "#/identify" }, "Identify"),
    relay: h("a", { href: "#/relay" }, "Relay test"),
    range: h("a", { href: "#/range" }, "Range"),
    structure: h("a", { href: "#/structure" }, "Structure"),
    check: h("a", { href: "#/check" }, "Check"),
    rules: h("a", { href: "#/rules" }, "Rules"),
    design: h("a", { href: "#/", hidden: true }, "Design"),
    compare: h("a", { href: "#/", hidden: true }, "Compare"),
    jobs: h("a", { href: "#/jobs" }, "Jobs"),
    methods: h("a", { href: "#/methods" }, "Methods"),
    docs: h("a", { href: "#/docs" }, "API"),
  };
  /** With the last positions of its sliders. */
  let design: Extract<Route, { screen: "design" }> | null = null;
  const nav = h("nav", { "aria-label": "Screens" }, Object.values(links));
  const route = store.pick((workspace) => workspace.route);
  shown(() => route.value, mark);

  /** On a phone the row is wider than the screen; only the row scrolls. */
  function reveal(link: HTMLElement): void {
    const row = nav.getBoundingClientRect();
    const { left, right } = link.getBoundingClientRect();
    nav.scrollLeft += Math.min(0, left - row.left) + Math.max(0, right - row.right);
  }

  function mark(current: Route): void {
    for (const [screen, link] of Object.entries(links)) {
      const here =
        current.screen === screen ||
        (screen === "jobs" && current.screen === "batch") ||
        (screen === "start" && current.screen !== "batch" && !(current.screen in links));
      if (here) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
      if (here) requestAnimationFrame(() => reveal(link));
    }
    if (current.screen === "design") design = current;
    if (!showsJob(current)) return;
    links.design.href = design?.job === current.job ? formatRoute(design) : addressOfJob(current.job, "design");
    links.compare.href = addressOfJob(current.job, "compare");
    for (const screen of ["design", "compare"] as const) links[screen].hidden = false;
  }

  return h(
    "header",
    { class: "top" },
    h("a", { class: "brand", href: "#/" }, "Tunewright"),
    nav,
    h("div", { class: "tools" }, tools, themeButton()),
  );
}
