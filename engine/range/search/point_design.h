// One point of a range for the searches: its plants, the limits over frequency, and its own optimum.
#pragma once

#include <optional>
#include <vector>

#include "engine/expected.h"
#include "engine/range/model/range_model.h"
#include "engine/range/problem.h"
#include "engine/tuning/robust/cost.h"
#include "engine/tuning/robust/sweep/sweep.h"

namespace tunewright::range {

/// The rules that all points share.
struct DesignRules {
    bool pid = true;
    robust::FilterRule filter;
    PeakLimits limits;
    double sign = 1;          ///< of Kp
    bool integrated = false;  ///< use Ti/Kp in place of the IAE, even if a response could be simulated
};

/// Neither copied nor moved, because the design problem refers to it.
class PointDesign {
public:
    PointDesign(PointModel model, const DesignRules& rules);
    PointDesign(const PointDesign&) = delete;
    PointDesign& operator=(const PointDesign&) = delete;

    double at() const { return model_.at; }
    const PointModel& model() const { return model_; }
    const robust::DesignProblem& problem() const { return problem_; }
    const robust::Sweep& sweep() const { return *sweep_; }

    /// Finds the design with the least IAE here that keeps the limits on every member. `before`: the optimum of a
    /// neighbour, where the search starts. The limits also hold inside regions of uncertainty. Errors: as
    /// robust::verified_search.
    std::optional<Error> find_optimum(const RunControl& control, const robust::DesignPoint* before);

    /// The start of searches: for a PI that is better than any PID it has the least Td, and then the limits need not
    /// hold.
    const robust::DesignPoint& optimum() const { return optimum_; }
    /// The optimum itself: ln Td is -infinity if it is a PI.
    robust::DesignPoint own_design() const;
    bool optimum_is_PI() const { return optimum_is_PI_; }
    double optimum_log_cost() const { return optimum_log_cost_; }

    /// ln of IAE over that of the own optimum; infinite if it does not settle. The loop must be stable.
    double log_cost_ratio(const robust::DesignPoint& x, double tolerance) const;
    double log_cost_ratio(const robust::EvaluatedDesign& design) const { return design.log_cost() - optimum_log_cost_; }
    /// The simulations of a cost, from which its gradient follows.
    robust::EvaluatedDesign evaluated(const robust::DesignPoint& x, double tolerance) const {
        return {problem_, x, tolerance};
    }

    /// The largest relative excess over a limit, on grids that the searches do not use; infinite if the loop is
    /// unstable.
    double excess(const robust::DesignPoint& x) const;

    /// Adds the plants inside the region of uncertainty on which x exceeds a limit: true if there are any.
    bool add_worst_inside(const robust::DesignPoint& x, const std::stop_token& stop);
    /// The same for the members that were set aside.
    bool take_back_exceeded(const robust::DesignPoint& x);

    /// Members that are far from every limit at the optimum: the searches omit them, evaluations do not.
    const std::vector<LinearPlant>& set_aside() const { return set_aside_; }

private:
    void pose();
    void look_about(double reference);
    void keep_active_members();

    PointModel model_;
    std::vector<LinearPlant> set_aside_;
    robust::DesignProblem problem_;
    std::optional<robust::Sweep> sweep_;
    robust::DesignPoint optimum_{};
    bool optimum_is_PI_ = false;  // true although a PID was requested
    double optimum_log_cost_ = 0;
};

}  // namespace tunewright::range
