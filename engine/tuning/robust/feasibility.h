// Whether a robust design exists: the least that Ms and Mt can be together, whether its optimum has an end,
// and the sentence where there is none.
#pragma once

#include <optional>

#include "engine/expected.h"
#include "engine/tuning/robust/design.h"

namespace tunewright::robust {

/// The controller whose larger peak of |S| and |T| is smallest.
struct MinPeak {
    double M = 0;  ///< that peak, to about 0.1 %, of loops whose Ti is no longer than a design would use
    DesignPoint x{};
    double reference = 0;  ///< where its loop was looked for, rad/time
};

/// Looks about the problem's reference and about the slower ones (slower_references()). Empty if no controller was
/// found that stabilises the plant. Limits play no part but in these, the filter rule does.
std::optional<MinPeak> min_common_peak(const DesignProblem& problem);

/// True where the gain is unbounded within the limits: no dead time, no right-half-plane zero, and a design of the
/// plant's high-frequency asymptote that scales with frequency exists (Tf tied to Td, no filter, or a filter that
/// leaves a pole excess of one).
bool has_no_finite_optimum(const DesignProblem& problem);

/// Why there is no controller. The cure of a no_feasible_controller is the smallest common limit on Ms and Mt that
/// works, to three decimals, where there is one that may be asked for. `min`: of the same problem.
Error why_infeasible(const DesignProblem& problem, const std::optional<MinPeak>& min);

}  // namespace tunewright::robust
