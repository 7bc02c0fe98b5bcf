// How far a simple model's step response lies from a plant's: the integral that reductions by least error minimise.
#pragma once

#include <optional>
#include <vector>

#include "engine/reduction/reduction.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright {

/// The plant's response to a unit step, kept to be compared with many models.
class StepDifference {
public:
    /// The plant: stable or with one integrator, no other undamped mode. `horizon` > 0 ends the integrals, dead time
    /// included; without it they run until both responses have settled, to infinity within 1e-6.
    StepDifference(const LinearPlant& plant, std::optional<double> horizon);

    /// Integrals over |y - y_model|, its square, and itself times t, from the step on. The model: first order or with
    /// one integrator (and lag) as the plant, T1 > 0 or 0, L >= 0. Relative accuracy about 1e-6 of the plant's change
    /// times its time scale.
    ErrorIntegrals to(const ReducedModel& model) const;
    double absolute(const ReducedModel& model) const;  ///< the IAE alone, which is quicker

    /// What the plant has moved by the end.
    double moved() const { return trace_.back().y; }

private:
    struct TracePoint {
        double t = 0, y = 0, slope = 0;
    };
    static TracePoint at_rest(const LinearPlant& plant, double t);
    TracePoint plant_at(size_t next, double t) const;
    std::vector<double> model_times(const ReducedModel& model) const;
    std::vector<ResponseNode> nodes(const ReducedModel& model) const;

    std::vector<TracePoint> trace_;  // two points of equal t are the values before and after a jump of y or its slope
    bool ends_at_horizon_ = false;
};

}  // namespace tunewright
