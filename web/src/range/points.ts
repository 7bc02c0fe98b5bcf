// The points of a range: a row for each, with its place and a plant in one line, or the file of a test recorded there.
import { maxBodyBytes, previewFile } from "../api/records.ts";
import type { Preview } from "../api/types.ts";
import { h } from "../dom.ts";
import { textField } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";
import { formWords, previewPanel, tooLarge } from "../form/record_preview.ts";
import { rowList } from "../form/row_list.ts";
import type { Row } from "../form/row_list.ts";
import type { PointTexts } from "./request.ts";

export interface PointFields {
  element: HTMLElement;
  read(): PointTexts[];
  show(points: PointTexts[]): void;
  /** Each file becomes a row; the user types its place. */
  takeFiles(files: Iterable<File>): Promise<void>;
}

export interface PointEvents {
  onChange(): void;
  /** Reports the preview of a file. */
  onPreview(preview: Preview): void;
  onError(error: unknown): void;
}

/** The preview of each file, until the page is closed. */
const previews = new WeakMap<object, Preview>();

export function pointFields(errors: FormErrors, active: () => boolean, events: PointEvents): PointFields {
  const status = h("p", { class: "hint", role: "status" });
  const list = rowList<PointTexts>(
    "point",
    ["At", "Plant"],
    events.onChange,
    ({ at, file }) => [at || "without a place", file].filter(Boolean).join(", "),
    (texts, rows) =>
      pointRow(texts ?? { at: "", text: "" }, errors, (row, part) =>
        active() ? `/points/${rows().indexOf(row)}/${part}` : null,
      ),
  );
  const file = h("input", {
    type: "file",
    class: "visually-hidden",
    multiple: true,
    accept: ".csv,.txt,.tsv,text/csv,text/plain",
    tabindex: -1,
    "aria-label": "CSV files of tests, one per point",
  });
  const choose = h(
    "button",
    { type: "button", class: "quiet", onclick: () => file.click() },
    "Add recorded tests (CSV)",
  );
  const element = h(
    "div",
    { class: "range-points" },
    h(
      "p",
      { class: "hint" },
      "A plant as a formula, 2 e^(-3s)/(12s+1), or as K=2 T=12 L=3. Files of recorded tests can be dropped here.",
    ),
    list.element,
    h("div", { class: "add-records" }, choose, file),
    status,
  );

  async function takeOne(chosen: File): Promise<void> {
    const large = tooLarge(chosen, await maxBodyBytes());
    if (large) return void (status.textContent = large);
    status.textContent = `Reading ${chosen.name}...`;
    const read = await previewFile(chosen).catch((error: unknown) => {
      status.textContent = `${chosen.name} could not be read.`;
      events.onError(error);
      return null;
    });
    if (!read) return;
    // Empty rows are removed.
    const filled = list.texts().filter((point) => point.at.trim() !== "" || point.text.trim() !== "" || point.record);
    if (filled.length < list.texts().length) list.show(filled);
    const record = { csv: read.text };
    previews.set(record, read.preview);
    const row = list.add({ at: "", text: "", record, file: chosen.name });
    status.textContent = `${chosen.name}: ${read.preview.rows} rows. Type where it was recorded.`;
    row.first.focus();
    events.onPreview(read.preview);
    events.onChange();
  }

  async function takeFiles(files: Iterable<File>): Promise<void> {
    for (const chosen of files) await takeOne(chosen);
  }

  file.addEventListener("change", () => {
    const chosen = [...(file.files ?? [])];
    file.value = "";
    void takeFiles(chosen);
  });
  element.addEventListener("change", events.onChange);
  return { element, read: list.texts, show: list.show, takeFiles };
}

function pointRow(
  given: PointTexts,
  errors: FormErrors,
  pointer: (row: Row<PointTexts>, part: string) => string | null,
): Row<PointTexts> {
  const at = textField({ label: "Place", bare: true, value: given.at, pointer: () => pointer(row, "at") }, errors);
  const { record } = given;
  const plant = textField(
    {
      label: record ? "Recorded test" : "Plant",
      bare: true,
      value: record ? (given.file ?? "recorded test") : given.text,
      placeholder: given.given && given.text === "" ? "as it came" : "2 e^(-3s)/(12s+1)",
      pointer: () => pointer(row, record ? "record" : "plant"),
    },
    errors,
  );
  plant.input.readOnly = record !== undefined;
  const preview = record ? previews.get(record) : undefined;
  const seen = preview
    ? h("details", { class: "point-preview" }, h("summary", {}, formWords(preview)), previewPanel(preview))
    : null;
  const row: Row<PointTexts> = {
    element: h("div", { class: "row point-row", role: "group" }, at.element, plant.element, seen),
    first: at.input,
    texts: () =>
      record ? { ...given, at: at.input.value } : { ...given, at: at.input.value, text: plant.input.value },
    dispose() {
      errors.remove(at.control);
      errors.remove(plant.control);
    },
  };
  const name = (): void => row.element.setAttribute("aria-label", `Point ${at.input.value}`);
  at.input.addEventListener("input", name);
  name();
  return row;
}
