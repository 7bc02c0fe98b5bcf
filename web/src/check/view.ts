// The screen Check: records of loops in operation in, the work list of the plant out, and a page for each loop.
import { followCheck, isCheckRequest, getCheck, postCheck } from "../api/check.ts";
import { sentenceOf } from "../api/client.ts";
import { cancelJob } from "../api/jobs.ts";
import { maxBodyBytes } from "../api/records.ts";
import type { CheckJob, CheckRequest, IdentifyRequest, LoopCheck } from "../api/types.ts";
import { isFinal } from "../api/types.ts";
import { h } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { fileNameOf } from "../plot/export.ts";
import { addressOfCheck, formatRoute, WHOLE_LIST } from "../routes.ts";
import type { CheckRoute } from "../routes.ts";
import { requestMenu } from "../views/request_menu.ts";
import type { View } from "../views/start.ts";
import { unitNames } from "../words/numbers.ts";
import { counted } from "../words/range.ts";
import { workRows } from "./columns.ts";
import type { CheckContent } from "./columns.ts";
import { earlierChecks } from "./earlier.ts";
import { checkForm, tooLong } from "./form.ts";
import { loopView } from "./loop_view.ts";
import type { SentLoop } from "./loop_view.ts";
import { checkProgress } from "./progress_bar.ts";
import { recordOf } from "./request.ts";
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
const EMPTY: CheckRoute = { screen: "check", of: null, from: null, loop: null, list: WHOLE_LIST };

/** The reason why a job that has ended has no work list. */
function whyNone({ request, error }: CheckJob): string {
  if (request && !isCheckRequest(request)) return "This job is not a check of loops.";
  return error?.detail ?? "The check was stopped before a loop was done.";
}

