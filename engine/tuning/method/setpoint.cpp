#include "engine/tuning/method/setpoint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/figure.h"
#include "engine/loop/loop.h"
#include "engine/loop/stability.h"
#include "engine/number_text.h"
#include "engine/numerics/sign_change.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {
namespace {

constexpr double kTolerance = 1e-5, kSettled = 1e-6;  // of the responses that the choice is made on
constexpr double kSameInstant = 1e-12;
constexpr double kSpare = 2e-3;             // percentage points of overshoot, for the figures' own error
constexpr double kWorthSaying = 0.5;        // of them, beyond what was asked for
constexpr double kDigits = 1e4;             // b is answered to four decimals
constexpr int kLongestFilter = 24;          // doublings of the first filter tried
constexpr double kFirstFilter = 1.0 / 64;   // of the integral of the error
constexpr double kFilterTolerance = 1e-12;  // relative
constexpr int kHalvings = 40;

/// The responses to a unit step with b = 0, and what b = 1 adds, on the same instants.
class StepResponses {
public:
    StepResponses(const LinearPlant& plant, const IdealPid& pid) {
        ResponseOptions options;
        options.tolerance = kTolerance;
        options.settled = kSettled;
        IdealPid with = pid;
        with.setpoint_lag = 0;
        with.b = 1;
        StepResponse one = simulate_linear(plant, to_parallel(with), {1, 0}, options);
        with.b = 0;
        options.repeat = &one.schedule;
        zero_ = simulate_linear(plant, to_parallel(with), {1, 0}, options);
        align(one.nodes, zero_.nodes);
        usable_ = one.settles && one.nodes.size() == zero_.nodes.size();
        if (!usable_) return;
        IE_of_one_ = one.error_integral_final;
        added_ = std::move(one.nodes);
        for (std::size_t i = 0; i < added_.size(); ++i) {
            added_[i].y -= zero_.nodes[i].y;
            added_[i].y_slope -= zero_.nodes[i].y_slope;
            added_[i].error_integral -= zero_.nodes[i].error_integral;
        }
    }

    bool usable() const { return usable_; }

    /// In percent, below 0 where y stays below the set point.
    double overshoot(double b) const { return excess(weighted(b)); }
    double IAE(double b) const {
        std::optional<double> integral;
        if (zero_.error_integral_final && IE_of_one_)
            integral = *zero_.error_integral_final + b * (*IE_of_one_ - *zero_.error_integral_final);
        return integral_of_absolute_error(weighted(b), 1, integral);
    }
    std::vector<ResponseNode> weighted(double b) const {
        std::vector<ResponseNode> nodes = zero_.nodes;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            nodes[i].y += b * added_[i].y;
            nodes[i].y_slope += b * added_[i].y_slope;
            nodes[i].error_integral += b * added_[i].error_integral;
        }
        return nodes;
    }
    /// Of such a response behind a filter.
    static double overshoot_filtered(const std::vector<ResponseNode>& weighted, double T) {
        return excess(filtered(weighted, T));
    }
    double time() const { return std::abs(zero_.error_integral_final.value_or(1)); }

private:
    /// Instants nearer than the times' rounding are one.
    static bool jumps_after(const std::vector<ResponseNode>& nodes, std::size_t i) {
        return i + 1 < nodes.size() && nodes[i + 1].t - nodes[i].t <= kSameInstant * nodes[i + 1].t;
    }

    /// Where only one of two runs over the same steps has a jump, the other's node there is doubled.
    static void align(std::vector<ResponseNode>& a, std::vector<ResponseNode>& b) {
        std::vector<ResponseNode> both_a, both_b;
        std::size_t i = 0, j = 0;
        while (i < a.size() && j < b.size()) {
            both_a.push_back(a[i]);
            both_b.push_back(b[j]);
            const bool a_jumps = jumps_after(a, i), b_jumps = jumps_after(b, j);
            if (a_jumps || !b_jumps) ++i;
            if (b_jumps || !a_jumps) ++j;
        }
        a = std::move(both_a);
        b = std::move(both_b);
    }

    static double excess(const std::vector<ResponseNode>& nodes) { return 100 * (extremes_of_y(nodes).max - 1); }

