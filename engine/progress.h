// How long work reports and how it is stopped. The engine has no clock and no threads: both come from outside.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "engine/controller/pid.h"

namespace tunewright {

/// The best feasible design so far.
struct BestSoFar {
    Controller controller;
    double load_IAE = 0;
    double Ms = 0;
    double Mt = 0;
};

struct Progress {
    double fraction = 0;  ///< 0 to 1, never falls within a job
    std::string stage;    ///< one word for programs: "identify", "tune", "evaluate"
    std::string message;  ///< one sentence for people
    std::optional<BestSoFar> best;
};

struct RunControl {
    std::stop_token stop;                           ///< asked between steps of every search
    std::function<void(const Progress&)> progress;  ///< may be empty; called from the working thread
    std::function<double()> now_ms;                 ///< a monotonic clock for `compute_ms`; may be empty (then 0)
};

}  // namespace tunewright
