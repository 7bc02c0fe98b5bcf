// The screen Check: records of loops in operation in, the work list of the plant out, and a page for each loop.
import { getCheck, isCheckRequest } from "../api/check.ts";
import { sentenceOf } from "../api/client.ts";
import { newest } from "../api/latest.ts";
import type { CheckContent, IdentifyRequest } from "../api/types.ts";
import { h, passFocus } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { fileNameOf } from "../plot/export.ts";
import { addressOfCheck, formatRoute, sameCheck, WHOLE_LIST } from "../routes.ts";
import type { CheckedBy, CheckRoute } from "../routes.ts";
import { reportLink } from "../views/report_link.ts";
import { requestMenu } from "../views/request_menu.ts";
import type { View } from "../views/start.ts";
import { unitNames } from "../words/numbers.ts";
import { counted } from "../words/range.ts";
import { workRows } from "./columns.ts";
import type { WorkRow } from "./columns.ts";
import { beforeChoice, earlierChecks, lastChecks } from "./earlier.ts";
import { checkForm } from "./form.ts";
import type { LoopShown } from "./loop_cards.ts";
import { loopView } from "./loop_view.ts";
import { checkProgress } from "./progress_bar.ts";
import { recordOf } from "./request.ts";
import { checkSource, sendOrder } from "./source.ts";
import type { CheckSource, CheckState, WholeLoop } from "./source.ts";
import { workList } from "./work_list.ts";

export interface CheckView extends View {
  open(route: CheckRoute): void;
}

export interface CheckEvents {
  /** Sorted or filtered: for the address. */
  onList(route: CheckRoute): void;
  /** Shows a record on Identify. */
  onIdentify(test: IdentifyRequest): void;
  /** Tunes from a record, with the methods of Start. */
  onTune(test: IdentifyRequest): Promise<void>;
}

const TITLE = "Check loops in operation";
const EMPTY: CheckRoute = { screen: "check", of: null, from: null, before: null, loop: null, other: null, list: WHOLE_LIST };

/** How many loops there are, and which are missing. */
function aboutWords({ partial, failed }: CheckContent, size: string): string {
  const stopped = failed ? `The check was stopped early: ${counted(failed, "loop")} not checked.` : "The check was stopped early: loops that it did not reach have no result.";
  const missing = failed ? `${counted(failed, "record")} of the batch could not be checked.` : "";
  const rest = partial ? stopped : missing;
  return size && rest ? `${size}. ${rest}` : size + rest;
}

