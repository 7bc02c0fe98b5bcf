#include "engine/reduction/two_point_123c.h"

#include "engine/number_text.h"
#include "engine/reduction/step_reading.h"

namespace tunewright {
namespace {

// The plant without its integrator: its step response is the slope of the plant's own.
Expected<LinearPlant> without_integrator(const LinearPlant& plant) {
    return LinearPlant::make(Zpk{.K = plant.gain(),
                                 .zeros = {plant.zeros().begin(), plant.zeros().end()},
                                 .poles = {plant.poles().begin(), plant.poles().end()},
                                 .L = plant.dead_time()});
}

Expected<ReducedModel> through_two_points(const LinearPlant& plant) {
    ReducedModel model{.K = plant.low_frequency_gain()};
    const auto samples = step_response(plant);
    const double t25 = plant.dead_time() + time_at(plant, samples, 0.25 * model.K);
    const double t75 = plant.dead_time() + time_at(plant, samples, 0.75 * model.K);
    model.T1 = 0.9103 * (t75 - t25);
    model.L = 1.2620 * t25 - 0.2620 * t75;
    if (!(model.T1 > 0))
        return reduction_fails("the step response jumps past 75 % of its change at once (t = " + text(t75) + ").");
    if (model.L < 0)
        return reduction_fails("the step response passes 25 % of its change at " + text(t25) + " and 75 % at " +
                               text(t75) + ", which gives a negative dead time, " + text(model.L) + ".");
    model.warnings = monotonicity_warnings(samples, model.K);
    return model;
}

}  // namespace

Expected<ReducedModel> two_point_123c(const LinearPlant& plant, ReducedOrder order) {
    if (plant.integrators() == 0) return through_two_points(plant);
    if (order == ReducedOrder::first) return ramp_asymptote(plant);
    const auto slope = without_integrator(plant);
    if (!slope) return slope.error();
    auto model = through_two_points(*slope);
    if (model) model->integrators = 1;
    return model;
}

}  // namespace tunewright
