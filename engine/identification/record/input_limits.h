// A controller output that was logged before its limiter: what reaches the plant is what lies inside.
#pragma once

#include <array>
#include <vector>

#include "engine/identification/record/record.h"

namespace tunewright {

using InputLimits = std::array<double, 2>;

/// The usual ends (0 to 1, 0 to 100, -100 to 100, 0 to 255, -255 to 255, 0 to 1023, 0 to 4095) that a record's u runs
/// beyond by a twentieth of their span and more, in 2 % of the rows and more, while a tenth of the rows lies inside.
std::vector<InputLimits> plain_limits(const Record& record);

}  // namespace tunewright
