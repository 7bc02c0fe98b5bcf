// The largest difference between a figure of an answer and the same figure computed a second way (docs/numerics.md).
#pragma once

#include <optional>
#include <string_view>

#include "engine/evaluation/evaluation.h"

namespace tunewright::verify {

/// Relative, by the name of the figure in `Robustness` and `Performance`; that of an index is its error as the answer
/// states it, at least 1e-6, plus the second way's own. Empty for a name that is no figure.
std::optional<double> largest_difference(std::string_view figure, const IndexErrors& stated);

/// |given - found| relative to `given`. Overshoots are compared as the largest y over r, so that one of rounding is 0;
/// numbers that are both smaller than rounding agree.
double difference(std::string_view figure, double given, double found);

}  // namespace tunewright::verify
