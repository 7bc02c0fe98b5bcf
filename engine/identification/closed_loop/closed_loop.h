// Identification from records of closed loops, in which a controller moves u in response to y.
#pragma once

#include "engine/expected.h"
#include "engine/identification/closed_loop/loop_record.h"
#include "engine/identification/identify.h"
#include "engine/progress.h"

namespace tunewright {

/// 1. Search the structure with the recorded u, and with only the set point's part of u.
/// 2. Refine both results by instrumental variables (instrument_fit.h); keep the one whose residual the set point
///    explains less.
/// 3. If the loop was switched on once, the standard errors are at least those of least squares.
///
/// Errors: not_identifiable if only feedback moves u, if the other moves are too small to determine the gain within
/// half of its size, or if the recognised controller would be unstable with the resulting gain; cancelled.
Expected<IdentifiedModel> identify_in_loop(const CleanRecord& record, const LoopRecord& loop, ModelChoice model,
                                           const RunControl& control);

/// For records without found feedback: warns (closed-loop) if u moves irregularly and filters of y explain more of u
/// than the model explains of y, and the model is doubtful (its gain is unknown) or u clearly moves unlike any test.
/// This happens in loops whose controller reads noise that the record does not contain.
void doubt_open_loop(const CleanRecord& record, IdentifiedModel& model);

/// Fills data_quality.closed_loop and adds warning closed-loop.
void report_loop(const LoopRecord& loop, IdentifiedModel& model);

}  // namespace tunewright