    /// T z' = y - z, exact for the cubic y between nodes: z = p - T p' + T^2 p'' - T^3 p''' plus an exponential.
    static std::vector<ResponseNode> filtered(const std::vector<ResponseNode>& of, double T) {
        std::vector<ResponseNode> nodes = of;
        double z = 0;
        nodes.front().y = nodes.front().y_slope = 0;
        for (std::size_t i = 1; i < nodes.size(); ++i) {
            const ResponseNode &a = of[i - 1], &b = of[i];
            const double h = b.t - a.t;
            if (!jumps_after(of, i - 1)) {
                const double slope = (b.y - a.y) / h;
                const double curve = (3 * slope - 2 * a.y_slope - b.y_slope) / h,
                             twist = (a.y_slope + b.y_slope - 2 * slope) / (h * h);
                const auto particular = [&](double s) {
                    const double p = a.y + s * (a.y_slope + s * (curve + s * twist)),
                                 p1 = a.y_slope + s * (2 * curve + s * 3 * twist), p2 = 2 * curve + s * 6 * twist;
                    return p - T * (p1 - T * (p2 - T * 6 * twist));
                };
                z = particular(h) + (z - particular(0)) * std::exp(-h / T);
            }
            nodes[i].y = z;
            nodes[i].y_slope = (b.y - z) / T;
        }
        return nodes;
    }

    StepResponse zero_;
    std::vector<ResponseNode> added_;
    std::optional<double> IE_of_one_;
    bool usable_ = false;
};

/// Where a convex function on [0, 1] is least, by golden sections.
template <class F>
double least(const F& f) {
    constexpr double kGolden = 1 / std::numbers::phi;
    constexpr int kSections = 26;  // leave 4e-6 of the interval
    double low = 0, high = 1, a = 1 - kGolden, b = kGolden, fa = f(a), fb = f(b);
    for (int i = 0; i < kSections; ++i) {
        if (fa <= fb) {
            high = b;
            b = a;
            fb = fa;
            a = high - kGolden * (high - low);
            fa = f(a);
        } else {
            low = a;
            a = b;
            fa = fb;
            b = low + kGolden * (high - low);
            fb = f(b);
        }
    }
    return 0.5 * (low + high);
}

/// The last x from `good` towards `bad` at which `keeps` holds; not looked for any closer once both ends are `alike`.
template <class F, class Alike>
double border(double good, double bad, const F& keeps, const Alike& alike) {
    for (int i = 0; i < kHalvings && !alike(good, bad); ++i) {
        const double middle = 0.5 * (good + bad);
        (keeps(middle) ? good : bad) = middle;
    }
    return good;
}

double down(double b) { return std::floor(b * kDigits) / kDigits; }
bool same_digits(double a, double b) { return down(a) == down(b); }
bool never(double, double) { return false; }

