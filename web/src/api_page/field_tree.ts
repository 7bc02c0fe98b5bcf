// The fields of a request or an answer as a tree. A branch is made when it is unfolded: the whole would be endless.
import { h } from "../dom.ts";
import { asText, fieldsOf, resolved, typeWords } from "./openapi.ts";
import type { ApiDocument, ApiField, ApiSchema } from "./openapi.ts";

/** Null: there are no fields. */
export function fieldTree(document: ApiDocument, schema: ApiSchema): HTMLElement | null {
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
