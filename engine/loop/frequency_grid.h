// Frequencies at which a loop is looked at: chosen by the loop itself.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "engine/loop/loop.h"

namespace tunewright {

/// Where a grid starts from: `density` points a decade from far below to far above every corner of plant and
/// controller, or up to `highest`, and more at resonances. `open_loop`: L(j omega), asked at a few frequencies for
/// where its asymptotes cross one. Ascending, at least two.
std::vector<double> base_frequencies(const LinearPlant& plant, const ParallelPid& gains,
                                     const std::function<std::complex<double>(double)>& open_loop, int density,
                                     double highest = std::numeric_limits<double>::infinity());

/// A logarithmic grid from far below to far above every corner of plant, controller and filter, refined until
/// neighbours of S differ by less than `step` (absolute, or relative where |S| > 1). `density` is the number of points
/// a decade to start with. At most 20000 points; a few hundred evaluations of the loop for a plant with lags and a dead
/// time, more for resonances. With dead time its first 60 turns are followed, which is where `resolved_to` ends.
LoopGrid make_loop_grid(const Loop& loop, double step = 0.15, int density = 24);

/// The least |1 + L| on the way from one point to another, from below, where L turns by less than a radian; may be
/// negative, and is NaN where L is infinite. No point of an arc is farther from the nearer end than half the arc's
/// length, which is that of the chord with room for its bend. A bound on |S| by its own change would not do: S is small
/// where |L| is large and near 1 where L is small, with whatever lies between them.
double nearest_between(std::complex<double> from, std::complex<double> to);

/// Up to where neighbours of a grid may differ.
struct Refinement {
    double step;          ///< of S, absolute, or relative where |S| > 1
    double enough_below;  ///< neighbours may differ by more where |S| stays below it on the way; 0: nowhere

    Refinement(double step, double enough_below = 0) : step(step), enough_below(enough_below) {}
};

/// The same refinement of any loop's points, from those of a first grid.
LoopGrid refined_grid(const std::function<LoopPoint(double)>& at, const LoopGrid& base, const Refinement& refinement);

/// From given frequencies (ascending, at least two) up to `resolved_to`.
LoopGrid refined_grid(const std::function<LoopPoint(double)>& at, const std::vector<double>& base, double resolved_to,
                      const Refinement& refinement);

}  // namespace tunewright
