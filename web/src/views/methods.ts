// Methods: all tuning methods of the service, each with its formula, source, range and options, from its own
// description.
import type { Method } from "../api/types.ts";
import { h, uniqueId } from "../dom.ts";
import { methodFormula } from "../form/method_formula.ts";
import { formatRoute } from "../routes.ts";
import type { Store } from "../store.ts";
import { mentions, optionRows } from "../words/methods.ts";
import type { View } from "./start.ts";

/** `id`: the one method to show; "" for all of them. */
export function methodsView(store: Store, id: string): View {
  const heading = h("h1", { tabindex: -1 }, id === "" ? "Methods" : "Method");
  const search = h("input", { type: "text", id: uniqueId("search"), autocomplete: "off", spellcheck: "false" });
  const found = h("p", { class: "hint", role: "status" });
  const list = h("div", { class: "method-list" });
  const element = h(
    "main",
    { class: "methods-page", id: "main" },
    heading,
    h(
      "div",
      { class: "method-search", hidden: id !== "" },
      h("label", { for: search.id }, "Find a method"),
      search,
      found,
    ),
    h("p", { hidden: id === "" }, h("a", { href: formatRoute({ screen: "methods", id: "" }) }, "All methods")),
    list,
  );
  let articles: { method: Method; element: HTMLElement }[] = [];

  function filter(): void {
    let count = 0;
    for (const article of articles) {
      const shown = mentions(article.method, search.value);
      article.element.hidden = !shown;
      if (shown) count += 1;
    }
    found.textContent = `${count} of ${articles.length}`;
  }

  function show(methods: Method[]): void {
    const chosen = id === "" ? methods : methods.filter((method) => method.id === id);
    articles = chosen.map((method) => ({ method, element: articleOf(method, id !== "") }));
    list.replaceChildren(...articles.map((article) => article.element));
    if (id !== "" && chosen.length === 1) heading.textContent = chosen[0]!.title;
    if (chosen.length === 0)
      list.append(
        h("p", {}, methods.length === 0 ? waiting() : `There is no method "${id}".`),
      );
    filter();
  }

  const waiting = (): string => store.get().serviceTrouble || "Asking the service for its methods...";

  search.addEventListener("input", filter);
  show(store.get().methods);
  const leave = store.subscribe((workspace, previous) => {
    const unavailable = workspace.methods.length === 0 && workspace.serviceTrouble !== previous.serviceTrouble;
    if (unavailable || workspace.methods !== previous.methods) show(workspace.methods);
  });
  return { element, heading, dispose: leave };
}

function articleOf(method: Method, alone: boolean): HTMLElement {
  const fact = (name: string, value: string | undefined): HTMLElement[] =>
    value ? [h("dt", {}, name), h("dd", {}, value)] : [];
  const options = optionRows(method.options).filter((row) => row.name !== "method");
  const table = h(
    "div",
    { class: "scroll", tabindex: 0, role: "region", "aria-label": `Options of ${method.title}` },
    h(
      "table",
      { class: "figures options-table" },
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          ["Option", "Allowed values", "Default", "Meaning"].map((name) => h("th", { scope: "col" }, name)),
        ),
      ),
      h(
        "tbody",
        {},
        options.map((row) =>
          h(
            "tr",
            {},
            h("th", { scope: "row" }, h("code", {}, row.name)),
            h("td", {}, row.values),
            h("td", {}, row.standard),
            h("td", {}, row.meaning),
          ),
        ),
      ),
    ),
  );
  const count = `${options.length} ${options.length === 1 ? "option" : "options"}`;
  const address = formatRoute({ screen: "methods", id: method.id });
  const title = alone
    ? h("code", {}, method.id)
    : h("h2", {}, h("a", { href: address }, method.title), h("code", {}, ` ${method.id}`));
  return h(
    "article",
    { class: "card method-article" },
    title,
    method.formula
      ? h(
          "div",
          { class: "method-formula", tabindex: 0, role: "region", "aria-label": `Formula of ${method.title}` },
          methodFormula(method.formula_mathml) ?? h("pre", {}, method.formula.replaceAll("; ", "\n")),
        )
      : null,
    h("dl", {}, fact("Needs", method.needs), fact("Valid", method.validity), fact("Source", method.source)),
    options.length === 0 ? null : alone ? table : h("details", {}, h("summary", {}, count), table),
  );
}
