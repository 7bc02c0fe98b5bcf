// Evaluates settings at one point, and a schedule over the whole range: distance from the limits and cost.
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
    double Ms = 1, Mt = 0;      ///< the largest over the point's plants; not used if it is unstable
    double excess = 0;          ///< ln of the largest of Ms, Mt, Mks over its limit
    double log_cost_ratio = 0;  ///< ln of IAE over that of the own optimum; infinite if it does not settle
};

/// The settings that may be in use at a value: for `steps` those of both rows within the hysteresis.
std::vector<IdealPid> in_use(const Schedule& schedule, double at);

/// The worst of the settings at a point. `log_own_IAE`: ln of its own optimum's IAE. `all_peaks`: false does not refine
/// peaks that are 5 % or more below a limit, which is faster.
PointEvaluation evaluate_at(const PointDesign& place, const std::vector<IdealPid>& settings, double log_own_IAE,
                            bool all_peaks);

/// The same for a point without its own search: its optimum's IAE is interpolated. Errors: the model's.
Expected<PointEvaluation> evaluate_between(const PointDesigns& places, const OwnOptima& own,
                                           const std::vector<IdealPid>& settings, double at, bool all_peaks);

/// Values at which the plants or the settings have a kink, ascending: the points, and the rows within the range. The
/// maxima over the range are there or between them.
std::vector<double> bends_of(const RangeModel& model, const Schedule& schedule);

struct Verified {
    double excess = -1;          ///< ln of the largest of Ms, Mt, Mks over its limit
    double log_cost_ratio = -1;  ///< the largest ln of IAE over that of the own optimum
    std::vector<double> worst;   ///< points at which the allowed cost is exceeded, or a limit by more than 5e-4
};

/// Evaluates a schedule at 49 points evenly over the range, at its kinks, at nine points between each two kinks, and at
/// the maxima of parabolas near a limit or near `allowed`, the ln of the allowed cost. Errors: the model's.
Expected<Verified> verify(const PointDesigns& places, const OwnOptima& own, const Schedule& schedule, double allowed);

/// A controller as the unknowns of the searches.
robust::DesignPoint point_of(const IdealPid& pid);

}  // namespace tunewright::range
