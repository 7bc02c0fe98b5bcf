// The record of a loop in automatic, and the same time with the drawn controllers: y with the set point, over u.
import type { Result } from "../api/types.ts";
import type { Frame, Trace } from "../plot/frame.ts";
import { formatNumber, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import type { Drawn } from "./drawn.ts";
import { held } from "./record.ts";

/** An answer to a slider has no replays: entries with the controller of an entry of the job get its replay. */
export const withReplays = ({ controllers }: Result, drawn: Drawn[]): Drawn[] =>
  drawn.map((item) => {
    const controller = JSON.stringify(item.entry.controller);
    const same = controllers.find((entry) => entry.replay && JSON.stringify(entry.controller) === controller);
    return same?.replay ? { ...item, entry: { ...item.entry, replay: same.replay } } : item;
  });

/** Null if nothing is replayed: no record, a record that is refused, or no drawn entry with a replay. */
export function replayFrame(result: Result, drawn: Drawn[], units: UnitNames): Frame | null {
  const recorded = result.replay;
  const replayed = drawn.filter(({ entry }) => entry.replay?.y?.length);
  const t = recorded?.t ?? [];
  if (!recorded || recorded.refused || t.length < 2 || replayed.length === 0) return null;
  const lines = (signal: "y" | "u"): Trace[] => [
    { name: "recorded", look: "data", x: t, y: recorded[signal] ?? [] },
    ...replayed.map(({ name, look, entry }): Trace => ({ name, look, x: t, y: entry.replay?.[signal] ?? [] })),
  ];
  const setPoint: Trace = { name: "set point", look: "data", thin: true, ...held(t, recorded.r ?? []) };
  return {
    title: "Record and replay",
    description: replayed.map(describe).join(" "),
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes: [
      { y: { kind: "linear", label: withUnit("y", units.y) }, traces: [...lines("y"), setPoint], weight: 1.5 },
      { y: { kind: "linear", label: withUnit("u", units.u) }, traces: lines("u") },
    ],
    ownLegend: true,
    link: "record",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: "replay",
  };
}

function describe({ name, entry }: Drawn): string {
  const { IAE_ratio, IAE_ratio_low, IAE_ratio_high } = entry.replay!;
  const band = `between ${formatNumber(IAE_ratio_low)} and ${formatNumber(IAE_ratio_high)}`;
  return `${name}: ${formatNumber(IAE_ratio)} times the integrated absolute error of the record, ${band}.`;
}
