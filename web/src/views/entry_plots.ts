// The plots of Design and Compare: responses, Nyquist curve and sensitivities of the drawn entries, one trace each.
import type { TuningRequest } from "../api/types.ts";
import { bodeFrame } from "../charts/bode.ts";
import type { Drawn } from "../charts/drawn.ts";
import { nyquistFrame } from "../charts/nyquist.ts";
import { responseFrame } from "../charts/responses.ts";
import { sensitivityFrame } from "../charts/sensitivities.ts";
import type { Frame } from "../plot/frame.ts";
import type { PlotGrid } from "../plot/grid.ts";
import { commonLimits } from "../words/limits.ts";

/** `selected`: the entry whose linearised response is drawn as well if there are many. */
export function showEntryPlots(
  plots: PlotGrid,
  drawn: Drawn[],
  request: TuningRequest | undefined,
  selected?: number,
): void {
  const responses = drawn.some((item) => item.entry.responses);
  const frequency = drawn.some((item) => item.entry.frequency);
  const limits = commonLimits(drawn.map((item) => item.entry));
  plots.show("setpoint", responses ? responseFrame("setpoint", drawn, request, selected) : null);
  plots.show("load", responses ? responseFrame("load", drawn, request, selected) : null);
  plots.show("nyquist", frequency ? nyquistFrame(drawn, limits, request) : null);
  const curves = (): Frame => ({ ...sensitivityFrame(drawn, limits, request), alternative: bodeFrame(drawn, request) });
  plots.show("sensitivities", frequency ? curves() : null);
}
