// The dialog with the keys of the present screen and the documents.
import { h, openDialog } from "../dom.ts";
import { DOCUMENTS, documentAddress } from "../words/documents.ts";
import { KEY_GROUPS } from "./keys.ts";
import type { KeyGroup } from "./keys.ts";

const isVisible = (element: Element): boolean => element.getClientRects().length > 0;

const isHere = ({ on }: KeyGroup): boolean => on === "" || [...document.querySelectorAll(on)].some(isVisible);

const groupElement = ({ title, keys }: KeyGroup): HTMLElement =>
  h(
    "section",
    {},
    h("h3", {}, title),
    h("dl", { class: "keys-list" }, keys.map(({ keys: names, meaning }) => h("div", {}, h("dt", {}, names), h("dd", {}, meaning)))),
  );

export function openHelp(): void {
  openDialog(
    "Keys and documents",
    "help",
    h("div", { class: "modal-body", tabindex: 0, role: "region", "aria-label": "Keys and documents" }, [
      h("div", { class: "key-groups" }, KEY_GROUPS.filter(isHere).map(groupElement)),
      h("h3", {}, "Documents"),
      h(
        "ul",
        { class: "document-list" },
        h("li", {}, h("a", { href: "#/docs" }, "API, call by call")),
        DOCUMENTS.map(({ id, title }) => h("li", {}, h("a", { href: documentAddress(id) }, title))),
      ),
    ]),
  );
}
