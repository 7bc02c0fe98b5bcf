// "Report": a job's page to print. The address has the entry, so that it is the same however the link is opened.
import { getText, sentenceOf } from "../api/client.ts";
import { currentKey } from "../api/key.ts";
import { h } from "../dom.ts";
import { download } from "../plot/export.ts";

export interface ReportLink {
  element: HTMLAnchorElement;
  /** Of this job; hidden where there is none with a result. `entry`: index of a controller; the best one without it. */
  show(id: string | null, entry?: number | null): void;
}

export function reportLink(): ReportLink {
  let address = "";
  const element = h("a", { href: "#/", target: "_blank", hidden: true }, "Report");

  /** A link carries no key: where the service asks for one, the page is fetched with it and saved. */
  async function save(): Promise<void> {
    const { text } = await getText(address);
    download(new Blob([text], { type: "text/html" }), "report.html");
  }

  element.addEventListener("click", (event) => {
    if (currentKey() === null) return;
    event.preventDefault();
    void save().catch((error: unknown) => {
      element.textContent = `Report: ${sentenceOf(error)}`;
    });
  });

  return {
    element,
    show(id, entry = null) {
      const query = entry === null ? "" : `?controller=${entry}`;
      address = `v1/jobs/${encodeURIComponent(id ?? "")}/report.html${query}`;
      element.href = address;
      element.textContent = "Report";
      element.hidden = id === null;
    },
  };
}
