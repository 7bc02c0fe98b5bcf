// The check of one or many loops, with the judgement of all together.
#pragma once

#include <optional>
#include <vector>

#include "engine/check/loop_check.h"
#include "engine/check/together/plant_check.h"
#include "engine/progress.h"
#include "engine/request/check/cure.h"

namespace tunewright {

struct CheckQuestion {
    std::vector<check::LoopQuestion> loops;
    bool cluster = true;    ///< look for loops that oscillate together
    bool settings = false;  ///< look for new settings where tuning or a valve is the cause: some seconds a loop
};

struct CheckedLoop : check::LoopCheck {
    std::optional<LoopCure> cure;  ///< where tuning or a valve is the cause, if settings are asked for
};

struct CheckResult {
    std::vector<CheckedLoop> loops;  ///< in the order of the question
    check::PlantCheck plant;
    bool partial = false;  ///< stopped: the loops that were not reached are insufficient_data
};

/// The judgement of all loops together, which may change the cause of one that another explains.
check::PlantCheck judged_together(std::vector<CheckedLoop>& loops, bool cluster);

/// A loop whose question is at fault is answered as one that could not be read. Error: a stop before the first loop.
Expected<CheckResult> ask_check(const CheckQuestion& question, const RunControl& control);

}  // namespace tunewright
