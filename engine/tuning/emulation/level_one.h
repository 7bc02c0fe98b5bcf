// The first level: classical settings from tests simulated on the nonlinear plant and from its linearisation, and the
// bounds derived from them (Eq. 3).

#pragma once

#include <vector>

#include "engine/tuning/emulation/emulation_problem.h"
#include "engine/tuning/emulation/emulation_report.h"

namespace tunewright::emulation {

/// Settings with the problem's own derivative filter, or the errors in their place; without J and runs. Td is 0 if a
/// rule has no derivative. Errors: cancelled.
Expected<std::vector<LevelOneRow>> level_one(const EmulationProblem& problem, const RunControl& control);

/// alpha.low times the smallest of the rows' values to alpha.high times the largest, for the parameters without bounds
/// in `problem.bounds`; Kp by size, with the plant's sign. If no row has a derivative, Td ranges from 0 to a quarter of
/// the largest Ti. Error: no_feasible_controller if no row has settings.
Expected<Bounds> search_bounds(const EmulationProblem& problem, const std::vector<LevelOneRow>& rows);

}  // namespace tunewright::emulation
