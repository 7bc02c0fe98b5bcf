// The trade between robustness and speed as a curve: the least load IAE under each limit on Ms.
#pragma once

#include <optional>
#include <vector>

#include "engine/plant/analysed_plant.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/robust/filter_rule.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright {

/// Limits on Ms, evenly spaced from one end to the other.
struct FrontierRange {
    double from = 1.1, to = 2.5;  ///< in (1, 4], from < to
    int points = 30;              ///< 2 to 200
};

struct FrontierOptions {
    ControllerKind controller = ControllerKind::PID;  ///< PI or PID
    FrontierRange Ms = {};
    std::optional<double> Mt = {};     ///< limit on Mt at every point; empty: tied to that on Ms
    double take = limits::kDefaultMs;  ///< the method's own controller is the point whose limit is nearest
    RobustFilterOptions filter = {};
};

/// One robust design and what it does with unit steps.
struct FrontierPoint {
    double Ms = 0;  ///< the limit
    IdealPid controller;
    Figure load_IAE, setpoint_IAE, overshoot_percent, Mks, TV;  ///< TV: of u after a set-point step
    Figure achieved_Ms, achieved_Mt;
};

/// Ascending in Ms; limits that no controller meets are left out.
struct Frontier : MethodReport {
    std::vector<FrontierPoint> points;
    std::optional<double> infeasible_below;  ///< the lowest limit that is met, where a lower one was asked for
    double compute_ms = 0;
};

/// Every point is the design of the method robust under its limit, searched from its neighbour and checked as any; the
/// load IAE falls as the limit rises. The set point is weighed for an overshoot of at most
/// limits::kDefaultMaxOvershootPercent. Limits hold on all plants of the problem, figures are the nominal plant's.
/// Errors: those of the method robust, where no point is feasible; cancelled.
Expected<Frontier> frontier(const TuningProblem& tuning, const FrontierOptions& options, const RunControl& control);

/// On a plant as requests give it. Error: unsupported for measured points, which have no response over time.
Expected<Frontier> frontier(const AnalysedPlant& subject, const FrontierOptions& options, const RunControl& control);

/// The options under their names.
const OptionSet<FrontierOptions>& frontier_options();

TuningMethod frontier_method();

}  // namespace tunewright
