// Rules: a rule of one's own, a method or settings, against the library of problems with proved bounds.
import "../style/rules.css";
import library from "virtual:problems";
import { ApiError, sentenceOf } from "../api/client.ts";
import { latest } from "../api/latest.ts";
import { scoreOf } from "../api/score.ts";
import type { ScoreAnswer } from "../api/score.ts";
import type { TuningRequest } from "../api/types.ts";
import { profileFrame, ratioFrame } from "../charts/score.ts";
import type { ProfiledRule } from "../charts/score.ts";
import { h } from "../dom.ts";
import { FormErrors, staleMark } from "../form/errors.ts";
import { plotGrid } from "../plot/grid.ts";
import { formatRoute } from "../routes.ts";
import type { RulesRoute } from "../routes.ts";
import { shown } from "../store.ts";
import type { Store } from "../store.ts";
import { copyButton } from "../views/copy.ts";
import { requestMenu } from "../views/request_menu.ts";
import type { View } from "../views/start.ts";
import { documentAddress } from "../words/documents.ts";
import { commonFault, commonStructure, headline, scoreFacts, scoreRows } from "./words.ts";
import type { ScoreRow } from "./words.ts";
import { ruleForm } from "./form.ts";
import { otherRules } from "./others.ts";
import { hasSettings, othersCard } from "./others_card.ts";
import { atLines, designRequest, FIRST_RULE, linkedTexts, readRule } from "./question.ts";
import type { RuleQuestion, RuleTexts } from "./question.ts";
import { scoreTable } from "./score_table.ts";

export interface RulesView extends View {
  open(route: RulesRoute): void;
}

export interface RulesEvents {
  /** The address that holds the whole question. */
  onQuestion(route: RulesRoute): void;
  onTune(request: TuningRequest): Promise<void>;
}

const LATE_MS = 300;

const routeOf = (texts: RuleTexts): RulesRoute => ({ screen: "rules", values: linkedTexts(texts) });

/** Methods that a rule of one's own replaces. */
const OWN = "formula";

