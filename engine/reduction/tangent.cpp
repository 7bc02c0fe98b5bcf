#include "engine/reduction/tangent.h"

#include <algorithm>
#include <cmath>

#include "engine/reduction/step_reading.h"

namespace tunewright {
namespace {

const double kReached = 1 - std::exp(-1.0);

StepSample steepest(const LinearPlant& plant, const std::vector<StepSample>& samples, double sign) {
    const auto best = std::ranges::max_element(samples, {}, [&](const StepSample& s) { return sign * s.slope; });
    const auto before = best == samples.begin() ? best : best - 1;
    const auto after = best + 1 == samples.end() ? best : best + 1;
    const auto bend = [&](const StepSample& s) { return sign * s.curvature; };
    if (!(bend(*before) > 0 && bend(*after) < 0)) return *best;  // steepest at t = 0+
    const StepSample found = crossing(plant.realisation(), *before, *after, bend);
    return sign * found.slope > sign * best->slope ? found : *best;
}

}  // namespace

Expected<ReducedModel> tangent(const LinearPlant& plant, TangentTime time) {
    if (plant.integrators() == 1) return ramp_asymptote(plant);
    if (plant.direct_term() != 0 && !plant.poles().empty())
        return reduction_fails("the step response jumps at once (as many zeros as poles), it has no steepest point.");

    ReducedModel model{.K = plant.low_frequency_gain(), .L = plant.dead_time()};
    model.exact = plant.zeros().empty() && plant.poles().size() <= 1;
    if (plant.poles().empty()) return model;

    const double sign = model.K > 0 ? 1 : -1;
    const std::vector<StepSample> samples = step_response(plant);
    const StepSample at = steepest(plant, samples, sign);
    const double foot = at.t - at.y / at.slope;
    model.L += foot;
    model.T1 = time == TangentTime::by_slope ? model.K / at.slope : time_at(plant, samples, kReached * model.K) - foot;
    if (!(std::isfinite(model.T1) && std::isfinite(model.L) && model.T1 > 0 && foot >= 0))
        return reduction_fails("the response passes 63 % of its change before the foot of its steepest tangent.");

    model.warnings = monotonicity_warnings(samples, model.K);
    return model;
}

}  // namespace tunewright
