// The loop's curves over frequency, thinned out for drawing.
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/loop/frequency_grid.h"
#include "engine/loop/measured_loop.h"

namespace tunewright {

/// At most about `points` frequencies of the decades that matter: the grid's own, with more where the Nyquist curve
/// bends near the critical point, phase unwrapped on the fine grid.
FrequencyTraces frequency_traces(const Loop& loop, const LoopGrid& grid, int points);

/// The whole measured band.
FrequencyTraces frequency_traces(const MeasuredLoop& loop, int points);

}  // namespace tunewright
