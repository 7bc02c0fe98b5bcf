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

/** The entry that can be moved. */
export interface Selected {
  /** Its linearised response is drawn as well if there are many. */
  index: number;
  /** They drag it. */
  grips: Grips | null;
  /** The proposal from which it was moved. */
  before: Drawn | null;
}

export function showEntryPlots(
  plots: PlotGrid,
  entries: Drawn[],
  request: TuningRequest | undefined,
  { index: selected, grips, before }: Partial<Selected> = {},
): void {
  const drawn = before ? [...entries, before] : entries;
  const loops = drawn.map((item) => ({ ...item, entry: running(item.entry) }));
  const responses = loops.some((item) => item.entry.responses);
  // The curves over frequency are known of the ideal loop alone.
  const ideal = drawn.some((item) => item.entry.implemented);
  const named = (frame: Frame): Frame => (ideal ? { ...frame, title: `${frame.title}, ideal` } : frame);
  const frequency = drawn.some((item) => item.entry.frequency);
  const limits = commonLimits(entries.map((item) => item.entry));
  const held = entries.find(({ index }) => index === selected);
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
