// The form of a check: files that are dropped or chosen, the loops in them, how they are read.
import { maxBodyBytes } from "../api/records.ts";
import type { CheckRequest, FieldError } from "../api/types.ts";
import { h } from "../dom.ts";
import { textField } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
import { counted } from "../words/range.ts";
import { chosen, dropped, textOf } from "./dropped.ts";
import type { Dropped } from "./dropped.ts";
import { loopRows } from "./loop_rows.ts";
import { readingFields } from "./reading_fields.ts";
import { loopOfFile, NO_LOOPS, readCheck, textsOf } from "./request.ts";
import type { LoopTexts } from "./request.ts";

export interface CheckForm {
  element: HTMLElement;
  /** The request, with the faults of its texts. */
  read(): { request: CheckRequest; errors: FieldError[] };
  load(request: CheckRequest): void;
  setBusy(busy: boolean): void;
}

export interface CheckFormEvents {
  onCheck(): void;
  onExample(): void;
}

const mebibytes = (bytes: number): string => `${(bytes / 1024 / 1024).toFixed(1)} MiB`;

/** The reason why a check cannot be sent to a service that takes bodies of at most `maxBytes`; "" if it can. */
export const tooLong = (bytes: number, maxBytes: number): string =>
  bytes > maxBytes
    ? `The records have ${mebibytes(bytes)} together; one check takes at most ${mebibytes(maxBytes)}. Remove some loops and check them afterwards, or shorten the records.`
    : "";

const charactersOf = (loops: readonly LoopTexts[]): number => loops.reduce((sum, { given }) => sum + (given.csv?.length ?? 0), 0);

export function checkForm(errors: FormErrors, events: CheckFormEvents): CheckForm {
  let base: Partial<CheckRequest> = {};
  const status = h("p", { class: "hint", role: "status" });
  const size = h("p", { class: "trouble", role: "status", hidden: true });
  const file = h("input", { type: "file", class: "visually-hidden", multiple: true, accept: ".csv,.tsv,.txt,text/csv,text/plain", tabindex: -1, "aria-label": "CSV files of loops" });
  const choose = h("button", { type: "button", onclick: () => file.click() }, "Choose files");
  const drop = h("div", { class: "drop" }, h("p", {}, "Drop CSV files or a folder here, one loop a file, or"), choose, file);
  const reading = readingFields(errors);
  const rows = loopRows(errors, follow);
  const name = textField({ label: "Name of this check", placeholder: "optional, such as Unit 21", pointer: () => "/name" }, errors);
  const cluster = h("input", { type: "checkbox", id: "check-cluster", checked: true });
  const submit = h("button", { type: "submit", class: "primary" }, "Check the loops");
  const empty = h("button", { type: "button", hidden: true, onclick: () => clear() }, "Remove all");
  const example = h("button", { type: "button", onclick: events.onExample }, "Try the example plant");
  const terms = h(
    "p",
    { class: "hint", hidden: true },
    "Averaging: a level that is there to smooth flows; its variation is not judged. Weight: the money that a mean error of one unit of the measurement costs in an hour; with weights the work list is in order of money.",
  );
  const more = h(
    "div",
    { class: "check-terms", hidden: true },
    name.element,
    h("label", { class: "check", for: "check-cluster" }, cluster, "Look for loops that oscillate together"),
  );
  const element = h(
    "form",
    { class: "card check-form", novalidate: true },
    h("h2", {}, "Records of loops in operation"),
    h(
      "p",
      { class: "hint" },
      "Time, measurement (PV) and controller output (OP) of each loop over many periods, such as a day; set point (SP) and mode if you have them. No test is needed. Raw values tell more than compressed ones.",
    ),
    drop,
    status,
    size,
    rows.element,
    terms,
    reading.element,
    more,
    h("div", { class: "actions" }, submit, empty, example),
  );

  function clear(): void {
    base = {};
    rows.show([]);
    name.input.value = "";
    cluster.checked = true;
    status.textContent = "";
    errors.clear();
    choose.focus();
  }

  /** After a change of the loops: the first file is the example of how they are read. */
  function follow(): void {
    const loops = rows.texts();
    more.hidden = terms.hidden = empty.hidden = loops.length === 0;
    submit.textContent = loops.length === 0 ? "Check the loops" : `Check ${counted(loops.length, "loop")}`;
    reading.offer(loops.find(({ given }) => given.csv !== undefined)?.given.csv ?? null);
    void maxBodyBytes().then((limit) => {
      const words = tooLong(charactersOf(rows.texts()), limit);
      size.textContent = words;
      size.hidden = words === "";
    });
  }

  async function take({ files, others }: Dropped): Promise<void> {
    errors.clear();
    const left = others > 0 ? ` ${counted(others, "file")} without the ending csv, tsv or txt left out.` : "";
    const loops: LoopTexts[] = [];
    for (const [index, one] of files.entries()) {
      status.textContent = `Reading file ${index + 1} of ${files.length}...`;
      const text = await textOf(one).catch((error: unknown) => {
        errors.fail(error);
        return null;
      });
      if (text !== null) loops.push(loopOfFile(one.name, text));
    }
    if (loops.length > 0) rows.add(loops);
    status.textContent = files.length === 0 ? `No file was read.${left}` : `${counted(loops.length, "file")} added.${left}`;
    if (loops.length > 0) submit.focus({ preventScroll: true });
  }

  file.addEventListener("change", () => {
    const list = chosen(file.files ?? []);
    file.value = "";
    void take(list);
  });
  // The whole card accepts dropped files, because users do not aim.
  element.addEventListener("dragover", (event) => {
    event.preventDefault();
    drop.classList.add("over");
  });
  element.addEventListener("dragleave", () => drop.classList.remove("over"));
  element.addEventListener("drop", (event) => {
    event.preventDefault();
    drop.classList.remove("over");
    if (event.dataTransfer) void dropped(event.dataTransfer).then(take);
  });
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    if (rows.texts().length === 0) errors.show([{ pointer: "/loops", detail: NO_LOOPS }]);
    else events.onCheck();
  });

  return {
    element,
    read: () =>
      readCheck({ name: name.input.value, cluster: cluster.checked, reading: reading.read(), loops: rows.texts(), base }),
    load(request) {
      const texts = textsOf(request);
      ({ base } = texts);
      name.input.value = texts.name;
      cluster.checked = texts.cluster;
      status.textContent = "";
      rows.show(texts.loops);
    },
    setBusy(busy) {
      submit.disabled = example.disabled = busy;
    },
  };
}
