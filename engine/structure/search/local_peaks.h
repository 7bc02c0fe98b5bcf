// Local maxima over frequency of several functions that are computed together.
#pragma once

#include <functional>
#include <vector>

#include "engine/plant/linear/linear_plant.h"
#include "engine/structure/search/limited_search.h"

namespace tunewright::structure {

/// ln of each function over its limit at one frequency.
using ExcessAt = std::function<void(double omega, std::vector<double>& excess)>;

/// On `omega`, ascending, and between: each maximum above `least` is refined by
/// log_maximum().
std::vector<LimitedPeak> local_peaks(const std::vector<double>& omega, const ExcessAt& excess_at, double least);

/// `per_decade` frequencies a decade.
std::vector<double> logarithmic(double low, double high, int per_decade);

/// The same from `below` times the lowest corner of some plants to `above` times the highest; dead times and the whole
/// time of a plant have corners too. About 1 where no plant has any. Between neighbours the largest dead time turns by
/// at most `turn`, rad.
std::vector<double> frequencies_around(const std::vector<const LinearPlant*>& plants, double below, double above,
                                       int per_decade, double turn);

}  // namespace tunewright::structure
