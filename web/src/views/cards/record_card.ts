// "A recorded test": a CSV file dropped, chosen or pasted. The service finds and reads the columns; nothing is parsed here.
import { newest } from "../../api/latest.ts";
import { maxBodyBytes, previewFile, previewRecord } from "../../api/records.ts";
import type { FieldError, Preview, RecordedTest } from "../../api/types.ts";
import { h } from "../../dom.ts";
import type { FormErrors } from "../../form/errors.ts";
import { csvOf, recordFields } from "../../form/record_fields.ts";
import type { Identify } from "../../form/record_fields.ts";
import { typedParts } from "../../form/typed.ts";
import { previewPanel, tooLarge } from "../../form/record_preview.ts";
import { recordText } from "../../form/record_text.ts";

export interface RecordCard {
  element: HTMLFormElement;
  read(): { record: RecordedTest; identify: Identify; errors: FieldError[] };
  load(record: RecordedTest, identify: Identify | undefined): void;
  /** The next loop does not belong to this record. */
  endLoop(): void;
}

export interface RecordCardEvents {
  /** Shows the record first; a new file does that too. */
  onIdentify(): void;
  /** A new record was given. */
  onNew(): void;
  /** The columns were read. */
  onRead(preview: Preview): void;
  /** Tunes directly. */
  onTune(): void;
  /** By every method. */
  onCompare(): void;
}

export function recordCard(errors: FormErrors, events: RecordCardEvents): RecordCard {
  const status = h("p", { class: "hint", role: "status" });
  const file = h("input", {
    type: "file",
    class: "visually-hidden",
    accept: ".csv,.txt,.tsv,.log,.json,text/csv,text/plain,application/json",
    tabindex: -1,
    "aria-label": "CSV file",
  });
  const choose = h("button", { type: "button", onclick: () => file.click() }, "Choose file");
  const drop = h("div", { class: "drop" }, h("p", {}, "Drop a CSV file here, or"), choose, file);
  const csv = recordText(
    {
      label: "or paste it",
      hint: "One row per sample: time, controller output u, measurement y.",
      placeholder: "t,u,y\n0,0,20.1\n1,5,20.1\n2,5,20.3",
      rows: 4,
      wide: true,
      pointer: () => "/record/csv",
    },
    errors,
  );
  const fields = recordFields(errors, false);
  const shown = h("div", { class: "preview-slot" });
  const reading = h(
    "details",
    {},
    h("summary", {}, "Columns, kind of test, model"),
    h("div", { class: "stack" }, shown, fields.elements),
  );
  const element = h(
    "form",
    { class: "card", novalidate: true },
    h("h2", {}, "A recorded test"),
    h(
      "p",
      { class: "hint" },
      "A step, a relay test, or any movement of the controller's output with the measurement that followed.",
    ),
    drop,
    status,
    csv.element,
    reading,
    h(
      "div",
      { class: "actions" },
      h("button", { type: "submit", class: "primary" }, "Identify this test"),
      h("button", { type: "button", onclick: () => events.onTune() }, "Tune at once"),
      h(
        "button",
        { type: "button", onclick: () => events.onCompare() },
        "Compare all methods",
        h("span", { class: "visually-hidden" }, " on this record"),
      ),
    ),
  );

  const beginReading = newest();
  const beginLook = newest();

  async function take(chosen: File | undefined): Promise<void> {
    if (!chosen) return;
    const isNewest = beginReading();
    const large = tooLarge(chosen, await maxBodyBytes());
    if (!isNewest()) return;
    status.className = large ? "trouble" : "hint";
    if (large) {
      status.textContent = csv.read().trim() === "" ? large : `${large} The record in the box is still the one before.`;
      return;
    }
    errors.clear();
    status.textContent = `Reading ${chosen.name}...`;
    const read = await previewFile(chosen).catch((error: unknown) => {
      if (!isNewest()) return null;
      errors.fail(error);
      status.textContent = `${chosen.name} could not be read.`;
      return null;
    });
    // Another file, or text, was given since then.
    if (!read || !isNewest()) return;
    csv.write(read.text);
    begin({});
    status.textContent = `${chosen.name}: ${read.preview.rows} rows.`;
    if (show(read.preview)) events.onIdentify();
  }

  /** Forgets the columns of another file; options for the identification stay if they were chosen for this one. */
  function begin(record: RecordedTest): void {
    fields.load(record, typed.has("") ? fields.read().identify : {});
    events.onNew();
  }

  /** True if the record can be read; otherwise it shows what is missing, and where to choose it. */
  function show(preview: Preview): boolean {
    beginLook();
    offer(preview);
    if (preview.problems.length === 0) return true;
    reading.open = true;
    errors.show(preview.problems);
    return false;
  }

  function offer(preview: Preview): void {
    shown.replaceChildren(previewPanel(preview));
    fields.offer(preview);
    events.onRead(preview);
  }

  /** Previews pasted text, or text with other reading options, again. */
  async function look(): Promise<void> {
    const isNewest = beginLook();
    if (csv.read().trim() === "") return shown.replaceChildren();
    try {
      const preview = await previewRecord({ ...fields.read().record, csv: csv.read() });
      if (!isNewest()) return;
      offer(preview);
    } catch {
      // The identification reports the fault.
    }
  }

  /** A file that is still being read is dropped. */
  function forgetFile(): void {
    beginReading();
    status.textContent = "";
  }

  csv.onChange(() => {
    forgetFile();
    begin(typed.has("") ? fields.read().record : {});
    void look();
  });
  reading.addEventListener("change", () => void look());
  const typed = typedParts([reading]);
  file.addEventListener("change", () => void take(file.files?.[0]));
  // The whole card accepts a dropped file, because users do not aim.
  element.addEventListener("dragover", (event) => {
    event.preventDefault();
    drop.classList.add("over");
  });
  element.addEventListener("dragleave", () => drop.classList.remove("over"));
  element.addEventListener("drop", (event) => {
    event.preventDefault();
    drop.classList.remove("over");
    // A field that is being typed in reports its text when it is left, which a drop does not do.
    if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
    void take(event.dataTransfer?.files[0]);
  });
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    events.onIdentify();
  });

  return {
    element,
    read() {
      const read = fields.read();
      const missing = csv.read().trim() === "";
      return {
        record: { ...read.record, csv: csv.read() },
        identify: read.identify,
        errors: missing
          ? [
              {
                pointer: "/record/csv",
                detail: "There is no record yet. Drop a CSV file, choose one, or paste its text.",
              },
            ]
          : read.errors,
      };
    },
    endLoop: typed.forget,
    load(record, identify) {
      typed.forget();
      forgetFile();
      beginLook();
      csv.write(csvOf(record));
      fields.load(record, identify);
      shown.replaceChildren();
    },
  };
}
