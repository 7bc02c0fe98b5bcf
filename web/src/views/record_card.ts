// "A recorded test": a CSV file dropped, chosen or pasted. The service finds and reads the columns; nothing is parsed here.
import type { FieldError, RecordedTest } from "../api/types.ts";
import { h } from "../dom.ts";
import { areaField, choiceField, textField } from "../form/controls.ts";
import type { FormErrors } from "../form/errors.ts";

export interface RecordCard {
  element: HTMLFormElement;
  read(): { record: RecordedTest; identify: Record<string, unknown>; errors: FieldError[] };
  load(record: RecordedTest, identify: Record<string, unknown> | undefined): void;
}

const KINDS = [
  ["auto", "automatic"],
  ["step", "step test"],
  ["relay", "relay test"],
  ["general", "any other movement"],
] as const;

const MODELS = [
  ["auto", "automatic"],
  ["fopdt", "first order with dead time"],
  ["sopdt", "second order with dead time"],
  ["ipdt", "integrating with dead time"],
] as const;

const LARGEST_BYTES = 8 * 1024 * 1024;

export function recordCard(errors: FormErrors, onTune: () => void): RecordCard {
  const status = h("p", { class: "hint", role: "status" });
  const file = h("input", {
    type: "file",
    class: "visually-hidden",
    accept: ".csv,.txt,.tsv,text/csv,text/plain",
    tabindex: -1,
    "aria-label": "CSV file",
  });
  const choose = h("button", { type: "button", onclick: () => file.click() }, "Choose file");
  const drop = h("div", { class: "drop" }, h("p", {}, "Drop a CSV file here, or"), choose, file);
  const csv = areaField(
    {
      label: "or paste it",
      hint: "One row a sample: time, controller output u, measurement y.",
      placeholder: "t,u,y\n0,0,20.1\n1,5,20.1\n2,5,20.3",
      rows: 4,
      wide: true,
      pointer: () => "/record/csv",
    },
    errors,
  );
  const column = (name: "t" | "u" | "y", meaning: string): ReturnType<typeof textField> =>
    textField(
      {
        label: `Column ${name}`,
        hint: `${meaning}; heading or number`,
        placeholder: "auto",
        pointer: () => `/record/columns/${name}`,
      },
      errors,
    );
  const columns = { t: column("t", "time"), u: column("u", "output"), y: column("y", "measurement") };
  const kind = choiceField({ label: "Kind of test", choices: KINDS, pointer: () => "/record/kind" }, errors);
  const model = choiceField({ label: "Model", choices: MODELS, pointer: () => "/identify/model" }, errors);
  const element = h(
    "form",
    { class: "card", novalidate: true },
    h("h2", {}, "A recorded test"),
    h("p", { class: "hint" }, "You moved the controller's output by hand and logged the measurement."),
    drop,
    status,
    csv.element,
    h("div", { class: "fields three" }, columns.t.element, columns.u.element, columns.y.element),
    h("div", { class: "fields" }, kind.element, model.element),
    h("div", { class: "actions" }, h("button", { type: "submit", class: "primary" }, "Tune from this test")),
  );

  async function take(chosen: File | undefined): Promise<void> {
    if (!chosen) return;
    if (chosen.size > LARGEST_BYTES) {
      status.textContent = `${chosen.name} has ${(chosen.size / 1024 / 1024).toFixed(1)} MiB; 8 MiB is the most that can be sent. Cut the record to the test itself.`;
      return;
    }
    csv.input.value = await chosen.text();
    csv.input.dispatchEvent(new Event("input"));
    const rows = csv.input.value.split("\n").filter((line) => line.trim() !== "").length;
    status.textContent = `${chosen.name}: ${rows} lines.`;
  }

  file.addEventListener("change", () => void take(file.files?.[0]));
  // The whole card takes the file: people do not aim.
  element.addEventListener("dragover", (event) => {
    event.preventDefault();
    drop.classList.add("over");
  });
  element.addEventListener("dragleave", () => drop.classList.remove("over"));
  element.addEventListener("drop", (event) => {
    event.preventDefault();
    drop.classList.remove("over");
    void take(event.dataTransfer?.files[0]);
  });
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    onTune();
  });

  return {
    element,
    read() {
      const record: RecordedTest = { csv: csv.input.value };
      const named = Object.entries(columns).flatMap(([name, field]) =>
        field.input.value.trim() ? [[name, columnOf(field.input.value.trim())] as const] : [],
      );
      if (named.length > 0) record.columns = Object.fromEntries(named);
      if (kind.input.value !== "auto") record.kind = kind.input.value;
      const missing = csv.input.value.trim() === "";
      return {
        record,
        identify: { model: model.input.value },
        errors: missing
          ? [
              {
                pointer: "/record/csv",
                detail: "There is no record yet. Drop a CSV file, choose one, or paste its text.",
              },
            ]
          : [],
      };
    },
    load(record, identify) {
      csv.input.value = record.csv ?? csvOf(record);
      for (const name of ["t", "u", "y"] as const) columns[name].input.value = String(record.columns?.[name] ?? "");
      kind.input.value = record.kind ?? "auto";
      const wanted = identify?.["model"];
      model.input.value = typeof wanted === "string" && MODELS.some(([id]) => id === wanted) ? wanted : "auto";
      status.textContent = "";
    },
  };
}

/** A column is named by its heading, or by its number from 1. */
const columnOf = (text: string): string | number => (/^[1-9]\d*$/.test(text) ? Number(text) : text);

/** A record given as numbers, as the text that the field shows. */
function csvOf(record: RecordedTest): string {
  const { t, u = [], y = [], dt = 1 } = record;
  return ["t,u,y", ...y.map((value, index) => `${t?.[index] ?? index * dt},${u[index] ?? ""},${value}`)].join("\n");
}
