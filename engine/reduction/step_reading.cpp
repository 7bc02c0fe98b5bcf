#include "engine/reduction/step_reading.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"
#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr double kEssentiallyMonotone = 0.8;
constexpr double kCrossingTolerance = 1e-13;  // of a crossing's time

}  // namespace

StepSample crossing(const Realisation& realisation, const StepSample& from, const StepSample& to,
                    const std::function<double(const StepSample&)>& f) {
    const auto after = [&](double tau) { return f(step_response_after(realisation, from, tau)); };
    const double tau = root_between(after, 0, to.t - from.t, f(from), f(to), kCrossingTolerance * to.t);
    return step_response_after(realisation, from, tau);
}

double time_at(const LinearPlant& plant, const std::vector<StepSample>& samples, double level) {
    const double sign = level > 0 ? 1 : -1;
    const auto passed = [&](const StepSample& s) { return sign * (s.y - level); };
    const auto first = std::ranges::find_if(samples, [&](const StepSample& s) { return passed(s) >= 0; });
    if (first == samples.begin() || first == samples.end()) return first == samples.end() ? samples.back().t : 0;
    return crossing(plant.realisation(), *(first - 1), *first, passed).t;
}

std::vector<Warning> monotonicity_warnings(const std::vector<StepSample>& samples, double static_gain) {
    double variation = std::abs(samples.front().y);
    for (size_t i = 1; i < samples.size(); ++i) variation += std::abs(samples[i].y - samples[i - 1].y);
    const double index = std::abs(static_gain) / variation;
    if (index >= kEssentiallyMonotone) return {};
    return {{"not-monotone", "The step response is not essentially monotone (static change over total variation is " +
                                 text(index) +
                                 ", below 0.8): a first-order model describes it poorly. Check Ms, or use robust."}};
}

double ramp_delay(const LinearPlant& plant) {
    double delay = plant.dead_time();
    for (const auto pole : plant.poles()) delay += (-1.0 / pole).real();
    for (const auto zero : plant.zeros()) delay -= (-1.0 / zero).real();
    return delay;
}

Expected<ReducedModel> ramp_asymptote(const LinearPlant& plant) {
    ReducedModel model{.integrators = 1, .K = plant.low_frequency_gain(), .L = ramp_delay(plant)};
    if (model.L < 0)
        return reduction_fails("the zeros of the plant exceed its lags, so the ramp leads the step by " +
                               text(-model.L) + ".");
    model.exact = plant.poles().empty() && plant.zeros().empty();
    return model;
}

Error reduction_fails(const std::string& reason) { return {ErrorKind::unsupported, "reduction/method", reason}; }

namespace {

const double kShareAtTimeConstant = 1 - std::exp(-1.0);

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
        return reduction_fails(
            "the step response jumps at once (as many zeros as poles), so it has no steepest "
            "point.");

    ReducedModel model{.K = plant.low_frequency_gain(), .L = plant.dead_time()};
    model.exact = plant.zeros().empty() && plant.poles().size() <= 1;
    if (plant.poles().empty()) return model;

    const double sign = model.K > 0 ? 1 : -1;
    const std::vector<StepSample> samples = step_response(plant);
    const StepSample at = steepest(plant, samples, sign);
    const double foot = at.t - at.y / at.slope;
    model.L += foot;
    model.T1 = time == TangentTime::by_slope ? model.K / at.slope
                                             : time_at(plant, samples, kShareAtTimeConstant * model.K) - foot;
    if (!(std::isfinite(model.T1) && std::isfinite(model.L) && model.T1 > 0 && foot >= 0))
        return reduction_fails("the response passes 63 % of its change before the foot of its steepest tangent.");

    model.warnings = monotonicity_warnings(samples, model.K);
    return model;
}

namespace {

// The plant without its integrator; its step response is the derivative of the plant's own.
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
