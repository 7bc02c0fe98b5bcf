// For what share of the time a loop was controlled, held, or at a limit.
#pragma once

#include <array>
#include <vector>

#include "engine/check/loop_check.h"
#include "engine/check/output_range.h"
#include "engine/check/samples.h"

namespace tunewright::check {

/// 1 for each sample whose output rests for long, away from its limits: nobody controls there.
std::vector<char> held_output(const Samples& samples, const OutputRange& range, double u_step, const LoopLaw& law);

/// Shares of the samples with the output at its lower and at its upper limit.
std::array<double, 2> limit_shares(const Samples& samples, const OutputRange& range);

/// `u_step`: the grid of the output (RecordQuality::u_step).
ServiceShares service_of(const Samples& samples, const OutputRange& range, double u_step, const LoopLaw& law);

}  // namespace tunewright::check
