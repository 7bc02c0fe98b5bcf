// The library of problems with proved bounds (bench/problems/README.md has the format).
#pragma once

#include <vector>

#include "engine/score/score.h"

namespace tunewright::api {

/// All of them, by name; read once.
const std::vector<score::Problem>& problem_library();

}  // namespace tunewright::api
