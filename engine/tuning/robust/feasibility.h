// When no controller meets the limits: how far from feasible, and when the optimum has no end.
#pragma once

#include <optional>

#include "engine/tuning/robust/sweep.h"

namespace tunewright::robust {

/// The controller whose larger peak of |S| and |T| is smallest.
struct LeastPeak {
    double M = 0;  ///< that peak, to about 0.1 %
    DesignPoint x{};
};

/// Empty if no controller was found that stabilises the plant. Limits play no part, the filter rule does.
std::optional<LeastPeak> least_common_peak(const DesignProblem& problem);

/// `x` moved within the problem's limits, if that succeeds with a stable loop.
std::optional<DesignPoint> feasible_near(const Sweep& sweep, const DesignPoint& x);

/// True where the gain is unbounded within the limits: no dead time, no right-half-plane zero, and a design of the
/// plant's high-frequency asymptote that scales with frequency exists (Tf tied to Td, no filter, or a filter that
/// leaves a pole excess of one).
bool has_no_finite_optimum(const DesignProblem& problem);

}  // namespace tunewright::robust
