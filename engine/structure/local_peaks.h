// Local maxima over frequency of several functions that are computed together.
#pragma once

#include <functional>
#include <vector>

#include "engine/structure/limited_search.h"

namespace tunewright::structure {

/// ln of each function over its limit at one frequency.
using ExcessAt = std::function<void(double omega, std::vector<double>& excess)>;

/// On `omega`, ascending, and between: each maximum above `least` is refined to 1e-9 of ln.
std::vector<LimitedPeak> local_peaks(const std::vector<double>& omega, const ExcessAt& excess_at, double least);

/// `per_decade` frequencies a decade.
std::vector<double> logarithmic(double low, double high, int per_decade);

}  // namespace tunewright::structure
