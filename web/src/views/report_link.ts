// "Report" and "Change sheet": pages of a job for printing. The address contains the entry, so that it is the same
// however the link is opened.
import { getText, sentenceOf } from "../api/client.ts";
import { currentKey } from "../api/key.ts";
import { h } from "../dom.ts";
import { download } from "../plot/export.ts";

export interface ReportLink {
  element: HTMLAnchorElement;
  /** For this job; hidden if it has no result. `entry`: index of a controller; by default the best one. */
  show(id: string | null, entry?: number | null): void;
}

/** `label` and `file` of the page. */
export function reportLink(label = "Report", file = "report.html"): ReportLink {
  let address = "";
  const element = h("a", { href: "#/", target: "_blank", hidden: true }, label);

  /** A link carries no key: if the service requires one, the page is downloaded with it and saved. */
  async function save(): Promise<void> {
    const { text } = await getText(address);
    download(new Blob([text], { type: "text/html" }), file);
  }

  element.addEventListener("click", (event) => {
    if (currentKey() === null) return;
    event.preventDefault();
    void save().catch((error: unknown) => {
      element.textContent = `${label}: ${sentenceOf(error)}`;
    });
  });

  return {
    element,
    show(id, entry = null) {
      const query = entry === null ? "" : `?controller=${entry}`;
      address = `v1/jobs/${encodeURIComponent(id ?? "")}/${file}${query}`;
      element.href = address;
      element.textContent = label;
      element.hidden = id === null;
    },
  };
}
