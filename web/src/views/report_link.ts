// "Report" and "Change sheet": pages of a job or a batch for printing. The address contains the entry and the reader's
// time, so that it is the same however the link is opened.
import { getText, sentenceOf } from "../api/client.ts";
import { currentKey } from "../api/key.ts";
import { h } from "../dom.ts";
import { download } from "../plot/export.ts";

export interface ReportLink {
  element: HTMLAnchorElement;
  /** For this job or batch; hidden if it is null. `date`: the one on the page. `entry`: index of a controller; by
      default the best one. */
  show(id: string | null, date?: string | null, entry?: number | null): void;
}

/** The reader's time at that date, minutes ahead of UTC. */
export const utcOffset = (date: string | null | undefined): number => {
  const offset = -new Date(date ?? Date.now()).getTimezoneOffset();
  return Number.isFinite(offset) ? Math.round(offset) : 0;
};

/** `label` and `file` of the page. */
export function reportLink(label = "Report", file = "report.html", of: "jobs" | "batches" = "jobs"): ReportLink {
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
    show(id, date = null, entry = null) {
      const controller = entry === null ? "" : `controller=${entry}&`;
      address = `v1/${of}/${encodeURIComponent(id ?? "")}/${file}?${controller}utc_offset=${utcOffset(date)}`;
      element.href = address;
      element.textContent = label;
      element.hidden = id === null;
    },
  };
}
