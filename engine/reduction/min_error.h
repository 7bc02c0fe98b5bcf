// Reduction by the least integrated difference of step responses, and that difference itself.
#pragma once

#include <optional>
#include <vector>

#include "engine/reduction/reduction.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright {

/// The first-order model with the least integral of |y - y_model| (min_iae), its square (min_ise) or itself times t
/// (min_itae) after a unit step, dead time included. Without request.horizon the integral runs to infinity: K is the
/// static gain, T and L are free. With it all three are free and the integral ends there, as in Jin & Son's reductions.
///
/// Integrating plants: K is the slope of their ramp. Without a horizon the integral is finite only for L + T =
/// ramp_delay(): this determines the first-order model (T = 0), and leaves T free for second order. With a horizon, L
/// (and T) are free.
///
/// Found by a simplex and a subspace search from the models by two points and by tangent, over L and ln T; the integral
/// is within 1e-5 of the least found from any start. Stable plants are reduced to first order, whatever order is
/// requested. Warns if the response is not essentially monotone, or if T exceeds the horizon.
///
/// Errors (the message is only the reason, which reduce() puts into its sentence): unsupported if a ramp leads the
/// step; invalid_argument, `where` "reduction/horizon", if nothing has moved by the horizon. Source: Jin & Son, Studies
/// in Informatics and Control 28 (2019), Section 5.
Expected<ReducedModel> min_error(const LinearPlant& plant, const ReductionRequest& request);

/// The plant's response to a unit step, stored for comparison with many models.
class StepDifference {
public:
    /// The plant: stable or with one integrator, no other undamped mode. `horizon` > 0 ends the integrals, dead time
    /// included; without it they run until both responses have settled, to infinity within 1e-6.
    StepDifference(const LinearPlant& plant, std::optional<double> horizon);

    /// Integrals over |y - y_model|, its square, and |y - y_model| times t, from the step. The model: first order or
    /// with one integrator (and lag) as the plant, T1 > 0 or 0, L >= 0. Relative accuracy about 1e-6 of the plant's
    /// change times its time scale.
    ErrorIntegrals to(const ReducedModel& model) const;
    double absolute(const ReducedModel& model) const;  ///< only the IAE, which is faster

    /// The change of y by the end.
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