export function checkView(announce: (sentence: string) => void, events: CheckEvents): CheckView {
  const errors = new FormErrors();
  let route = EMPTY;
  let source: CheckSource | null = null;
  let state: CheckState | null = null;
  let followed: CheckedBy | null = null;
  /** The job whose loops fill the form. */
  let filledFrom: string | null = null;
  const heading = h("h1", { tabindex: -1 }, TITLE);
  const about = h("p", { class: "hint" });
  const trouble = h("p", { class: "trouble", role: "alert", hidden: true });
  const again = h("a", { href: "#/check" }, "Change and check again");
  const fresh = h("a", { href: "#/check" }, "New check");
  const save = h("button", { type: "button", class: "quiet", onclick: () => list.save(fileNameOf({ subject: state?.name ?? "", fileName: "work-list" })) }, "Work list as CSV");
  const menu = requestMenu(announce);
  const report = reportLink();
  const tools = h("p", { class: "actions check-tools" }, again, fresh, report.element, save);
  const form = checkForm(errors, { onCheck: () => void send(), onExample: () => void tryExample() });
  const progress = checkProgress(announce, async () => source?.cancel().catch(complain));
  const before = beforeChoice(async (batch) => {
    route = { ...route, before: batch };
    events.onList(route);
    await source?.compare(batch);
  });
  const list = workList(
    announce,
    (view) => {
      route = { ...route, list: view };
      events.onList(route);
    },
    before.element,
  );
  const loop = loopView(announce, (other) => {
    route = { ...route, other };
    events.onList(route);
    void drawWith(other);
  });
  const beginWith = newest();
  const earlier = earlierChecks();
  const entry = h("div", { class: "check-entry" }, errors.summary, form.element, earlier.element);
  const parts = [entry, progress.element, list.element, loop.element];
  const element = h(
    "main",
    { class: "identify check-screen", id: "main" },
    h("div", { class: "identify-head" }, heading, about, menu.element, tools),
    trouble,
    parts,
  );

  const content = (): CheckContent | null => state?.content ?? null;
  const addressOf = (place: number): string => formatRoute({ ...route, loop: place, other: null });

  async function send(): Promise<void> {
    errors.clear();
    form.setBusy(true);
    announce("Sending the records.");
    try {
      const { order, errors: faults } = await form.read();
      if (faults.length > 0) return errors.show(faults);
      const by = await sendOrder(order);
      if (by.kind === "job") filledFrom = by.id;
      location.hash = addressOfCheck(by.id, by.kind);
    } catch (error) {
      errors.fail(error);
    } finally {
      form.setBusy(false);
    }
  }

  async function tryExample(): Promise<void> {
    form.setBusy(true);
    const { examplePlant } = await import("./example.ts");
    form.load(examplePlant());
    await send();
  }

  function complain(error: unknown): void {
    say(sentenceOf(error));
  }

  function say(sentence: string): void {
    trouble.textContent = sentence;
    trouble.hidden = sentence === "";
  }

  function take(next: CheckState): void {
    const known = content();
    state = next;
    const found = content();
    if (found && found !== known) {
      list.show(found, unitNames(found.units), addressOf);
      list.setView(route.list);
      void offerBefore(found);
    }
    if (!known) menu.show("v1/jobs", next.request);
    show();
    if (found && !known) announce(`${counted(found.loops.length, "loop")} checked. ${list.sentence()}`);
  }

  /** Only batches are compared. */
  async function offerBefore(found: CheckContent): Promise<void> {
    const { of } = route;
    const checks = of?.kind === "batch" ? await lastChecks() : [];
    if (content() !== found) return;
    before.offer(checks.filter((check) => check.of.kind === "batch" && !sameCheck(check.of, of)), route.before, found.since ?? "");
  }

  function follow(of: CheckedBy): void {
    source?.stop();
    followed = of;
    state = null;
    menu.show("", null);
    source = checkSource(of, {
      onState: take,
      onTrouble(sentence) {
        say(sentence);
        if (state === null) show();
      },
    });
  }

  /** The part of the screen for the address and the state of the check. */
  function partShown(): HTMLElement | null {
    if (route.of === null) return entry;
    if (content()) return route.loop === null ? list.element : loop.element;
    // Nothing is known of a check that cannot be read.
    if (state === null) return trouble.hidden ? progress.element : null;
    return state.ended ? null : progress.element;
  }

  function show(): void {
    const part = partShown();
    for (const one of parts.filter((other) => other !== part)) passFocus(one, heading);
    for (const one of parts) one.hidden = one !== part;
    const found = content();
    const row = part === loop.element && found ? workRows(found).find(({ place }) => place === route.loop) : undefined;
    if (found && row) showLoop(found, row);
    else loop.leave();
    if (part === progress.element && state) progress.show(state);
    if (part === loop.element && !row) {
      loop.element.hidden = true;
      say("This check has no such loop.");
    }
    if (state?.failure) say(state.failure);
    showHead(row?.loop.tag ?? "");
  }

  function showLoop(found: CheckContent, row: WorkRow): void {
    const shown: LoopShown = { content: found, row, units: unitNames(found.units), address: addressOf };
    const isShown = (): boolean => content() === found && route.loop === row.place;
    loop.show(shown, { order: list.order(), list: formatRoute({ ...route, loop: null, other: null }) });
    source?.whole(row.place).then(
      (whole) => {
        if (!isShown()) return;
        loop.complete(shown, { ...whole, steps: stepsOf(row, whole) });
        if (route.other !== null && found.loops[route.other]) void drawWith(route.other);
      },
      (error: unknown) => isShown() && complain(error),
    );
  }

  async function drawWith(place: number | null): Promise<void> {
    const from = route;
    const isNewest = beginWith();
    const other = place === null ? null : await source?.whole(place).catch(complain);
    if (isNewest() && route === from) loop.drawWith(other?.loop ?? null, place);
  }

  function showHead(tag: string): void {
    const found = content();
    const size = found ? counted(found.loops.length, "loop") : "";
    const name = state?.name || (found ? `Check of ${size}` : "");
    const text = route.of === null ? TITLE : tag || name || TITLE;
    if (heading.textContent !== text) heading.textContent = text;
    about.textContent = route.of === null || !found ? "" : tag ? name : aboutWords(found, state?.name ? size : "");
    about.hidden = about.textContent === "";
    tools.hidden = route.of === null || route.loop !== null;
    save.hidden = !found;
    menu.element.hidden = route.of === null || !state?.request || route.loop !== null;
    again.hidden = !state?.request;
    // A batch has one for each of its jobs.
    report.show(found && route.of?.kind === "job" ? route.of.id : null, state?.finished);
    again.href = formatRoute({ ...EMPTY, from: route.of?.id ?? null });
    document.title = `${route.of === null ? "" : `${text} · `}Check · Tunewright`;
  }

  /** What the engineer can go on with: the record of the loop. */
  function stepsOf({ loop: { tag, action } }: WorkRow, { sent, units }: WholeLoop): HTMLElement[] {
    if (!sent) return [];
    const test: IdentifyRequest = { name: tag, ...(units ? { units } : {}), record: recordOf(sent) };
    const first = action.code === "retune";
    const identify = h("button", { type: "button", class: first ? "primary" : null, onclick: () => events.onIdentify(test) }, "Identify from this record");
    const tune = h("button", { type: "button", onclick: () => void events.onTune(test).catch(complain) }, "Design from this record");
    return first ? [identify, tune] : [identify];
  }

  async function fill(from: string): Promise<void> {
    if (filledFrom === from) return;
    const { request } = await getCheck(from);
    if (route.from !== from || !request || !isCheckRequest(request)) return;
    filledFrom = from;
    form.load(request);
  }

  /** On another part the focus goes to its heading; back on the work list to the loop that was shown. */
  function arrive(before: CheckRoute): void {
    const same = sameCheck(before.of, route.of);
    if (same && before.loop === route.loop) return;
    window.scrollTo(0, 0);
    if (same && before.loop !== null && route.loop !== null && document.activeElement !== document.body) return;
    if (same && before.loop !== null && route.loop === null && list.focus(before.loop)) return;
    heading.focus();
  }

  return {
    element,
    heading,
    dispose() {
      source?.stop();
      loop.dispose();
    },
    open(next) {
      const last = route;
      route = next;
      say("");
      if (next.of !== null && !sameCheck(next.of, followed)) follow(next.of);
      if (next.of === null) {
        void earlier.look();
        if (next.from !== null) void fill(next.from).catch(complain);
      }
      if (next.of !== null) void source?.compare(next.before);
      list.setView(next.list);
      show();
      if (element.isConnected) arrive(last);
    },
  };
}
