// The form of a check: files that are dropped or chosen, the loops in them, how they are read.
import { sentenceOf } from "../api/client.ts";
import type { CheckRequest, FieldError } from "../api/types.ts";
import { h } from "../dom.ts";
import { textField } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
import { counted } from "../words/range.ts";
import { chosen, dropped, textOf } from "./dropped.ts";
import type { Dropped } from "./dropped.ts";
import { loopRows } from "./loop_rows.ts";
import { readingFields } from "./reading_fields.ts";
import { loopOfFile, NO_LOOPS, readCheck, readFile, textsOf } from "./request.ts";
import type { CheckOrder, LoopTexts } from "./request.ts";

export interface CheckForm {
  element: HTMLElement;
  /** What is to be checked, with the faults of its texts, as soon as the first lines of all files are read. */
  read(): Promise<{ order: CheckOrder; errors: FieldError[] }>;
  load(request: CheckRequest): void;
  setBusy(busy: boolean): void;
}

export interface CheckFormEvents {
  onCheck(): void;
  onExample(): void;
}

export function checkForm(errors: FormErrors, events: CheckFormEvents): CheckForm {
  let base: Partial<CheckRequest> = {};
  let firstLines = Promise.resolve();
  const status = h("p", { class: "hint", role: "status" });
  const faulty = h("p", { class: "error", role: "status", hidden: true });
  const many = h("p", { role: "status", hidden: true }, "This file has the columns of several loops. They are found by their tags, such as FIC101.PV, and checked as a batch.");
  const file = h("input", { type: "file", class: "visually-hidden", multiple: true, accept: ".csv,.tsv,.txt,text/csv,text/plain", tabindex: -1, "aria-label": "CSV files of loops" });
  const choose = h("button", { type: "button", onclick: () => file.click() }, "Choose files");
  const drop = h("div", { class: "drop" }, h("p", {}, "Drop CSV files or a folder here, one loop a file or all loops in one file, or"), choose, file);
  const reading = readingFields(errors, follow);
  const rows = loopRows(errors, follow);
  rows.element.hidden = true;
  const name = textField({ label: "Name of this check", placeholder: "optional, such as Unit 21", pointer: () => "/name" }, errors);
  const cluster = h("input", { type: "checkbox", id: "check-cluster", checked: true });
  const together = h("label", { class: "check", for: "check-cluster" }, cluster, "Look for loops that oscillate together");
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
    together,
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
    many,
    rows.element,
    terms,
    reading.element,
    more,
    faulty,
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

  /** A file that can be read is the example of how all are read. */
  async function readFirstLines(files: readonly string[]): Promise<void> {
    const readable = await rows.read(reading.read());
    if (readable === null) return;
    const count = files.length - readable.length;
    reading.offer(files, readable);
    faulty.hidden = count === 0 || rows.element.hidden;
    faulty.textContent = `${counted(count, "file")} cannot be read like this: see the table.`;
  }

  /** After a change of the loops. */
  function follow(): void {
    const loops = rows.texts();
    firstLines = readFirstLines(loops.flatMap(({ given }) => given.csv ?? []));
    const hasMany = reading.hasMany();
    many.hidden = !hasMany;
    // Of loops that the service finds nothing is known yet; the rows of other files stay, to be removed.
    rows.element.hidden = loops.length === 0 || (hasMany && loops.length === 1);
    together.hidden = hasMany;
    terms.hidden = hasMany || loops.length === 0;
    more.hidden = empty.hidden = loops.length === 0;
    submit.textContent = loops.length === 0 ? "Check the loops" : hasMany ? "Check all loops of the file" : `Check ${counted(loops.length, "loop")}`;
  }

  async function take({ files, others }: Dropped): Promise<void> {
    errors.clear();
    const left = others > 0 ? ` ${counted(others, "file")} without the ending csv, tsv or txt left out.` : "";
    const loops: LoopTexts[] = [];
    const faults: FieldError[] = [];
    for (const [index, one] of files.entries()) {
      status.textContent = `Reading file ${index + 1} of ${files.length}...`;
      try {
        loops.push(loopOfFile(one.name, await textOf(one)));
      } catch (error) {
        faults.push({ pointer: "/loops", detail: `${one.name} was not added: ${sentenceOf(error)}` });
      }
    }
    if (loops.length > 0) rows.add(loops);
    status.textContent = loops.length === 0 ? `No file was added.${left}` : `${counted(loops.length, "file")} added.${left}`;
    if (faults.length > 0) errors.show(faults);
    else if (loops.length > 0) submit.focus({ preventScroll: true });
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
    async read() {
      await firstLines;
      const texts = { name: name.input.value, cluster: cluster.checked, reading: reading.read(), loops: rows.texts(), base };
      if (reading.hasMany()) return readFile(texts);
      const { request, errors: faults } = readCheck(texts);
      return { order: { kind: "loops", request }, errors: faults };
    },
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
      if (busy) submit.textContent = "Sending...";
      else follow();
    },
  };
}
