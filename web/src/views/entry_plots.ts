// The plots of chosen entries, one trace each: both responses, the Nyquist curve, the sensitivities.
import type { TuningRequest } from "../api/types.ts";
import type { Drawn } from "../charts/drawn.ts";
import { nyquistFrame } from "../charts/nyquist.ts";
import { responseFrame } from "../charts/responses.ts";
import { sensitivityFrame } from "../charts/sensitivities.ts";
import type { PlotGrid } from "../plot/grid.ts";
import { commonLimits } from "../words/limits.ts";

/** `selected`: the entry whose linearised response is drawn too where there are many. */
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
  plots.show("sensitivities", frequency ? sensitivityFrame(drawn, limits, request) : null);
}
