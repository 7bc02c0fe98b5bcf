// One robust setting for a whole range, and its cost at each point.
#pragma once

#include <vector>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/range/problem.h"
#include "engine/range/search/point_designs.h"

namespace tunewright::range {

/// A setting at a place of the range. IAE: of a unit load step, in y time per u; for a point known only by its
/// frequency response Ti/Kp (the integrated error), for both controllers.
struct PointCost {
    double at = 0;
    IdealPid own;  ///< the point's own optimum with the same limits
    double own_IAE = 0;
    Figure IAE;           ///< of the setting; empty: the loop is unstable, or does not settle
    Figure relative_IAE;  ///< over own_IAE, about 1 or more
    Figure Ms, Mt;        ///< the largest over the point's plants; empty: the loop is unstable on one of them
};

struct OneSetting {
    IdealPid controller;
    double worst_relative_IAE = 0;  ///< the largest at a point
    double mean_relative_IAE = 0;   ///< over the points
    double worst_at = 0;            ///< the point with the largest cost
    std::vector<PointCost> points;
    bool partial = false;  ///< stopped early: the best setting so far that keeps the limits
};

/// The setting that keeps the limits at every point, with the least worst or mean IAE over that of each point's own
/// optimum (problem.h). Searched by search_jointly from the least integrated error and from the best of the own optima.
/// Errors: those of PointDesigns::at, of robust::verified_search for all plants together (no_feasible_controller names
/// the smallest limit that works); numerical_failure where no result of a search keeps the limits on an independent
/// grid.
Expected<OneSetting> design_one_setting(PointDesigns& places, const std::vector<double>& points,
                                        const RangeOptions& options);

/// The ideal controller at x with the options' set-point weight.
IdealPid setting_at(const DesignRules& rules, const robust::DesignPoint& x, double b);

/// A setting at one point: with an accurate simulation, and peaks refined on every plant of the point.
PointCost cost_at(const PointDesign& place, const IdealPid& controller);

}  // namespace tunewright::range
