// Robust design: the least IAE of a load step under limits on Ms and Mt (Garpinger and Hagglund 2008).

#pragma once

#include <map>
#include <optional>
#include <vector>

#include "engine/tuning/method/report.h"
#include "engine/tuning/method/rule.h"
#include "engine/tuning/robust/design.h"

namespace tunewright {

/// Filter of the measurement, second order: Tf, or a fraction of Td; neither: the plant decides.
struct RobustFilterOptions {
    std::optional<double> Tf = {}, Tf_over_Td = {};
};

struct RobustOptions {
    ControllerKind controller = ControllerKind::PID;  ///< PI or PID
    double Ms = 1.4, Mt = 1.4;                        ///< limits, in (1, 4]
    std::optional<double> Mks = {};                   ///< limit on max |C S|
    robust::Constraint constraint = robust::Constraint::circles;
    robust::Objective objective = robust::Objective::load_iae;
    double rho = 0.5;  ///< weight of the load in the weighted objective
    robust::SearchKind search = robust::SearchKind::fast;
    bool surface = false;  ///< also return the cost over the (Ti, Td) plane
    RobustFilterOptions filter = {};
};

/// The design on the ideal law.
Expected<TunedController> tune_robust(const TuningProblem& tuning, const RobustOptions& options,
                                      const RunControl& control);

TuningMethod robust_method();

/// The method's default PID on one plant under several limits, Ms = Mt = M: the front of load IAE against robustness. A
/// new point is searched from its nearest neighbour; where that breaks the front's order (more room never costs more)
/// the whole search is made.
class RobustFront {
public:
    /// `problem` must outlive this. Its family is not looked at: limits hold on the nominal plant.
    explicit RobustFront(const TuningProblem& problem) : problem_(problem) {}

    struct Design {
        IdealPid controller;
        double load_IAE = 0;  ///< of a unit step, to infinity; the search's own, to about 1e-4
    };
    /// M in (1, 4]. Errors: those of the method robust; cancelled if it was stopped before the search ended.
    Expected<Design> at(double M, const RunControl& control);

private:
    bool in_order(double M, double load_IAE) const;

    const TuningProblem& problem_;
    std::map<double, Expected<Design>> known_;
};

/// The method's report with `surface`: the least cost over Kp; cost[i][j] belongs to Ti[i] (time) and Td[j] (time).
/// Empty: no Kp keeps the limits.
struct CostSurface : MethodReport {
    std::vector<double> Ti, Td;
    std::vector<std::vector<std::optional<double>>> cost;
};

}  // namespace tunewright
