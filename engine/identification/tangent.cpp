#include "engine/identification/tangent.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"
#include "engine/simulation/step_response.h"

namespace tunewright {
namespace {

const double kReached = 1 - std::exp(-1.0);
constexpr double kEssentiallyMonotone =
    0.8;  // least |static gain| / total variation (Astrom & Hagglund 2006, Section 2.6)

Error not_applicable(const std::string& reason) { return {ErrorKind::unsupported, "reduction/method", reason}; }

// Zero of f(sample) between two samples at which it has opposite signs: regula falsi with the Illinois rule on the
// exact response.
template <class F>
StepSample crossing(const Realisation& realisation, const StepSample& from, const StepSample& to, F f) {
    double low = 0, high = to.t - from.t, f_low = f(from), f_high = f(to);
    if (f_low == 0) return from;
    StepSample at = to;
    for (int round = 0; round < 60 && high - low > 1e-13 * to.t && f_high != 0; ++round) {
        const double tau = (low * f_high - high * f_low) / (f_high - f_low);
        at = step_response_after(realisation, from, tau);
        const double value = f(at);
        if (value == 0) return at;
        if ((value > 0) == (f_high > 0)) {
            high = tau, f_high = value;
            f_low /= 2;
        } else {
            low = tau, f_low = value;
            f_high /= 2;
        }
    }
    return at;
}

StepSample steepest(const LinearPlant& plant, const std::vector<StepSample>& samples, double sign) {
    const auto best = std::ranges::max_element(samples, {}, [&](const StepSample& s) { return sign * s.slope; });
    const auto before = best == samples.begin() ? best : best - 1;
    const auto after = best + 1 == samples.end() ? best : best + 1;
    const auto bend = [&](const StepSample& s) { return sign * s.curvature; };
    if (!(bend(*before) > 0 && bend(*after) < 0)) return *best;  // steepest at t = 0+
    const StepSample found = crossing(plant.realisation(), *before, *after, bend);
    return sign * found.slope > sign * best->slope ? found : *best;
}

double time_at(const LinearPlant& plant, const std::vector<StepSample>& samples, double level, double sign) {
    const auto missing = [&](const StepSample& s) { return sign * (s.y - level); };
    const auto first = std::ranges::find_if(samples, [&](const StepSample& s) { return missing(s) >= 0; });
    if (first == samples.begin() || first == samples.end()) return first == samples.end() ? samples.back().t : 0;
    return crossing(plant.realisation(), *(first - 1), *first, missing).t;
}

double monotonicity(const std::vector<StepSample>& samples, double K) {
    double variation = std::abs(samples.front().y);
    for (size_t i = 1; i < samples.size(); ++i) variation += std::abs(samples[i].y - samples[i - 1].y);
    return std::abs(K) / variation;
}

Expected<ReducedModel> ramp_asymptote(const LinearPlant& plant) {
    ReducedModel model{.integrators = 1, .K = plant.low_frequency_gain(), .L = plant.dead_time()};
    for (const auto pole : plant.poles()) model.L += (-1.0 / pole).real();
    for (const auto zero : plant.zeros()) model.L -= (-1.0 / zero).real();
    if (model.L < 0)
        return not_applicable("the zeros of the plant outweigh its lags, the ramp leads the step by " + text(-model.L) +
                              ".");
    model.exact = plant.poles().empty() && plant.zeros().empty();
    return model;
}

}  // namespace

Expected<ReducedModel> tangent(const LinearPlant& plant, TangentTime time) {
    if (plant.integrators() == 1) return ramp_asymptote(plant);
    if (plant.direct_term() != 0 && !plant.poles().empty())
        return not_applicable("the step response jumps at once (as many zeros as poles), it has no steepest point.");

    ReducedModel model{.K = plant.low_frequency_gain(), .L = plant.dead_time()};
    model.exact = plant.zeros().empty() && plant.poles().size() <= 1;
    if (plant.poles().empty()) return model;

    const double sign = model.K > 0 ? 1 : -1;
    const std::vector<StepSample> samples = step_response(plant);
    const StepSample at = steepest(plant, samples, sign);
    const double foot = at.t - at.y / at.slope;
    model.L += foot;
    model.T1 =
        time == TangentTime::by_slope ? model.K / at.slope : time_at(plant, samples, kReached * model.K, sign) - foot;
    if (!(std::isfinite(model.T1) && std::isfinite(model.L) && model.T1 > 0 && foot >= 0))
        return not_applicable("the response passes 63 % of its change before the foot of its steepest tangent.");

    const double index = monotonicity(samples, model.K);
    if (index < kEssentiallyMonotone)
        model.warnings.push_back(
            {"not-monotone", "The step response is not essentially monotone (static change over total variation is " +
                                 text(index) +
                                 ", below 0.8): a first-order model describes it poorly. Check Ms, or use robust."});
    return model;
}

}  // namespace tunewright
