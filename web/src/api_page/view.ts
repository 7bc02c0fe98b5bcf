// The API as a page: the list of calls, and the chosen one with its form, its request and its answers.
import { call as callService, sentenceOf } from "../api/client.ts";
import { h, uniqueId } from "../dom.ts";
import { formatRoute } from "../routes.ts";
import type { View } from "../views/start.ts";
import { documentAddress } from "../words/documents.ts";
import { carriedRequest } from "../current_record.ts";
import { asText, callsOf, fieldsOf, resolved, typeWords } from "./openapi.ts";
import type { ApiDocument, ApiField, ApiSchema, Call } from "./openapi.ts";
import { tryCard } from "./try_card.ts";

const FIRST_CALL = "createJob";

/** A path may be broken after a slash. */
const broken = (path: string): (string | HTMLElement)[] => path.split(/(?<=\/)/).flatMap((part, index) => (index === 0 ? [part] : [h("wbr", {}), part]));

const paragraphs = (text: string): HTMLElement[] => text.split(/\n{2,}/).filter(Boolean).map((part) => h("p", {}, part));

/** `id`: of the call to show; "": that of the carried request, or the one with which most begin. */
export function apiView(id: string, announce: (sentence: string) => void): View {
  const heading = h("h1", { tabindex: -1 }, "API");
  const intro = h("p", { class: "hint" }, "Every call, with a form that sends it. ", h("a", { href: documentAddress("api") }, "What a request may say"), " · ", h("a", { href: "openapi.json" }, "The description as JSON"));
  const list = h("nav", { class: "calls", "aria-label": "Calls" });
  const shown = h("div", { class: "call" }, h("p", { role: "status" }, "Reading the description…"));
  const element = h("main", { class: "api-page", id: "main" }, heading, intro, h("div", { class: "api-body" }, list, shown));

  function listCalls(document: ApiDocument, calls: Call[], chosen: Call | undefined): void {
    const groups = (document.tags ?? []).map(({ name, description }) => ({ name, description, calls: calls.filter(({ tag }) => tag === name) }));
    list.replaceChildren(
      ...groups.map((group) =>
        h(
          "details",
          { open: group.calls.includes(chosen!) },
          h("summary", { title: group.description }, group.name),
          h(
            "ul",
            {},
            group.calls.map((item) =>
              h(
                "li",
                {},
                h(
                  "a",
                  { href: formatRoute({ screen: "docs", call: item.id }), title: item.summary, "aria-current": item === chosen ? "true" : null },
                  h("span", { class: "verb" }, item.method),
                  " ",
                  broken(item.path),
                ),
              ),
            ),
          ),
        ),
      ),
    );
  }

  function answerElement(document: ApiDocument, { status, description, content }: Call["answers"][number]): HTMLElement {
    const kinds = Object.entries(content);
    const about = [
      h("p", {}, description),
      ...kinds.map(([kind, { schema }]) => {
        const tree = schema ? fieldTree(document, schema) : null;
        return h("div", {}, h("p", { class: "hint" }, kind), tree);
      }),
    ];
    return h("details", {}, h("summary", {}, `${status} `, h("span", { class: "hint" }, description.split(/(?<=\.)\s/)[0] ?? "")), about);
  }

  function showCall(document: ApiDocument, chosen: Call): void {
    const carried = carriedRequest();
    const mine = carried && chosen.method === "POST" && `/${carried.path}` === chosen.path ? carried : null;
    const requestTitle = h("h3", { id: uniqueId("request") }, "Request, field by field");
    const answersTitle = h("h3", { id: uniqueId("answers") }, "Answers");
    const bodies = Object.entries(chosen.body).flatMap(([kind, { schema }]) => {
      const tree = schema ? fieldTree(document, schema) : null;
      return tree ? [h("p", { class: "hint" }, kind), tree] : [];
    });
    shown.replaceChildren(
      h(
        "section",
        { class: "card" },
        h("h2", {}, h("span", { class: "verb" }, chosen.method), " ", broken(chosen.path)),
        h("p", {}, chosen.summary),
        paragraphs(chosen.description),
      ),
      tryCard(document, chosen, mine, announce),
      bodies.length > 0 ? h("section", { class: "card", "aria-labelledby": requestTitle.id }, requestTitle, bodies) : "",
      h("section", { class: "card", "aria-labelledby": answersTitle.id }, answersTitle, chosen.answers.map((answer) => answerElement(document, answer))),
    );
  }

  async function read(): Promise<void> {
    try {
      const document = (await callService("GET", "openapi.json")).data as ApiDocument;
      const calls = callsOf(document);
      const path = carriedRequest()?.path;
      const first = calls.find(({ method, path: at }) => method === "POST" && at === `/${path}`)?.id ?? FIRST_CALL;
      const wanted = id === "" ? first : id;
      const chosen = calls.find((item) => item.id === wanted);
      listCalls(document, calls, chosen);
      if (chosen) showCall(document, chosen);
      else shown.replaceChildren(h("p", { class: "trouble", role: "status" }, `There is no call "${wanted}".`));
    } catch (error) {
      shown.replaceChildren(h("p", { class: "trouble", role: "status" }, sentenceOf(error)));
    }
  }

  void read();
  return { element, heading, dispose: () => undefined };
}

// The fields of a request or an answer as a tree. A branch is made when it is unfolded: the whole would be endless.

/** Null: there are no fields. */
function fieldTree(document: ApiDocument, schema: ApiSchema): HTMLElement | null {
  const fields = fieldsOf(document, schema);
  return fields.length === 0 ? null : h("ul", { class: "fields-tree" }, fields.map((field) => h("li", {}, fieldElement(document, field))));
}

function fieldElement(document: ApiDocument, { name, schema, required }: ApiField): HTMLElement {
  const { description, default: usual } = resolved(document, schema);
  const line = [
    h("code", {}, name),
    h("span", { class: "type" }, ` ${typeWords(document, schema)}`),
    required ? h("strong", {}, " required") : "",
  ];
  const about = [
    description ? h("p", {}, description) : "",
    usual === undefined ? "" : h("p", { class: "hint" }, `Default: ${asText(usual)}`),
  ];
  if (fieldsOf(document, schema).length === 0) return h("div", {}, h("p", {}, line), about);
  const fold = h("details", {}, h("summary", {}, line), about);
  fold.addEventListener("toggle", () => fold.append(fieldTree(document, schema)!), { once: true });
  return fold;
}
