// A simulated relay test: y between the relay's thresholds, over u.
import type { RelayAnswer } from "../api/types.ts";
import type { Frame, Mark } from "../plot/frame.ts";
import { formatNumber, withUnit } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";
import { held } from "./record.ts";

export function relayFrame(answer: RelayAnswer, hysteresis: number, units: UnitNames): Frame {
  const { t, u, y } = answer.record;
  const thresholds: Mark[] =
    hysteresis > 0
      ? [
          { kind: "level", value: hysteresis, role: "limit", label: "switches above" },
          { kind: "level", value: -hysteresis, role: "limit" },
        ]
      : [];
  return {
    title: "The test as it would be recorded",
    description: `It oscillates with a period of ${formatNumber(answer.limit_cycle.Pu, 4)} ${units.time}.`,
    x: { kind: "linear", label: withUnit("time", units.time) },
    panes: [
      {
        y: { kind: "linear", label: withUnit("y", units.y) },
        traces: [{ name: "y", look: 1, x: t, y }],
        marks: thresholds,
        weight: 1.8,
      },
      { y: { kind: "linear", label: withUnit("u", units.u) }, traces: [{ name: "u", look: "data", ...held(t, u) }] },
    ],
    link: "relay",
    cursorLabel: withUnit("time", units.time),
    cursorKind: "linear",
    fileName: "relay-test",
  };
}
