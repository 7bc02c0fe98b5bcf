#include "engine/check/change.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

namespace tunewright::check {

Change change_of(const LoopCheck& before, const LoopCheck& now) {
    Change change{.before = before.cause.verdict, .now = now.cause.verdict};
    const PerformanceFigures &old = before.performance, &young = now.performance;
    if (!(old.variability > 0 && young.variability > 0)) {
        change.variability_ratio = change.likelihood = no_figure("One of the two records has no error that varies.");
        return change;
    }
    const double ratio = young.variability / old.variability;
    change.variability_ratio = ratio;
    if (!(old.independent > 2 && young.independent > 2)) {
        change.likelihood = no_figure("The records have too few independent values.");
        return change;
    }
    const boost::math::fisher_f_distribution<double> chance(young.independent - 1, old.independent - 1);
    const double below = boost::math::cdf(chance, ratio * ratio);
    change.likelihood = std::min(1.0, 2 * std::min(below, 1 - below));
    change.significant = *change.likelihood < kByChance;
    return change;
}

}  // namespace tunewright::check
