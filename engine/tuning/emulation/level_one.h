// The first level: classical settings from tests simulated on the nonlinear plant and from its linearisation, and the
// bounds that follow from them (Eq. 3).

#pragma once

#include <vector>

#include "engine/tuning/emulation/emulation_problem.h"
#include "engine/tuning/emulation/emulation_report.h"

namespace tunewright::emulation {

/// Settings behind the problem's own derivative filter, or why there are none; without J and runs. Td is 0 where a rule
/// has no derivative.
/// Errors: cancelled.
Expected<std::vector<LevelOneRow>> level_one(const EmulationProblem& problem, const RunControl& control);

/// alpha.low times the smallest of the rows' values to alpha.high times the largest, for what `problem.bounds` leaves
/// open; Kp by size, with the plant's sign. Td ends at a quarter of Ti's end where no row has a derivative, and starts
/// at 0 then. Errors: no_feasible_controller where no row has settings.
Expected<Bounds> search_bounds(const EmulationProblem& problem, const std::vector<LevelOneRow>& rows);

}  // namespace tunewright::emulation
