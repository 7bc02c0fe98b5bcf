// The front of load IAE against robustness: one plant's robust designs under several limits, each searched from its
// neighbour.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "engine/tuning/robust/robust.h"

namespace tunewright {

/// Robust designs of one plant that differ in their limit on Ms alone. A new one is searched from between its nearest
/// neighbours; where that breaks the front's order (more room never costs more) the whole search is made.
class ParetoFront {
public:
    /// Whose limits they are: the options but for Ms and Mt, which is M as well where `Mt` is empty, and the plants on
    /// which they hold.
    struct FrontLimits {
        RobustOptions options = {};
        std::optional<double> Mt = {};
        bool on_family = false;  ///< of the problem; false: on the nominal plant alone
    };

    /// The default PID's, Ms = Mt = M, on the nominal plant. `problem` must outlive this.
    explicit ParetoFront(const TuningProblem& problem);
    ParetoFront(const TuningProblem& problem, FrontLimits terms);

    struct Design {
        IdealPid controller;
        double load_IAE = 0;  ///< of a unit step, to infinity; the search's own, to about 1e-4
        std::vector<Warning> warnings = {};
        std::optional<robust::Curvature> curvature = {};  ///< that the search saw
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
    std::optional<Expected<std::vector<LinearPlant>>> others_;  // that the limits hold on too; made when first needed
    std::map<double, Expected<Design>> known_;
};

}  // namespace tunewright
