// "Report": a job's page to print, of the entry that stands on the screen.
import { getText, sentenceOf } from "../api/client.ts";
import { currentKey } from "../api/key.ts";
import { h } from "../dom.ts";
import { download } from "../plot/export.ts";
import { parseRoute } from "../routes.ts";

export interface ReportLink {
  element: HTMLAnchorElement;
  /** Of this job; hidden where there is none with a result. */
  show(id: string | null): void;
}

export function reportLink(): ReportLink {
  let address = "";
  const element = h("a", { href: "#/", target: "_blank", hidden: true }, "Report");

  /** The entry that is chosen now; the service takes the best where none is. */
  function query(): string {
    const route = parseRoute(location.hash);
    return route.screen === "design" && route.entry !== null ? `?controller=${route.entry}` : "";
  }

  /** A link carries no key: where the service asks for one, the page is fetched with it and saved. */
  async function save(): Promise<void> {
    const { text } = await getText(address + query());
    download(new Blob([text], { type: "text/html" }), "report.html");
  }

  element.addEventListener("click", (event) => {
    element.href = address + query();
    if (currentKey() === null) return;
    event.preventDefault();
    void save().catch((error: unknown) => {
      element.textContent = `Report: ${sentenceOf(error)}`;
    });
  });

  return {
    element,
    show(id) {
      address = `v1/jobs/${encodeURIComponent(id ?? "")}/report.html`;
      element.href = address;
      element.textContent = "Report";
      element.hidden = id === null;
    },
  };
}
