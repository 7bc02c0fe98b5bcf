// The check of one or many loops, with the judgement of all together.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/check/loop_check.h"
#include "engine/check/plant_check.h"
#include "engine/progress.h"

namespace tunewright {

struct CheckQuestion {
    std::vector<check::LoopQuestion> loops;
    bool cluster = true;  ///< look for loops that oscillate together
};

struct CheckResult {
    std::vector<check::LoopCheck> loops;  ///< in the order of the question
    check::PlantCheck plant;
    bool partial = false;  ///< stopped: the loops that were not reached are insufficient_data
};

/// Errors: those of check_loop(), with the loop's place before `where`; a stop before the first loop.
Expected<CheckResult> ask_check(const CheckQuestion& question, const RunControl& control);

}  // namespace tunewright
