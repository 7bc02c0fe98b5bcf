// The trade-off between robustness and speed as a curve: the least load IAE for each limit on Ms.
#pragma once

#include <optional>
#include <vector>

#include "engine/plant/analysed_plant.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/robust/filter_rule.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright {

/// Limits on Ms, evenly spaced between the two ends.
struct FrontierRange {
    double from = 1.1, to = 2.5;  ///< in (1, 4], from < to
    int points = 30;              ///< number of limits, 2 to 200
};

struct FrontierOptions {
    ControllerKind controller = ControllerKind::PID;  ///< PI or PID
    FrontierRange Ms = {};
    std::optional<double> Mt = {};     ///< limit on Mt at every point; empty: equal to that on Ms
    double take = limits::kDefaultMs;  ///< limit of the point that is the method's controller
    RobustFilterOptions filter = {};
};

/// One robust design and its figures for unit steps.
struct FrontierPoint {
    double Ms = 0;  ///< the limit
    IdealPid controller;
    Figure load_IAE, setpoint_IAE, overshoot_percent, Mks, TV;  ///< TV: total variation of u after a set-point step
    Figure achieved_Ms, achieved_Mt;
};

/// Ascending in Ms; limits that no controller meets are omitted.
struct Frontier : MethodReport {
    std::vector<FrontierPoint> points;
    std::optional<double> infeasible_below;  ///< the lowest feasible limit, if a lower one was requested
    double compute_ms = 0;
};

/// Every point is the design of the method robust with its limit, searched from its neighbour and verified like any
/// other; the load IAE falls as the limit rises. The set-point weight is chosen for an overshoot of at most
/// limits::kDefaultMaxOvershootPercent. Limits hold on all plants of the problem, figures are the nominal plant's.
/// Errors: those of the method robust if no point is feasible; cancelled.
Expected<Frontier> frontier(const TuningProblem& tuning, const FrontierOptions& options, const RunControl& control);

/// For a plant as given in a request. Error: unsupported for measured points, which have no response over time.
Expected<Frontier> frontier(const AnalysedPlant& subject, const FrontierOptions& options, const RunControl& control);

/// The options under their names.
const OptionSet<FrontierOptions>& frontier_options();

TuningMethod frontier_method();

}  // namespace tunewright
