// The further plants of a robust design, and the plants between them on which a limit is exceeded.
#pragma once

#include <stop_token>
#include <vector>

#include "engine/expected.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/robust/design.h"

namespace tunewright::robust {

/// Members of the tuning problem's family other than the nominal plant. Error: no_feasible_controller if they need
/// gains of both signs; `sign_of` gives a plant's sign.
Expected<std::vector<LinearPlant>> other_members(const TuningProblem& tuning, double (*sign_of)(const LinearPlant&));

/// Density of the frequency grid, as make_loop_grid's.
struct GridFineness {
    double step = 0.15;
    int density = 24;
};

/// The largest relative excess of the loop at x over a limit on one plant; infinite if it is unstable.
double excess_on(const LinearPlant& plant, const DesignProblem& problem, const DesignPoint& x,
                 const GridFineness& fineness);

/// The largest on the problem's plants, on a grid that no search sees, or on its measured points.
double worst_excess(const DesignProblem& problem, const DesignPoint& x);

/// For each region of the family, the plant inside on which the design at x exceeds a limit most, if by more than 5e-5:
/// a local search from the worst of 128 points and the ends (find_worst_case). Empty: the limits hold.
std::vector<LinearPlant> worst_inside(const PlantFamily& family, const DesignProblem& problem, const DesignPoint& x,
                                      const std::stop_token& stop);

}  // namespace tunewright::robust
