// How much the loop and its output move, and what a controller could do about it.
#pragma once

#include "engine/check/output_range.h"

namespace tunewright::check {

/// Of a record without usable rows.
PerformanceFigures no_performance(const std::string& why);

PerformanceFigures performance_of(const Samples& samples, const OutputRange& u_range, const LoopQuestion& question);

}  // namespace tunewright::check
