// The existence of a robust design: the least possible common value of Ms and Mt, if the optimum is finite, and the
// error if there is no design.
#pragma once

#include <optional>

#include "engine/expected.h"
#include "engine/loop/measured_loop.h"
#include "engine/tuning/robust/design.h"

namespace tunewright::robust {

/// The controller whose larger peak of |S| and |T| is smallest.
struct MinPeak {
    double M = 0;  ///< that peak, to about 0.1 %, among loops with a Ti of usual designs
    DesignPoint x{};
    double reference = 0;  ///< frequency around which its loop was found, rad/time
};

/// Searches around the problem's reference and around the slower ones (slower_references()). Empty if no stabilising
/// controller was found. The limits matter only for these references; the filter rule is applied.
std::optional<MinPeak> min_common_peak(const DesignProblem& problem);

/// True if the gain is unbounded within the limits: no dead time, no right-half-plane zero, and a design of the plant's
/// high-frequency asymptote that scales with frequency exists (Tf tied to Td, no filter, or a filter that leaves a pole
/// excess of one).
bool has_no_finite_optimum(const DesignProblem& problem);

/// The reason why there is no controller. The cure of a no_feasible_controller is the smallest common limit on Ms and
/// Mt that works, to three decimals, if it is an allowed value. `min`: of the same problem.
Error why_infeasible(const DesignProblem& problem, const std::optional<MinPeak>& min);

/// True if `test` holds for every loop of the problem: one controller on each plant, or on the measured points; it is
/// called with an Expected<Loop> or an Expected<MeasuredLoop>.
template <class Test>
bool holds_on_every_loop(const DesignProblem& problem, const ParallelPid& gains, Test test) {
    if (problem.measured != nullptr) return test(MeasuredLoop::make(*problem.measured, gains));
    for (std::size_t i = 0; i < problem.plants(); ++i)
        if (!test(Loop::make(problem.plant_at(i), gains))) return false;
    return true;
}

}  // namespace tunewright::robust
