// The request for the displayed result, for programs: as JSON and as a call that can be pasted into a terminal.
import { carry } from "../current_record.ts";
import { closesItself, h } from "../dom.ts";
import { download } from "../plot/export.ts";
import { formatRoute } from "../routes.ts";
import { copyButton } from "./copy.ts";

export interface RequestMenu {
  element: HTMLElement;
  /** `path`: of the call, such as "v1/jobs". Null: there is no request to show. */
  show(path: string, request: unknown): void;
}

const FILE_NAME = "request.json";

/** For a POSIX shell: a quote inside is closed, escaped and opened again. */
const quoted = (text: string): string => `'${text.replaceAll("'", `'\\''`)}'`;

/** A call for a terminal. `body`: null if it has none. */
export function curlText(method: string, address: string, headers: Record<string, string>, body: string | null): string {
  const verb = method === (body === null ? "GET" : "POST") ? [] : ["-X", method];
  const heads = Object.entries(headers).flatMap(([name, value]) => ["-H", quoted(`${name}: ${value}`)]);
  return ["curl", "-s", ...verb, ...heads, quoted(address), ...(body === null ? [] : ["-d", quoted(body)])].join(" ");
}

/** One line. */
export const curlOf = (address: string, request: unknown): string =>
  curlText("POST", address, { "Content-Type": "application/json", Prefer: "wait=20" }, JSON.stringify(request));

export function requestMenu(announce: (sentence: string) => void): RequestMenu {
  let shown: unknown = null;
  let shownPath = "";
  let address = "";
  const json = (): string | null => (shown ? JSON.stringify(shown, null, 2) : null);
  const save = h("button", { type: "button", class: "quiet", onclick: saveFile }, "Download JSON");
  const copyJson = copyButton({ label: "Copy JSON", look: "quiet", text: json }, announce);
  const copyCurl = copyButton(
    { label: "Copy as curl", look: "quiet", text: () => (shown ? curlOf(address, shown) : null) },
    announce,
  );
  const tryIt = h("button", { type: "button", class: "quiet", onclick: showInApi }, "Try on the API page");
  const menu = h(
    "details",
    { class: "menu request-menu" },
    h("summary", {}, "Request"),
    h("div", { class: "menu-items" }, copyJson, save, copyCurl, tryIt),
  );

  function saveFile(): void {
    const text = json();
    if (text !== null) download(new Blob([text], { type: "application/json" }), FILE_NAME);
  }

  function showInApi(): void {
    carry({ path: shownPath, request: shown });
    location.hash = formatRoute({ screen: "docs", call: "" });
  }

  closesItself(menu);
  return {
    element: menu,
    show(path, request) {
      shown = request ?? null;
      shownPath = path;
      // Relative to the page, like every call: a path prefix is kept.
      address = new URL(path, document.baseURI).href;
      menu.hidden = shown === null;
    },
  };
}
