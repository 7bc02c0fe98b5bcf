// How the measurement follows moves of the set point: the mean response to all of them.
#pragma once

#include <optional>

#include "engine/check/samples.h"

namespace tunewright::check {

struct SetPointResponse {
    int moves = 0;         ///< that are averaged
    double dead_time = 0;  ///< until a twentieth of the move, time
    double rise = 0;       ///< from there to 63 % of the move, time
    double noise = 0;      ///< standard deviation of the mean response, of the move
};

/// Moves that stand alone: nothing for as long before and after as is looked at. A move is more than four times the
/// noise of the measurement. Empty: there is none, or the response does not come that far.
std::optional<SetPointResponse> set_point_response(const Samples& samples);

}  // namespace tunewright::check