/// The shortest filter that keeps the limit, with this b; empty: none that was looked at does.
std::optional<double> shortest_filter(const StepResponses& responses, double limit, double b) {
    const auto response = responses.weighted(b);
    const auto beyond = [&](double T) { return StepResponses::overshoot_filtered(response, T) - limit; };
    double T = kFirstFilter * responses.time(), here = beyond(T);
    if (here <= 0) return T;
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

double overshoot_limit(double asked) { return std::max(asked - kSpare, kSpare); }

std::vector<Warning> keep_overshoot(const StepResponses& responses, double asked, IdealPid& pid) {
    const double limit = overshoot_limit(asked);
    const auto overshoot = [&](double b) { return responses.overshoot(b); };
    const auto keeps = [&](double b) { return overshoot(b) <= limit; };
    pid.setpoint_lag = 0;
    pid.b = 1;
    if (keeps(1)) return {};
    const double best = keeps(0) ? 0 : least(overshoot);
    if (keeps(best)) {
        const double b = down(border(best, 1, keeps, same_digits));
        pid.b = keeps(b) ? b : border(best, 1, keeps, never);
        return {};
    }
    pid.b = 0;
    if (const auto T = shortest_filter(responses, limit, 0)) {
        pid.setpoint_lag = *T;
        return {};
    }
    return {{"overshoot-not-held", "No set-point weight or filter keeps the overshoot of a set-point step within " +
                                       text(asked) + " %. With b = 0 it is " + text(overshoot(0)) +
                                       " %; raise the set point slowly instead of in a step."}};
}

/// Empty where nothing can be said of a set-point step, with the reason.
OrReason<StepResponses> responses_of(const LinearPlant& plant, const IdealPid& pid) {
    if (!pid.has_integral()) return {std::nullopt, "without integral action the output does not reach the set point."};
    const auto loop = Loop::make(plant, to_parallel(pid));
    if (!loop || !count_unstable_poles(*loop).stable()) return {std::nullopt, "the loop is not stable."};
    StepResponses responses(plant, pid);
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
    if (!responses) return {{"setpoint-left", "The set-point weight is left as it is: " + responses.why}};
    if (options.overshoot) return keep_overshoot(*responses, *options.overshoot, pid);
    pid.setpoint_lag = 0;
    pid.b = std::round(least([&](double b) { return responses->IAE(b); }) * kDigits) / kDigits;
    return {};
}

OptionDescription setpoint_option(const std::string& by_default) {
    OptionDescription weight{.name = "weight",
                             .type = OptionType::number,
                             .sentence = "Set-point weight b of the proportional part.",
                             .minimum = 0,
                             .maximum = 1};
    OptionDescription overshoot{
        .name = "overshoot",
        .type = OptionType::number,
        .sentence =
            "Largest overshoot of a set-point step. The largest b that keeps it, else b = 0 with "
            "a set-point filter.",
        .unit = "%",
        .minimum = 0,
        .maximum = 100};
    OptionDescription best{.name = "best",
                           .type = OptionType::choice,
                           .sentence = "iae: the b with the least IAE of a set-point step.",
                           .choices = {"iae"}};
    std::string sentence =
        "What the set point does: weight, overshoot or best. It leaves the loop and its response to loads alone. ";
    sentence += "Default: " + by_default + ".";
    return {.name = kSetpointOption,
            .type = OptionType::object,
            .sentence = sentence,
            .fields = {weight, overshoot, best},
            .at_most_fields = 1};
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

/// The block with the weight that keeps the wish, if it has one to set and nothing else of it moves.
void settle_weight(built::Fitted& fitted, const built::Build& build, const LinearPlant& plant,
                   const SetpointOptions& options, TunedController& tuned) {
    IdealPid wished = fitted.controller;
    TunedController twin;
    twin.controller = built::continuous(wished);
    weigh_setpoint(plant, options, twin);
    wished.b = twin.controller.b;
    wished.setpoint_lag = twin.controller.setpoint_lag;
    auto again = built::fit(build, wished);
    if (!again) return;
    IdealPid loop = again->controller;
    loop.b = fitted.controller.b;
    loop.setpoint_lag = fitted.controller.setpoint_lag;
    if (loop != fitted.controller) return;
    fitted = std::move(*again);
    tuned.controller = built::continuous(fitted.controller);
    tuned.warnings.insert(tuned.warnings.end(), twin.warnings.begin(), twin.warnings.end());
}

/// What the block's own weight leaves of a wished overshoot: it may have no weight to set, and has no filter of the set
/// point.
std::vector<Warning> remark_overshoot(const LinearPlant& plant, double asked, const IdealPid& pid) {
    if (pid.setpoint_lag > 0) return {};
    const auto responses = responses_of(plant, pid);
    if (!responses) return {};
    const double is = responses->overshoot(pid.b);
    if (is <= asked + kWorthSaying) return {};
    const auto T = shortest_filter(*responses, overshoot_limit(asked), pid.b);
    return {{"overshoot-not-held",
             "With the controller's own set-point weight, b = " + text(pid.b) + ", a set-point step overshoots by " +
                 text(is, 3) + " %, more than " + text(asked, 3) + " %. " +
                 (T ? "A lag of " + text(*T, 3) + " before its set point keeps that; or raise" : std::string("Raise")) +
                 " the set point slowly instead of in a step."}};
}

}  // namespace

void weigh_setpoint(built::Fitted& fitted, const built::Build& build, const LinearPlant& plant,
                    const SetpointOptions& options, TunedController& tuned) {
    if (!options.given()) return;
    settle_weight(fitted, build, plant, options, tuned);
    if (!options.overshoot) return;
    const auto remarks = remark_overshoot(plant, *options.overshoot, tuned.controller);
    tuned.warnings.insert(tuned.warnings.end(), remarks.begin(), remarks.end());
}

}  // namespace tunewright
