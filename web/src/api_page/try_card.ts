// The form of a call: its parameters, its request as text, and the answer of the service.
import { answerOf, sentenceOf } from "../api/client.ts";
import { h, uniqueId } from "../dom.ts";
import { copyButton } from "../views/copy.ts";
import { curlText } from "../views/request_menu.ts";
import type { CarriedRequest } from "../current_record.ts";
import { asText, examplesOf } from "./openapi.ts";
import type { ApiDocument, ApiParameter, Call, NamedExample } from "./openapi.ts";

/** Longer answers are cut on the page; the call itself is not. */
const MAX_SHOWN = 200_000;

interface ParameterField {
  parameter: ApiParameter;
  element: HTMLElement;
  value(): string;
}

function parameterField(parameter: ApiParameter): ParameterField {
  const { name, required, description, schema } = parameter;
  const id = uniqueId("parameter");
  const about = h("p", { class: "hint", id: `${id}-about` }, description ?? "");
  const attributes = { id, "aria-describedby": about.id };
  const input = schema?.enum
    ? h("select", attributes, ["", ...schema.enum.map(asText)].map((text) => h("option", {}, text)))
    : h("input", { type: "text", autocomplete: "off", spellcheck: "false", ...attributes });
  const label = h("label", { for: id }, `${name} (${parameter.in}${required ? ", required" : ""})`);
  return { parameter, element: h("div", { class: "field" }, label, input, about), value: () => input.value.trim() };
}

/** `carried`: the request of the screen from which the reader came, if it is for this call. */
export function tryCard(document: ApiDocument, call: Call, carried: CarriedRequest | null, announce: (sentence: string) => void): HTMLElement {
  const title = h("h3", { id: uniqueId("try") }, "Try it");
  const fields = call.parameters.map(parameterField);
  const types = Object.keys(call.body);
  const hasBody = types.length > 0;
  let examples: NamedExample[] = [];
  const media = h("select", { id: uniqueId("media"), onchange: () => listExamples() }, types.map((type) => h("option", {}, type)));
  const choice = h("select", { id: uniqueId("example"), onchange: () => fill() });
  const body = h("textarea", { id: uniqueId("body"), rows: 14, spellcheck: "false" });
  const state = h("p", { role: "status", class: "answer-state" });
  const answer = h("pre", { class: "code", tabindex: 0, role: "region", "aria-label": "Answer", hidden: true });
  const send = h("button", { type: "submit", class: "primary" }, "Send");

  function listExamples(): void {
    const given = examplesOf(document, call.body[media.value]!);
    const own = carried && media.value === "application/json" ? [{ name: "The request of the page", text: asText(carried.request) }] : [];
    examples = [...own, ...given];
    choice.replaceChildren(...examples.map(({ name }) => h("option", {}, name)));
    fill();
  }

  function fill(): void {
    body.value = examples[choice.selectedIndex]?.text ?? "";
  }

  /** The address with its parameters; relative to the page. */
  function addressNow(): string {
    const query = new URLSearchParams();
    let path = call.path.slice(1);
    for (const { parameter, value } of fields) {
      if (parameter.in === "path") path = path.replace(`{${parameter.name}}`, encodeURIComponent(value()));
      if (parameter.in === "query" && value() !== "") query.set(parameter.name, value());
    }
    const text = query.toString();
    return text === "" ? path : `${path}?${text}`;
  }

  function headersNow(): Record<string, string> {
    const given = fields.filter(({ parameter, value }) => parameter.in === "header" && value() !== "");
    return {
      Accept: "*/*",
      ...(hasBody ? { "Content-Type": media.value } : {}),
      ...Object.fromEntries(given.map(({ parameter, value }) => [parameter.name, value()])),
    };
  }

  function missing(): string {
    const empty = fields.find(({ parameter, value }) => parameter.in === "path" && value() === "");
    return empty ? `${empty.parameter.name} is empty; it is a part of the address.` : "";
  }

  async function ask(): Promise<void> {
    const lacks = missing();
    if (lacks) return void (state.textContent = lacks);
    send.disabled = true;
    state.textContent = "Sent; waiting for the answer.";
    const begun = performance.now();
    try {
      const { response, text } = await answerOf(call.method, addressNow(), hasBody ? new Blob([body.value]) : undefined, headersNow());
      const kind = response.headers.get("Content-Type")?.split(";")[0] ?? "";
      state.textContent = [`${response.status} ${response.statusText}`.trim(), kind, `${Math.round(performance.now() - begun)} ms`].filter(Boolean).join(", ");
      const whole = pretty(text, kind);
      answer.textContent = whole.length > MAX_SHOWN ? `${whole.slice(0, MAX_SHOWN)}\n(${whole.length} characters; the first ${MAX_SHOWN} are shown)` : whole;
      answer.hidden = whole === "";
    } catch (error) {
      state.textContent = sentenceOf(error);
    } finally {
      send.disabled = false;
    }
  }

  const labelled = (text: string, input: HTMLElement): HTMLElement => h("div", { class: "field" }, h("label", { for: input.id }, text), input);
  const curl = (): string =>
    curlText(call.method, new URL(addressNow(), window.document.baseURI).href, headersNow(), hasBody ? body.value : null);
  const form = h(
    "form",
    { class: "try-form", "aria-labelledby": title.id, novalidate: true },
    fields.length > 0 ? h("div", { class: "call-parameters" }, fields.map(({ element }) => element)) : "",
    hasBody ? h("div", { class: "call-parameters" }, types.length > 1 ? labelled("Media type", media) : "", labelled("Begin with", choice)) : "",
    hasBody ? labelled("Request", body) : "",
    h("div", { class: "actions" }, send, copyButton({ label: "Copy as curl", look: "quiet", text: curl }, announce)),
    state,
    answer,
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void ask();
  });
  if (hasBody) listExamples();
  return h("section", { class: "card", "aria-labelledby": title.id }, title, form);
}

function pretty(text: string, kind: string): string {
  if (!kind.endsWith("json")) return text;
  try {
    return JSON.stringify(JSON.parse(text), null, 2);
  } catch {
    return text;
  }
}
