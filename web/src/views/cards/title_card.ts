// The subject of a job: its name, its plant, and links to the next steps. Head of every screen that shows a job.
import { isRangeRequest } from "../../api/range.ts";
import { nameOf } from "../../api/types.ts";
import type { Job, Plant, TuningRequest } from "../../api/types.ts";
import { h } from "../../dom.ts";
import type { Child } from "../../dom.ts";
import { plantFormula } from "../../form/formula.ts";
import { formatRoute } from "../../routes.ts";
import { unitNames } from "../../words/numbers.ts";
import { plantTitle, plantWords } from "../../words/plant.ts";
import { rangeWords } from "../../words/range.ts";
import { linkMenu } from "../link_menu.ts";
import { reportLink } from "../report_link.ts";
import { requestMenu } from "../request_menu.ts";
import { isOfUltimate } from "./ultimate_card.ts";

export interface TitleCard {
  element: HTMLElement;
  heading: HTMLElement;
  /** `entry`: the controller on the screen, if there is one; report and change sheet are about it. */
  show(job: Job | null, entry?: number | null): void;
  /** The request that leads to the displayed result; `own`: it is the job's own, for which there is a report. */
  setShown(shown: { request: unknown }, own: boolean): void;
}

/** `screen`: the heading of a job without a name. `actions`: in addition to the links that every job has. */
export function titleCard(screen: string, announce: (sentence: string) => void, ...actions: Child[]): TitleCard {
  const menu = requestMenu(announce);
  const link = linkMenu(announce);
  const heading = h("h1", { tabindex: -1 }, screen);
  const plantLine = h("p", { class: "hint" });
  const formula = h("div");
  const editLink = h("a", { href: "#/" }, "Change the request");
  const recordLink = h("a", { href: "#/" }, "Look at the record");
  const report = reportLink();
  const sheet = reportLink("Change sheet", "change-sheet.html");
  const ofKept = h(
    "span",
    { class: "hint", hidden: true, title: "They are pages of a kept design: press Keep next to the sliders." },
    "Report, change sheet: keep the design first",
  );
  const element = h(
    "section",
    { class: "card title" },
    heading,
    plantLine,
    formula,
    h("p", { class: "actions" }, editLink, recordLink, report.element, sheet.element, ofKept, actions, link.element, menu.element),
  );
  let about: Job | null = null;
  let chosen: number | null = null;

  /** `own`: the displayed result is the job's. An operating range and today's settings have no change sheet. */
  function showPages(own: boolean): void {
    const id = own && about?.result ? about.id : null;
    const entries = about?.result?.controllers ?? [];
    const shown = chosen === null ? entries : entries.filter((_, index) => index === chosen);
    const hasChange = shown.some((entry) => entry.controller && entry.method !== "baseline");
    ofKept.hidden = own || !about?.result;
    const date = about?.finished_at ?? null;
    report.show(id, date, chosen);
    sheet.show(hasChange ? id : null, date, chosen);
  }

  return {
    element,
    heading,
    show(job, entry = null) {
      element.hidden = !job;
      if (!job) return;
      const request = job.request;
      const plant = job.result?.model?.plant ?? request?.plant;
      heading.textContent = nameOf(job) || screen;
      const range = isRangeRequest(request) ? request : null;
      plantLine.textContent = range
        ? rangeWords(range)
        : plant
          ? [...new Set([plantTitle(plant.type), plantWords(plant, unitNames(request?.units))])].join(": ")
          : isOfUltimate(request)
            ? "from Ku and Pu"
            : "from a recorded test";
      const shown = plant && !job.result?.model && hasFormulaOnly(plant) ? [plantFormula(plant, "div", true)] : [];
      formula.replaceChildren(...shown);
      formula.hidden = shown.length === 0;
      editLink.href = formatRoute({ screen: "edit", job: job.id });
      recordLink.href = formatRoute({ screen: "identify", job: job.id });
      recordLink.hidden = !request?.record;
      about = job;
      chosen = entry;
      menu.show("v1/jobs", request);
      link.show(job, request);
      showPages(true);
    },
    setShown({ request }, own) {
      menu.show("v1/jobs", request);
      if (about) link.show(about, request as TuningRequest);
      showPages(own);
    },
  };
}

/** Plants whose formula contains more than their description in words. */
const hasFormulaOnly = (plant: Plant): boolean => ["transfer_function", "zpk", "state_space"].includes(plant.type);
