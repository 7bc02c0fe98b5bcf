// How the input enters a nonlinear plant's equations, read off their structure.
#pragma once

#include <optional>
#include <vector>

#include "engine/error.h"
#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

enum class InputDegree { absent, affine, nonlinear };

/// Of each state's equation, by the operations alone: (u + 1)^2 - u^2 counts as nonlinear.
std::vector<InputDegree> input_degrees(const NonlinearSystem& system);

/// Why x' = f(x) + g(x) u does not hold: unsupported, `where` = "plant/equations/T", with the operation and its place.
/// Empty where it holds.
std::optional<Error> not_affine(const NonlinearSystem& system);

}  // namespace tunewright
