// Evaluates settings at one place, and a schedule over the whole range: their distance from the limits and their cost.
#pragma once

#include <vector>

#include "engine/controller/schedule/schedule.h"
#include "engine/expected.h"
#include "engine/range/schedule/own_optima.h"
#include "engine/range/search/point_designs.h"
#include "engine/tuning/limits.h"

namespace tunewright::range {

struct PointEvaluation {
    double at = 0;
    bool stable = false;
    double Ms = 1, Mt = 0;      ///< the largest over the place's plants; not used where it is not stable
    double excess = 0;          ///< ln of the largest of Ms, Mt, Mks over its limit
    double log_cost_ratio = 0;  ///< ln of IAE over that of the own optimum; infinite where it does not settle
};

/// The settings that may be in use at a place: of `steps` those of both rows within the hysteresis.
std::vector<IdealPid> in_use(const Schedule& schedule, double at);

/// The worst of the settings at a place. `log_own_IAE`: of its own optimum. `all_peaks`: false leaves Ms, Mt and the
/// excess at what is 5 % or more below a limit, which is quicker.
PointEvaluation evaluate_at(const PointDesign& place, const std::vector<IdealPid>& settings, double log_own_IAE,
                            bool all_peaks);

/// The same where the place has not been looked at: its own optimum's IAE is interpolated. Errors: the model's.
Expected<PointEvaluation> evaluate_between(const PointDesigns& places, const OwnOptima& own,
                                           const std::vector<IdealPid>& settings, double at, bool all_peaks);

/// Where the plants or the settings bend, ascending: the points, and the rows within the range. What is largest over
/// the range is largest there or between.
std::vector<double> bends_of(const RangeModel& model, const Schedule& schedule);

struct Verified {
    double excess = -1;          ///< ln of the largest of Ms, Mt, Mks over its limit
    double log_cost_ratio = -1;  ///< the largest ln of IAE over that of the own optimum
    std::vector<double> worst;   ///< places where the cost allowed is exceeded, and limits by more than a little (5e-4)
};

/// At 49 places evenly over the range, where it bends, at nine places between each two bends, and at the tops of the
/// parabolas through those that come near a limit or near `allowed`, the ln of the cost. Errors: the model's.
Expected<Verified> verify(const PointDesigns& places, const OwnOptima& own, const Schedule& schedule, double allowed);

/// x of a controller, as the searches know it.
robust::DesignPoint point_of(const IdealPid& pid);

}  // namespace tunewright::range
