// The front of load IAE against robustness: robust designs of one plant with different limits, each searched from its
// neighbour.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "engine/tuning/robust/robust.h"

namespace tunewright {

/// Robust designs of one plant that differ only in their limit on Ms. A new one is searched from between its nearest
/// neighbours; if the result breaks the front's order (a wider limit never costs more), the full search is made.
class ParetoFront {
public:
    /// The other parameters of the designs: all options except Ms and Mt (if `Mt` is empty, Mt is M as well), and the
    /// plants on which the limits hold.
    struct FrontLimits {
        RobustOptions options = {};
        std::optional<double> Mt = {};
        bool on_family = false;  ///< true: on the family of the problem; false: on the nominal plant only
    };

    /// The default PID's, Ms = Mt = M, on the nominal plant. `problem` must outlive this.
    explicit ParetoFront(const TuningProblem& problem);
    ParetoFront(const TuningProblem& problem, FrontLimits terms);

    struct Design {
        IdealPid controller;
        double load_IAE = 0;  ///< for a unit step, to infinity; the search's own value, with an error of about 1e-4
        std::vector<Warning> warnings = {};
        std::optional<robust::Curvature> curvature = {};  ///< the curvature that the search found
    };
    /// M in (1, 4]. Errors: those of the method robust; cancelled if it was stopped before the search ended.
    Expected<Design> at(double M, const RunControl& control);

private:
    bool in_order(double M, double load_IAE) const;
    std::optional<robust::DesignResult> expected_at(double M) const;
    robust::DesignPoint point_of(const Design& design) const;
    Expected<robust::DesignResult> searched(const RobustOptions& limits, const robust::DesignResult* before,
                                            const RunControl& control, Design& design);

    const TuningProblem& problem_;
    FrontLimits terms_;
    std::optional<Expected<std::vector<LinearPlant>>> others_;  // plants on which the limits hold too; made at the
                                                                // first use
    std::map<double, Expected<Design>> known_;
};

}  // namespace tunewright
