// How much the loop and its output move, and what a controller could do about it.
#pragma once

#include "engine/check/loop_check.h"
#include "engine/check/samples.h"

namespace tunewright::check {

PerformanceFigures performance_of(const Samples& samples, const std::array<double, 2>& u_range,
                                  const LoopQuestion& question);

}  // namespace tunewright::check
