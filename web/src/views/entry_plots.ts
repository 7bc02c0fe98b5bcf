// The plots of Design and Compare: responses, Nyquist curve and sensitivities of the drawn entries, one trace each.
import type { TuningRequest } from "../api/types.ts";
import { bodeFrame } from "../charts/bode.ts";
import type { Drawn } from "../charts/drawn.ts";
import { nyquistFrame } from "../charts/nyquist.ts";
import { responseFrame } from "../charts/responses.ts";
import { sensitivityFrame } from "../charts/sensitivities.ts";
import type { Frame } from "../plot/frame.ts";
import type { PlotGrid } from "../plot/grid.ts";
import { peakOf } from "./grips.ts";
import type { Grips } from "./grips.ts";
import { commonLimits } from "../words/limits.ts";
import { running } from "../words/running.ts";

/** `selected`: the entry whose linearised response is drawn as well if there are many, and which `grips` drag. */
export function showEntryPlots(
  plots: PlotGrid,
  drawn: Drawn[],
  request: TuningRequest | undefined,
  selected?: number,
  grips: Grips | null = null,
): void {
  const loops = drawn.map((item) => ({ ...item, entry: running(item.entry) }));
  const responses = loops.some((item) => item.entry.responses);
  // The curves over frequency are known of the ideal loop alone.
  const ideal = drawn.some((item) => item.entry.implemented);
  const named = (frame: Frame): Frame => (ideal ? { ...frame, title: `${frame.title}, ideal` } : frame);
  const frequency = drawn.some((item) => item.entry.frequency);
  const limits = commonLimits(drawn.map((item) => item.entry));
  const held = drawn.find(({ index }) => index === selected);
  const response = (kind: "setpoint" | "load"): Frame => {
    const grip = held && grips?.peak(kind, request?.evaluate?.setpoint_step ?? 1);
    return responseFrame(kind, loops, request, selected, grip && { ...grip, at: peakOf(held.entry, kind), look: held.look });
  };
  const grip = held && grips?.nyquist();
  plots.show("setpoint", responses ? response("setpoint") : null);
  plots.show("load", responses ? response("load") : null);
  plots.show("nyquist", frequency ? named(nyquistFrame(drawn, limits, request, grip && { ...grip, index: held.index })) : null);
  const curves = (): Frame => ({ ...sensitivityFrame(drawn, limits, request), alternative: bodeFrame(drawn, request) });
  plots.show("sensitivities", frequency ? named(curves()) : null);
}
