// Frequencies at which a loop is evaluated, adapted to the loop.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "engine/loop/loop.h"

namespace tunewright {

/// The frequencies from which a grid starts: `density` points a decade from far below to far above every corner of
/// plant and controller, or up to `highest`, and more at resonances. `open_loop`: L(j omega), evaluated at a few
/// frequencies to find where its asymptotes cross one. Ascending, at least two.
std::vector<double> base_frequencies(const LinearPlant& plant, const ParallelPid& gains,
                                     const std::function<std::complex<double>(double)>& open_loop, int density,
                                     double highest = std::numeric_limits<double>::infinity());

/// A logarithmic grid from far below to far above every corner of plant, controller and filter, refined until
/// neighbours of S differ by less than `step` (absolute, or relative where |S| > 1). `density` is the number of points
/// a decade to start with. At most 20000 points; a few hundred evaluations of the loop for a plant with lags and a dead
/// time, more for resonances. With dead time its first 60 turns are resolved, up to `resolved_to`.
LoopGrid make_loop_grid(const Loop& loop, double step = 0.15, int density = 24);

/// A lower bound of |1 + L| between two points, for L that turns by less than a radian; may be negative, and is NaN if
/// L is infinite. No point of an arc is farther from the nearer end than half the arc's length, which is estimated by
/// the chord and a factor for its curvature. The change of S between the points would give no bound on |S|: S is small
/// where |L| is large and near 1 where L is small, and may have any value in between.
double nearest_between(std::complex<double> from, std::complex<double> to);

/// The largest allowed differences between neighbours of a grid.
struct Refinement {
    double step;          ///< of S, absolute, or relative where |S| > 1
    double enough_below;  ///< |S| below which neighbours may differ by more; 0: never

    Refinement(double step, double enough_below = 0) : step(step), enough_below(enough_below) {}
};

/// The same refinement for the points of any loop, starting from a first grid.
LoopGrid refined_grid(const std::function<LoopPoint(double)>& at, const LoopGrid& base, const Refinement& refinement);

/// Starting from given frequencies (ascending, at least two), up to `resolved_to`.
LoopGrid refined_grid(const std::function<LoopPoint(double)>& at, const std::vector<double>& base, double resolved_to,
                      const Refinement& refinement);

}  // namespace tunewright
