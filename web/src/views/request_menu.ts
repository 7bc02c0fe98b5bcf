// The request for the displayed result, for programs: as JSON and as a call that can be pasted into a terminal.
import { closesItself, h } from "../dom.ts";
import { download } from "../plot/export.ts";
import { copyButton } from "./copy.ts";

export interface RequestMenu {
  element: HTMLElement;
  /** `path`: of the call, such as "v1/jobs". Null: there is no request to show. */
  show(path: string, request: unknown): void;
}

const FILE_NAME = "request.json";

/** One line for a POSIX shell; a quote inside the body is closed, escaped and opened again. */
export function curlOf(address: string, request: unknown): string {
  const body = JSON.stringify(request).replaceAll("'", `'\\''`);
  return `curl -s -H 'Content-Type: application/json' -H 'Prefer: wait=20' '${address}' -d '${body}'`;
}

export function requestMenu(announce: (sentence: string) => void): RequestMenu {
  let shown: unknown = null;
  let address = "";
  const json = (): string | null => (shown ? JSON.stringify(shown, null, 2) : null);
  const save = h("button", { type: "button", class: "quiet", onclick: saveFile }, "Download JSON");
  const copyJson = copyButton({ label: "Copy JSON", look: "quiet", text: json }, announce);
  const copyCurl = copyButton(
    { label: "Copy as curl", look: "quiet", text: () => (shown ? curlOf(address, shown) : null) },
    announce,
  );
  const menu = h(
    "details",
    { class: "menu request-menu" },
    h("summary", {}, "Request"),
    h("div", { class: "menu-items" }, copyJson, save, copyCurl),
  );

  function saveFile(): void {
    const text = json();
    if (text !== null) download(new Blob([text], { type: "application/json" }), FILE_NAME);
  }

  closesItself(menu);
  return {
    element: menu,
    show(path, request) {
      shown = request ?? null;
      // Relative to the page, like every call: a path prefix is kept.
      address = new URL(path, document.baseURI).href;
      menu.hidden = shown === null;
    },
  };
}
