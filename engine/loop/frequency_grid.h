// Frequencies at which a loop is looked at: chosen by the loop itself.
#pragma once

#include <functional>
#include <vector>

#include "engine/loop/loop.h"

namespace tunewright {

struct LoopGrid {
    std::vector<double> omega;
    std::vector<LoopPoint> point;  ///< the loop at each omega
    double resolved_to = 0;  ///< above it the dead time turns L faster than the grid follows; |L| is still followed
};

/// A logarithmic grid from far below to far above every corner of plant, controller and filter, refined until
/// neighbours of S differ by less than `step` (absolute, or relative where |S| > 1). `density` is the number of points
/// a decade to start with.
LoopGrid make_loop_grid(const Loop& loop, double step = 0.15, int density = 24);

/// The same refinement of any loop's points from given frequencies (ascending, at least two) up to `resolved_to`.
LoopGrid refined_grid(const std::function<LoopPoint(double)>& at, const std::vector<double>& base, double resolved_to,
                      double step);

}  // namespace tunewright
