// The service's rules beside the scored one: computed on demand, a table of their figures, a choice of those that are
// named in the profile.
import type { ScoreAnswer } from "../api/score.ts";
import { h } from "../dom.ts";
import type { Look } from "../plot/frame.ts";
import { swatch } from "../plot/marks.ts";
import { DASH, formatNumber } from "../words/numbers.ts";
import { formatRoute } from "../routes.ts";
import type { OtherRule } from "./others.ts";

export interface OthersCard {
  element: HTMLElement;
  /** `own`: the scored rule. */
  show(own: ScoreAnswer, others: readonly OtherRule[]): void;
  /** Null: nothing is being computed. */
  setProgress(progress: { done: number; all: number } | null): void;
  /** The rules that are named in the profile, by their methods. */
  looks(): ReadonlyMap<string, Look>;
}

export interface OthersEvents {
  onCompute(): void;
  onStop(): void;
  onChoose(): void;
}

const LOOKS: readonly Look[] = [2, 3, 4];

export const hasSettings = ({ answer }: OtherRule): boolean => answer !== undefined && answer.no_settings < answer.problems.length;

/** The rule whose limits hold more often comes first, then the one with the lower median. */
export const byScore = (a: OtherRule, b: OtherRule): number =>
  (b.answer?.kept ?? -1) - (a.answer?.kept ?? -1) || (a.answer?.median_ratio ?? Infinity) - (b.answer?.median_ratio ?? Infinity);

export function othersCard(events: OthersEvents): OthersCard {
  /** Chosen by the reader; null: the first ones. */
  let chosen: string[] | null = null;
  let ranked: OtherRule[] = [];
  const compute = h("button", { type: "button", onclick: events.onCompute }, "Compare with all rules");
  const stop = h("button", { type: "button", class: "quiet", hidden: true, onclick: events.onStop }, "Stop");
  const bar = h("progress", { hidden: true, "aria-label": "Rules computed" });
  const status = h("span", { class: "hint", role: "status" });
  const note = h("p", { class: "hint", hidden: true });
  const body = h("tbody", {});
  const table = h(
    "div",
    { class: "scroll", tabindex: 0, role: "region", "aria-label": "All rules", hidden: true },
    h(
      "table",
      { class: "figures others-table" },
      h("caption", { class: "visually-hidden" }, "The service's rules on the same problems"),
      h("thead", {}, h("tr", {}, ["Rule", "hold", "broken", "unstable", "none", "median ratio", "worst ratio"].map((label) => h("th", { scope: "col" }, label)))),
      body,
    ),
  );
  const element = h("section", { class: "card others", "aria-label": "All rules" }, h("div", { class: "card-head" }, h("h2", {}, "Beside the service's rules"), h("div", { class: "actions" }, status, bar, stop, compute)), note, table);

  const named = (): string[] => chosen ?? ranked.slice(0, LOOKS.length).map(({ method }) => method);
  const looks = (): ReadonlyMap<string, Look> => new Map(named().map((method, index) => [method, LOOKS[index]!]));

  function toggle(method: string, on: boolean): void {
    chosen = on ? [...named(), method].slice(-LOOKS.length) : named().filter((other) => other !== method);
    events.onChoose();
  }

  function rowOf(name: string | HTMLElement, answer: ScoreAnswer, first: HTMLElement | null, look: Look | null): HTMLElement {
    const { kept, limits_broken, unstable, no_settings, median_ratio, worst_ratio } = answer;
    const line = h("span", { class: "line" }, look ? swatch(look) : null);
    const figures = [kept, limits_broken, unstable, no_settings].map(String);
    return h("tr", {}, h("th", { scope: "row" }, h("span", { class: "rule-name" }, first, name, line)), [...figures, formatNumber(median_ratio), formatNumber(worst_ratio)].map((text) => h("td", {}, text || DASH)));
  }

  return {
    element,
    looks,
    setProgress(progress) {
      compute.hidden = progress !== null;
      stop.hidden = bar.hidden = progress === null;
      if (!progress) return void (status.textContent = "");
      bar.max = progress.all;
      bar.value = progress.done;
      status.textContent = `${progress.done} of ${progress.all}`;
    },
    show(own, others) {
      ranked = others.filter(hasSettings).sort(byScore);
      const [computed, refused] = [others.filter(({ answer, fault }) => answer || fault !== undefined), others.filter(({ fault }) => fault !== undefined)];
      const none = computed.length - refused.length - ranked.length;
      const focused = document.activeElement?.id;
      table.hidden = ranked.length === 0;
      const current = looks();
      body.replaceChildren(
        rowOf(h("strong", {}, own.name), own, null, 1),
        ...ranked.map(({ method, title, answer }) => {
          const look = current.get(method) ?? null;
          const box = h("input", { type: "checkbox", id: `rule-${method}`, checked: look !== null, "aria-label": `Name ${title} in the profile` });
          box.addEventListener("change", () => toggle(method, box.checked));
          return rowOf(h("a", { href: formatRoute({ screen: "methods", id: method }) }, title), answer!, box, look);
        }),
      );
      if (focused?.startsWith("rule-")) document.getElementById(focused)?.focus({ preventScroll: true });
      const sentences = [
        none > 0 ? `${none} ${none === 1 ? "rule has" : "rules have"} no settings for these problems.` : "",
        ...refused.map(({ title, fault }) => `${title}: ${fault}`),
      ].filter(Boolean);
      note.textContent = sentences.join(" ");
      note.hidden = sentences.length === 0;
      compute.disabled = computed.length === others.length && refused.length === 0;
      compute.textContent = computed.length === others.length ? "All rules are shown" : `Compare with ${others.length} rules`;
    },
  };
}
