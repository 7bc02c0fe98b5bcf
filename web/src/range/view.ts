// Range: a loop over its whole operating range. Input: points or equations. Output: one setting, a schedule that can be
// moved, and runs.
import type { RangeContent } from "../api/types.ts";
import { ApiError } from "../api/client.ts";
import { getJob } from "../api/jobs.ts";
import { latest } from "../api/latest.ts";
import { designRange, getRangeExamples, isRangeRequest } from "../api/range.ts";
import type { RangeExample, RangeRequest } from "../api/range.ts";
import { h } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { requestMenu } from "../views/request_menu.ts";
import { shown } from "../store.ts";
import type { Store } from "../store.ts";
import type { View } from "../views/start.ts";
import { EMPTY, rangeForm } from "./form.ts";
import { atSharedFields } from "./request.ts";
import { rangeResult } from "./result.ts";

export interface RangeView extends View {
  /** An example by its id, a job's request and result, or the current content; the first example if there is none. */
  open(what: { example: string; job: string | null }): void;
}

export interface RangeEvents {
  /** The example by its id, for the address. */
  onExample(id: string): void;
  /** Posts the request as a job and shows this job. */
  onJob(request: RangeRequest): Promise<void>;
}

/** Displayed rows are neither dropped nor sent with a request for which they were not made. */
const ANOTHER_DESIGN =
  "The rows belong to an earlier request; the form has changed since. Press Design for new rows, or undo the change.";

export function rangeView(store: Store, announce: (sentence: string) => void, events: RangeEvents): RangeView {
  const errors = new FormErrors();
  let examples: RangeExample[] = [];
  let listed: Promise<void> | null = null;
  let opened = "";
  const heading = h("h1", { tabindex: -1 }, "One loop over its whole operating range");
  const busy = h("p", { class: "hint busy", role: "status", hidden: true }, "Designing...");
  const menu = requestMenu(announce);
  menu.show("", null);
  const result = rangeResult(store, announce, (request) => menu.show("v1/range", request));
  const form = rangeForm(errors, {
    onDesign: design,
    onCancel: cancel,
    onJob: () => void sendJob(),
    onExample(id) {
      opened = `/${id}`;
      events.onExample(id);
      void openExample(id);
    },
  });
  const methods = store.pick((workspace) => workspace.methods);
  const leave = shown(() => methods.value, form.setMethods);
  const element = h(
    "main",
    { class: "identify range", id: "main" },
    h("div", { class: "identify-head" }, heading, busy, menu.element),
    errors.summary,
    h("div", { class: "range-body" }, form.element, result.element),
  );

  function setBusy(now: boolean): void {
    busy.hidden = !now;
    element.toggleAttribute("data-busy", now);
    form.setBusy(now);
  }

  const calls = latest<RangeRequest, RangeContent>(designRange, {
    onBusy: setBusy,
    onAnswer(content, request) {
      errors.clear();
      result.show(request, content);
      announce(result.sentence());
    },
    onError(error) {
      complain(error);
      result.setStale(true);
    },
  });

  function complain(error: unknown): void {
    const problem = error instanceof ApiError ? error.problem : {};
    errors.fail(error, atSharedFields(problem.errors ?? []));
  }

  /** The request as typed; null if it cannot be sent, which the form then shows. */
  function compose(): RangeRequest | null {
    const { request, errors: faults } = form.read();
    errors.clear();
    if (faults.length > 0) {
      errors.show(faults);
      result.setStale(true);
    }
    return faults.length > 0 ? null : request;
  }

  function design(): void {
    const request = compose();
    if (request) calls.send(request);
  }

  function cancel(): void {
    calls.drop();
    setBusy(false);
    announce("Stopped.");
  }

  async function sendJob(): Promise<void> {
    const typed = compose();
    if (!typed) return;
    const request = result.withMoved(typed);
    if (request) await events.onJob(request).catch(complain);
    else complain(new Error(ANOTHER_DESIGN));
  }

  /** Examples are requested once; the request is repeated if it failed. */
  function list(): Promise<void> {
    listed ??= getRangeExamples().then(
      (known) => {
        examples = known;
        form.setExamples(known);
      },
      (error: unknown) => {
        listed = null;
        complain(error);
      },
    );
    return listed;
  }

  async function openExample(id: string): Promise<void> {
    await list();
    if (id === EMPTY) {
      calls.drop();
      setBusy(false);
      form.load({});
      form.choose(EMPTY);
      result.clear();
      menu.show("", null);
      return;
    }
    const example = examples.find((candidate) => candidate.id === id) ?? (id === "" ? examples[0] : undefined);
    if (!example) return id === "" ? undefined : complain(new Error(`There is no example "${id}".`));
    form.load(example.request);
    form.choose(example.id);
    design();
  }

  async function openJob(id: string): Promise<void> {
    // The form and the result of before are another request's; what is typed into them now would be lost.
    calls.drop();
    result.clear();
    setBusy(true);
    try {
      const [job] = await Promise.all([getJob(id), list()]);
      const request: unknown = job.request;
      if (!isRangeRequest(request)) throw new Error("This job is not about an operating range.");
      form.load(request);
      form.choose("");
      if (job.result?.range) {
        setBusy(false);
        result.show(request, job.result.range, form.read().request);
      } else design();
    } catch (error) {
      setBusy(false);
      complain(error);
    }
  }

  return {
    element,
    heading,
    dispose() {
      calls.drop();
      leave();
      result.dispose();
    },
    open({ example, job }) {
      const what = `${job ?? ""}/${example}`;
      // A user who returns finds the previous content.
      if (opened !== "" && (what === "/" || what === opened)) return;
      opened = what;
      void (job === null ? openExample(example) : openJob(job));
    },
  };
}
