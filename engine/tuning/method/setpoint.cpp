#include "engine/tuning/method/setpoint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/figure.h"
#include "engine/loop/loop.h"
#include "engine/loop/stability.h"
#include "engine/number_text.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/numerics/sign_change.h"
#include "engine/tuning/method/setpoint_responses.h"

namespace tunewright {
namespace {

constexpr double kOvershootReservePercent = 2e-3;  // percentage points of overshoot, for the error of the figures
constexpr double kFixedWeight = 1e-2;              // of b: finer than any step of its setting
constexpr double kWeightStepsPerUnit = 1e4;        // b is rounded to four decimals
constexpr int kLongestFilter = 24;                 // doublings of the first filter that are tried
constexpr int kShortestFilter = 24;                // halvings
constexpr double kFilterTolerance = 1e-12;         // relative
constexpr int kHalvings = 40;
constexpr int kGoldenSections = 26;     // golden sections; they leave 4e-6 of the interval
constexpr double kStepOfPair = 0.05;    // of b: between two values a pair's IAE changes by less than 0.3 %
constexpr double kStepOfWeight = 1e-3;  // of b: enough to show whether the IAE rises

double min(const auto& f) { return golden_section(f, 0, 1, kGoldenSections); }

double rounded(double b) { return std::round(b * kWeightStepsPerUnit) / kWeightStepsPerUnit; }
double down(double b) { return std::floor(b * kWeightStepsPerUnit) / kWeightStepsPerUnit; }
bool same_digits(double a, double b) { return down(a) == down(b); }

/// The shortest filter that keeps the limit; empty: none of the tried ones does. `near`: where the search starts.
std::optional<double> shortest_filter(const SetpointResponses::Filtered& response, double near) {
    const auto beyond = [&](double T) { return response.excess(T); };
    double T = near, here = beyond(T);
    for (int i = 0; here <= 0; ++i) {
        if (i == kShortestFilter) return T;
        T /= 2;
        here = beyond(T);
    }
    for (int i = 0; i < kLongestFilter; ++i, T *= 2) {
        const double next = beyond(2 * T);
        if (next > 0) {
            here = next;
            continue;
        }
        double step = kFilterTolerance * T, shortest = root_between(beyond, T, 2 * T, here, next, step);
        for (; beyond(shortest) > 0; step *= 2) shortest = std::min(shortest + step, 2 * T);
        return shortest;
    }
    return std::nullopt;
}

double overshoot_limit(double asked) { return std::max(asked - kOvershootReservePercent, kOvershootReservePercent); }

struct WeightAndFilter {
    double b = 0, T = 0;
    double IAE = std::numeric_limits<double>::infinity();
};

/// The pair with the least IAE among all pairs of a b and the shortest filter that keeps the limit with it. Usually b =
/// 1: with (b Ti s + 1)/(T s + 1) of a PI, a larger b allows a longer T, which lowers the whole response and not only
/// its first rise. If hardly any filter is needed, it is near the b with the least overshoot, `calmest`, with a short
/// T. Empty: none was found.
std::optional<WeightAndFilter> best_pair(const SetpointResponses& responses, double limit, double calmest) {
    double near = responses.time();
    const auto with = [&](double b) {
        const auto response = responses.with(b, limit);
        const auto T = shortest_filter(response, near);
        if (!T) return WeightAndFilter{b};
        near = *T;
        return WeightAndFilter{b, *T, response.IAE(*T)};
    };
    const auto downhill = [&](WeightAndFilter best, double step) {
        for (double b = best.b + step; b >= 0 && b <= 1; b += step) {
            const WeightAndFilter next = with(rounded(b));
            if (!(next.IAE < best.IAE)) break;
            best = next;
        }
        return best;
    };
    const WeightAndFilter full = downhill(with(1), -kStepOfPair), calm = with(rounded(calmest));
    const WeightAndFilter best = calm.IAE < full.IAE ? downhill(calm, kStepOfPair) : full;
    return std::isfinite(best.IAE) ? std::optional(best) : std::nullopt;
}

/// The b with the least IAE among those that keep the limit on the overshoot; `best` must be one of them. Overshoot and
/// IAE are convex in b, so it is either the largest of them or the b with the least IAE without the limit.
double best_weight(const SetpointResponses& responses, double limit, double best) {
    const auto keeps = [&](double b) { return responses.overshoot(b) <= limit; };
    const auto IAE = [&](double b) { return responses.IAE(b); };
    double largest = 1;
    if (!keeps(1)) {
        largest = down(bisect({best, 1}, keeps, same_digits, kHalvings).inside);
        if (!keeps(largest)) return bisect({best, 1}, keeps, kHalvings).inside;
    }
    const double less = largest - kStepOfWeight;
    if (less < 0 || !keeps(less) || IAE(largest) <= IAE(less)) return largest;
    const double min_at_all = rounded(min(IAE));
    return keeps(min_at_all) ? min_at_all : largest;
}

std::vector<Warning> keep_overshoot(const SetpointResponses& responses, double asked, bool may_filter, IdealPid& pid) {
    const double limit = overshoot_limit(asked);
    const auto overshoot = [&](double b) { return responses.overshoot(b); };
    pid.setpoint_lag = 0;
    const double best = overshoot(1) <= limit ? 1 : overshoot(0) <= limit ? 0 : min(overshoot);
    if (overshoot(best) <= limit) {
        pid.b = best_weight(responses, limit, best);
        return {};
    }
    pid.b = rounded(best);
    if (!may_filter) return {};
    if (const auto pair = best_pair(responses, limit, best)) {
        pid.b = pair->b;
        pid.setpoint_lag = pair->T;
        return {};
    }
    return {{"overshoot-not-held", "No set-point weight or filter keeps the overshoot of a set-point step within " +
                                       text(asked) + " %. With b = " + text(pid.b) + " it is " +
                                       text(overshoot(pid.b)) + " %. Ramp the set point instead of stepping it."}};
}

/// Empty, with the reason, if the response to a set-point step is undefined.
OrReason<SetpointResponses> responses_of(const LinearPlant& plant, const IdealPid& pid) {
    if (!pid.has_integral()) return {std::nullopt, "without integral action the output does not reach the set point."};
    const auto loop = Loop::make(plant, to_parallel(pid));
    if (!loop || !count_unstable_poles(*loop).stable()) return {std::nullopt, "the loop is not stable."};
    SetpointResponses responses(plant, pid);
    if (!responses.usable()) return {std::nullopt, "the response does not settle."};
    return responses;
}

}  // namespace

std::vector<Warning> choose_setpoint(const LinearPlant& plant, const SetpointOptions& options, IdealPid& pid) {
    if (options.weight) {
        pid.b = *options.weight;
        return {};
    }
    if (!options.given()) return {};
    const auto responses = responses_of(plant, pid);
    if (!responses) return {{"setpoint-left", "The set-point weight is not changed: " + responses.why}};
    if (options.overshoot) return keep_overshoot(*responses, *options.overshoot, options.may_filter, pid);
    pid.setpoint_lag = 0;
    pid.b = rounded(min([&](double b) { return responses->IAE(b); }));
    return {};
}

OptionDescription setpoint_option(const std::string& by_default, bool moved) {
    OptionDescription weight = described_option(
        OptionType::number, "weight", "Set-point weight b of the proportional part.", {.minimum = 0, .maximum = 1});
    OptionDescription overshoot = described_option(
        OptionType::number, "overshoot",
        "Largest overshoot of a set-point step: the b with the least IAE that keeps it, else b and a set-point filter "
        "together.",
        {.unit = "%", .minimum = 0, .maximum = 100});
    if (moved) {
        OptionSlider slider{.to = 1, .step = 0.01, .label = "Set-point weight b", .low = "soft", .high = "sharp"};
        slider.group = kSetpointOption;
        weight.slider = slider;
        slider.to = 40, slider.step = 0.5;
        slider.label = "Set-point overshoot";
        slider.reached = DesignFigure::overshoot_percent;
        overshoot.slider = slider;
    }
    OptionDescription best =
        described_option(OptionType::choice, "best", "iae: the b with the least IAE of a set-point step.");
    best.choices = {"iae"};
    OptionDescription setpoint = described_option(
        OptionType::object, kSetpointOption,
        "Response to the set point: weight, overshoot or best. It does not change the loop and its response to loads. "
        "Default: " +
            by_default + ".");
    setpoint.fields = {std::move(weight), std::move(overshoot), std::move(best)};
    setpoint.at_most_fields = 1;
    return setpoint;
}

SetpointOptions setpoint_options(const MethodOptions& given) {
    const std::string place = std::string(kSetpointOption) + "/";
    return {given.number(place + "weight"), given.number(place + "overshoot"), given.text(place + "best").has_value()};
}

SetpointOptions wanted_setpoint(const TuningMethod& method, MethodOptions& given) {
    if (!method.weighs_setpoint) return {};
    SetpointOptions wanted = setpoint_options(given);
    if (wanted.given() || !method.overshoot) return wanted;
    wanted.overshoot = method.overshoot(given);
    if (wanted.overshoot) given.set(std::string(kSetpointOption) + "/overshoot", *wanted.overshoot);
    return wanted;
}

void weigh_setpoint(const LinearPlant& plant, const SetpointOptions& options, TunedController& tuned) {
    const auto remarks = choose_setpoint(plant, options, tuned.controller);
    tuned.warnings.insert(tuned.warnings.end(), remarks.begin(), remarks.end());
}

namespace {

/// Sets the block's weight that meets the request, if it can be set without changing anything else; otherwise the block
/// keeps its own.
void settle_weight(device::Fitted& fitted, const device::DeviceModel& device, const LinearPlant& plant,
                   const SetpointOptions& options, TunedController& tuned) {
    IdealPid wished = fitted.controller;
    TunedController twin;
    twin.controller = device::continuous(wished);
    weigh_setpoint(plant, options, twin);
    wished.b = twin.controller.b;
    wished.setpoint_lag = twin.controller.setpoint_lag;
    auto again = device::fit(device, wished);
    if (again && std::abs(again->controller.b - wished.b) > kFixedWeight) {
        // A weight that cannot be set is fixed by the block and does not count as a difference from the design.
        wished.b = again->controller.b;
        again = device::fit(device, wished);
    }
    if (!again) return;
    IdealPid loop = again->controller;
    loop.b = fitted.controller.b;
    loop.setpoint_lag = fitted.controller.setpoint_lag;
    if (loop != fitted.controller) return;
    fitted = std::move(*again);
    tuned.controller = device::continuous(fitted.controller);
    tuned.warnings.insert(tuned.warnings.end(), twin.warnings.begin(), twin.warnings.end());
}

}  // namespace

void weigh_setpoint(device::Fitted& fitted, const device::DeviceModel& device, const LinearPlant& plant,
                    const SetpointOptions& options, TunedController& tuned) {
    if (!options.given()) return;
    SetpointOptions possible = options;
    possible.may_filter = device.product == nullptr;
    settle_weight(fitted, device, plant, possible, tuned);
}

std::optional<SetpointCure> cure_overshoot(const LinearPlant& plant, double max_percent, const IdealPid& pid,
                                           bool may_weigh) {
    const auto responses = responses_of(plant, pid);
    if (!responses) return std::nullopt;
    const double limit = overshoot_limit(max_percent);
    if (may_weigh && pid.setpoint_lag == 0 && responses->overshoot(0) <= limit) {
        const double b = best_weight(*responses, limit, 0);
        if (b < pid.b) return SetpointCure{b, 0};
    }
    const auto T = shortest_filter(responses->with(pid.b, limit), responses->time());
    return T ? std::optional(SetpointCure{pid.b, *T}) : std::nullopt;
}

}  // namespace tunewright
