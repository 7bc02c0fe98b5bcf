// The intermediate result that a search reports.
#pragma once

#include "engine/controller/pid.h"

namespace tunewright {

/// The best feasible design so far.
struct BestSoFar {
    Controller controller;
    double load_IAE = 0;
    double Ms = 0;
    double Mt = 0;
};

}  // namespace tunewright