export function checkView(announce: (sentence: string) => void, events: CheckEvents): CheckView {
  const errors = new FormErrors();
  let route = EMPTY;
  let job: CheckJob | null = null;
  let stop: (() => void) | null = null;
  /** The job whose loops fill the form. */
  let filledFrom: string | null = null;
  const heading = h("h1", { tabindex: -1 }, TITLE);
  const about = h("p", { class: "hint" });
  const trouble = h("p", { class: "trouble", role: "alert", hidden: true });
  const again = h("a", { href: "#/check" }, "Change and check again");
  const fresh = h("a", { href: "#/check" }, "New check");
  const save = h("button", { type: "button", class: "quiet", onclick: () => list.save(fileNameOf({ subject: job?.name ?? "", fileName: "work-list" })) }, "Work list as CSV");
  const menu = requestMenu(announce);
  const tools = h("p", { class: "actions check-tools" }, again, fresh, save);
  const form = checkForm(errors, { onCheck: () => void send(form.read()), onExample: () => void tryExample() });
  const progress = checkProgress(announce, () => void cancel());
  const list = workList(announce, (view) => {
    route = { ...route, list: view };
    events.onList(route);
  });
  const loop = loopView(announce);
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

  /** Another kind of job has another result. */
  const content = (): CheckContent | null => (job?.result && "loops" in job.result ? job.result : null);
  const addressOf = (place: number): string => formatRoute({ ...route, loop: place });

  async function send({ request, errors: faults }: ReturnType<typeof form.read>): Promise<void> {
    errors.clear();
    if (faults.length > 0) return errors.show(faults);
    form.setBusy(true);
    try {
      const body = new Blob([JSON.stringify(request)], { type: "application/json" });
      const long = tooLong(body.size, await maxBodyBytes());
      if (long) throw new Error(long);
      announce(`Sending ${counted(request.loops.length, "loop")}.`);
      const posted = await postCheck(body);
      filledFrom = posted.id;
      location.hash = addressOfCheck(posted.id);
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
    await send(form.read());
  }

  const cancel = async (): Promise<void> => {
    if (job) await cancelJob(job.id).catch(complain);
  };

  function complain(error: unknown): void {
    say(sentenceOf(error));
  }

  function say(sentence: string): void {
    trouble.textContent = sentence;
    trouble.hidden = sentence === "";
  }

  function take(next: CheckJob): void {
    const first = content() === null;
    job = next;
    const found = content();
    if (found) {
      list.show(found, unitNames(found.units), addressOf);
      list.setView(route.list);
    }
    menu.show("v1/jobs", next.request ?? null);
    show();
    if (found && first) announce(`${counted(found.loops.length, "loop")} checked. ${list.sentence()}`);
  }

  function follow(id: string): void {
    stop?.();
    job = null;
    menu.show("", null);
    stop = followCheck(id, {
      onJob: take,
      onProgress: progress.follow,
      onTrouble(sentence) {
        say(sentence);
        if (job === null) show();
      },
    });
  }

  /** The part of the screen for the address and the state of the job. */
  function partShown(): HTMLElement | null {
    if (route.of === null) return entry;
    if (content()) return route.loop === null ? list.element : loop.element;
    // Nothing is known of a job that cannot be read.
    if (job === null) return trouble.hidden ? progress.element : null;
    return isFinal(job.status) ? null : progress.element;
  }

  function show(): void {
    const part = partShown();
    for (const one of parts) one.hidden = one !== part;
    const found = content();
    const row = found && route.loop !== null ? workRows(found).find(({ place }) => place === route.loop) : undefined;
    if (part === loop.element && found && row)
      loop.show(
        { content: found, row, units: unitNames(found.units), address: addressOf },
        { order: list.order(), list: formatRoute({ ...route, loop: null }) },
        sentLoop(row.loop, row.place),
      );
    else loop.leave();
    if (part === progress.element && job) progress.show(job);
    if (part === loop.element && !row) {
      loop.element.hidden = true;
      say("This check has no such loop.");
    }
    if (part === null && job) say(whyNone(job));
    showHead(part === loop.element ? (row?.loop.tag ?? TITLE) : "");
  }

  function showHead(tag: string): void {
    const found = content();
    const name = job?.name || (found ? `Check of ${counted(found.loops.length, "loop")}` : "");
    const text = route.of === null ? TITLE : tag || name || TITLE;
    if (heading.textContent !== text) heading.textContent = text;
    const partial = found?.partial ? " The check was stopped early: loops that it did not reach have no result." : "";
    about.textContent = route.of === null || !found ? "" : tag ? name : `${job?.name ? counted(found.loops.length, "loop") : ""}${partial}`.trim();
    about.hidden = about.textContent === "";
    tools.hidden = route.of === null || route.loop !== null;
    save.hidden = !found;
    menu.element.hidden = route.of === null || !job?.request || route.loop !== null;
    again.hidden = !job?.request;
    again.href = formatRoute({ ...EMPTY, from: route.of });
    document.title = `${route.of === null ? "" : `${text} · `}Check · Tunewright`;
  }

  /** The loop as it was sent, and what the engineer can go on with. */
  function sentLoop({ tag, action }: LoopCheck, place: number): SentLoop {
    const sent = job?.request?.loops[place] ?? null;
    const units = job?.request?.units;
    if (!sent) return { loop: null, units, steps: [] };
    const test: IdentifyRequest = { name: tag, ...(units ? { units } : {}), record: recordOf(sent) };
    const first = action.code === "retune";
    const identify = h("button", { type: "button", class: first ? "primary" : null, onclick: () => events.onIdentify(test) }, "Identify from this record");
    const tune = h("button", { type: "button", onclick: () => void events.onTune(test).catch(complain) }, "Design from this record");
    return { loop: sent, units, steps: first ? [identify, tune] : [identify] };
  }

  async function fill(from: string): Promise<void> {
    if (filledFrom === from) return;
    const request: CheckRequest | undefined = (job?.id === from ? job : await getCheck(from)).request;
    if (route.from !== from || !request || !isCheckRequest(request)) return;
    filledFrom = from;
    form.load(request);
  }

  /** On another part the focus goes to its heading; back on the work list to the loop that was shown. */
  function arrive(before: CheckRoute): void {
    if (before.of === route.of && before.loop === route.loop) return;
    window.scrollTo(0, 0);
    if (before.of === route.of && before.loop !== null && route.loop !== null && document.activeElement !== document.body) return;
    if (before.loop !== null && route.loop === null && before.of === route.of && list.focus(before.loop)) return;
    heading.focus();
  }

  return {
    element,
    heading,
    dispose() {
      stop?.();
      loop.dispose();
    },
    open(next) {
      const before = route;
      route = next;
      say("");
      if (next.of !== null && next.of !== job?.id) follow(next.of);
      if (next.of === null) {
        stop?.();
        stop = null;
        void earlier.look();
        if (next.from !== null) void fill(next.from).catch(complain);
      } else if (job && !isFinal(job.status) && stop === null) follow(next.of);
      list.setView(next.list);
      show();
      if (element.isConnected) arrive(before);
    },
  };
}