export function rulesView(store: Store, announce: (sentence: string) => void, events: RulesEvents): RulesView {
  const errors = new FormErrors();
  let opened = "";
  let answer: ScoreAnswer | null = null;
  /** The problems of the answer, in the form in which other rules are asked. */
  let problems: RuleQuestion["request"]["problems"];
  let lateTimer: ReturnType<typeof setTimeout> | undefined;
  const heading = h("h1", { tabindex: -1 }, "Rules");
  const busy = h("span", { class: "hint busy idle", role: "status" });
  const trouble = h("p", { class: "trouble", role: "alert", hidden: true });
  const menu = requestMenu(announce);
  const form = ruleForm(errors, library, ask);
  const link = copyButton({ label: "Copy link", look: "quiet", text: () => new URL(formatRoute(routeOf(form.texts())), location.href).href }, announce);
  const purpose = h(
    "p",
    { class: "hint" },
    `How near does a rule come to the best possible? ${Object.keys(library.problems).length} problems ask for the least IAE after a load step within limits on Ms and Mt; for each a lower bound is proved. `,
    h("a", { href: documentAddress("problems", "score-a-rule"), target: "_blank" }, "Problems and score"),
  );
  const verdict = h("section", { class: "verdict", "aria-label": "Score" });
  const plots = plotGrid(announce);
  const others = otherRules(() => store.get().methods);
  const card = othersCard({ onCompute: () => void compare(), onStop: stopComparing, onChoose: showOthers });
  const table = scoreTable((row) => void design(row));
  const stale = staleMark(() => results);
  const results = h("div", { class: "rule-results", hidden: true }, stale.element, verdict, plots.element, card.element, table.element);
  const element = h("main", { class: "identify rules", id: "main" }, h("div", { class: "identify-head" }, heading, link, menu.element, busy), purpose, h("div", { class: "rules-body" }, h("div", { class: "rules-form" }, form.element, trouble), results));
  form.element.addEventListener("submit", (event) => {
    event.preventDefault();
    ask();
  });

  const calls = latest<RuleQuestion, ScoreAnswer>(
    ({ request }, signal) => scoreOf(request, signal),
    {
      onBusy(now) {
        clearTimeout(lateTimer);
        if (now) lateTimer = setTimeout(() => (busy.textContent = "Scoring..."), LATE_MS);
        else busy.textContent = "";
      },
      onAnswer: take,
      onError: (error, { lines }) => complain(error, lines),
    },
    1,
  );

  function ask(): void {
    const texts = form.texts();
    opened = formatRoute(routeOf(texts));
    events.onQuestion(routeOf(texts));
    const question = readRule(texts, form.options());
    trouble.hidden = true;
    errors.clear();
    errors.mark("", question.errors);
    if (question.errors.length === 0) return calls.send(question);
    calls.drop();
    busy.textContent = "";
    stale.set(answer !== null);
  }

  function complain(error: unknown, lines: readonly number[] = []): void {
    const listed = error instanceof ApiError ? atLines(error.problem.errors ?? [], lines) : [];
    const unplaced = errors.mark("", listed.slice(0, 3));
    trouble.textContent = listed.length > 0 ? unplaced.map(({ detail }) => detail).join(" ") : sentenceOf(error);
    trouble.hidden = trouble.textContent === "";
    stale.set(answer !== null);
  }

  function take(next: ScoreAnswer, { request }: RuleQuestion): void {
    answer = next;
    // Other rules are compared on problems of the same kind, though some could design both.
    const structure = request.problems?.structure ?? commonStructure(next, library);
    problems = { ...request.problems, ...(structure ? { structure } : {}) };
    results.hidden = false;
    stale.set(false);
    stopComparing();
    const fault = commonFault(next);
    verdict.className = `verdict ${next.kept === next.problems.length ? "good" : next.kept === 0 ? "bad" : ""}`;
    verdict.replaceChildren(
      h("h2", {}, headline(next)),
      h("dl", { class: "facts" }, scoreFacts(next).map(([label, value, aside]) => h("div", {}, h("dt", {}, label), h("dd", {}, value, aside ? h("small", {}, ` ${aside}`) : "")))),
      fault ? h("p", { class: "bad" }, `No problem has settings: ${fault}`) : "",
    );
    menu.show("v1/score", request as unknown as Record<string, unknown>);
    table.show(scoreRows(next, library), next.name);
    showOthers();
    announce(verdict.querySelector("h2")!.textContent ?? "");
  }

  function showOthers(): void {
    if (!answer) return;
    const known = others.known(problems);
    card.show(answer, known);
    const looks = card.looks();
    const rules: ProfiledRule[] = [
      { answer, name: answer.name, look: 1 },
      ...known.filter(hasSettings).map((rule) => ({ answer: rule.answer!, name: rule.title, look: looks.get(rule.method) ?? null })),
    ];
    plots.setSubject("");
    plots.show("profile", profileFrame(rules));
    plots.show("ratio", ratioFrame(answer));
  }

  async function compare(): Promise<void> {
    await others.compute(problems, (done, all) => {
      card.setProgress({ done, all });
      showOthers();
      if (done < all) return;
      card.setProgress(null);
      announce("All rules are computed.");
    });
  }

  function stopComparing(): void {
    others.stop();
    card.setProgress(null);
  }

  async function design({ score, known }: ScoreRow): Promise<void> {
    if (!known) return;
    try {
      await events.onTune(designRequest(score.name, known, score));
    } catch (error) {
      complain(error);
      trouble.scrollIntoView({ block: "nearest" });
    }
  }

  const methods = store.pick((workspace) => workspace.methods);
  const leave = shown(
    () => methods.value,
    (list) => {
      form.setMethods(list.filter(({ id }) => id !== OWN && id !== "all"));
      showOthers();
      // The options of a method are known only now.
      if (opened !== "" && form.texts()["kind"] === "method" && list.length > 0 && !answer) ask();
    },
  );

  return {
    element,
    heading,
    dispose() {
      leave();
      stopComparing();
      calls.drop();
      plots.dispose();
    },
    open({ values }) {
      const asked = Object.keys(values).length > 0 ? values : opened === "" ? FIRST_RULE : null;
      // A user who returns finds the previous content.
      if (!asked || formatRoute(routeOf(asked)) === opened) return void events.onQuestion(routeOf(form.texts()));
      form.show(asked);
      ask();
    },
  };
}
