// A plot's data as a table: every sample of short traces, evenly chosen rows of long ones (exports have all).
import { h } from "../dom.ts";
import { tickText } from "./axis.ts";
import type { Frame } from "./frame.ts";
import { partsOf } from "./readout.ts";

const MAX_ROWS = 60;

export function dataTable(frame: Frame): HTMLElement {
  return h(
    "div",
    {},
    frame.panes.map((pane) => {
      const traces = pane.traces;
      const { unit } = partsOf(pane.y.label);
      const longest = Math.max(0, ...traces.map((trace) => trace.x.length));
      const rows = Math.min(longest, MAX_ROWS);
      const at = (row: number, length: number): number =>
        rows < 2 ? 0 : Math.round((row * (length - 1)) / (rows - 1));
      const text = (value: number | null | undefined): string =>
        typeof value === "number" ? tickText(Number(value.toPrecision(4))) : "–";
      const note = longest > rows ? ` (${rows} of ${longest} rows; the CSV export has all)` : "";
      return h(
        "table",
        { class: "figures" },
        h("caption", {}, `${frame.title}: ${pane.y.label}${note}`),
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            traces.map((trace) => [
              trace.parameter ? h("th", { scope: "col" }, frame.cursorLabel) : null,
              h("th", { scope: "col" }, frame.x.label),
              h("th", { scope: "col" }, unit ? `${trace.name} (${unit})` : trace.name),
            ]),
          ),
        ),
        h(
          "tbody",
          {},
          Array.from({ length: rows }, (_, row) =>
            h(
              "tr",
              {},
              traces.map((trace) => {
                const index = at(row, trace.x.length);
                return [
                  trace.parameter ? h("td", {}, text(trace.parameter[index])) : null,
                  h("td", {}, text(trace.x[index])),
                  h("td", {}, text(trace.y[index])),
                ];
              }),
            ),
          ),
        ),
      );
    }),
  );
}
