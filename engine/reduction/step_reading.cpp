#include "engine/reduction/step_reading.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"
#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr double kEssentiallyMonotone = 0.8;
constexpr double kCrossingTolerance = 1e-13;  // of a crossing's instant

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
        return reduction_fails("the zeros of the plant outweigh its lags, the ramp leads the step by " +
                               text(-model.L) + ".");
    model.exact = plant.poles().empty() && plant.zeros().empty();
    return model;
}

Error reduction_fails(const std::string& reason) { return {ErrorKind::unsupported, "reduction/method", reason}; }

}  // namespace tunewright
