// The test that tells a plant where its record in operation does not.
#pragma once

#include <string>

#include "engine/check/loop_check.h"

namespace tunewright {

/// Steps up and down by `size`, each held for `hold`.
struct TestPlan {
    enum class Kind { set_point_steps, output_steps };
    Kind kind = Kind::set_point_steps;
    double size = 0;  ///< y or u
    int steps = 0;
    double hold = 0;           ///< time
    double duration = 0;       ///< time
    bool beyond_seen = false;  ///< true: the size is more than the record's own range, and needs the operator's consent
    std::string detail;        ///< one sentence
};

/// Steps of the set point in automatic, or of the output where nobody controls: so large that the plant's gain has a
/// standard error of a tenth with the noise and the load that the record shows.
TestPlan plan_test(const check::LoopCheck& check);

}  // namespace tunewright
