// Records of closed loops: what may be learned of the plant where a controller moves u in answer to y.
#pragma once

#include "engine/expected.h"
#include "engine/identification/closed_loop/loop_record.h"
#include "engine/identification/identify.h"
#include "engine/progress.h"

namespace tunewright {

/// 1. The structure is searched for with the recorded u, and with the set point's part of u alone.
/// 2. Both ends are refined by instrumental variables (instrument_fit.h), and the one stays whose residual the set
/// point
///    explains less.
/// 3. Where the loop was switched on once, the standard errors are at least those of least squares.
///
/// Errors:
/// not_identifiable where nothing but feedback moves u, or too little to know the gain within a half of itself, or
/// where the gain that comes out is of the sign with which that controller drives its plant away; cancelled.
Expected<IdentifiedModel> identify_in_loop(const CleanRecord& record, const LoopRecord& loop, ModelChoice model,
                                           const RunControl& control);

/// Where no feedback was found: warns (closed-loop) if u is restless, and filters of y explain more of u than the model
/// explains of y, while the model is in doubt (its gain unknown) or u plainly moves as no test does. So it is in loops
/// whose controller sees another noise than the record shows.
void doubt_open_loop(const CleanRecord& record, IdentifiedModel& model);

/// Fills data_quality.closed_loop and adds warning closed-loop.
void report_loop(const LoopRecord& loop, IdentifiedModel& model);

}  // namespace tunewright
