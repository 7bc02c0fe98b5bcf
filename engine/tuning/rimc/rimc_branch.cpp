#include "engine/tuning/rimc/rimc_branch.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/loop/margins.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/number_text.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/numerics/sign_change.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {
namespace {

constexpr double kMinLambdaRatio = 1e-4, kMaxLambdaRatio = 1e3;   // range of lambda/tau in the search
constexpr double kDescentFactor = 0.8, kFineDescentFactor = 0.9;  // ratio of successive values of lambda in downward
                                                                  // searches
constexpr double kMaxLambdaWithoutDeadTime = 1.4142135623730951;  // theta = 0: |S| <= 1 for lambda <= sqrt(2) tau
constexpr double kLimitAccuracy = 1e-7;                           // relative accuracy of the stability limit
constexpr double kRootTolerance = 1e-11;                          // of ln lambda
constexpr int kPointsPerDecade = 60;                              // points of the sweep that finds the branch
// Ends of that sweep, as multiples of 1/T or 1/L: for every PID of the branch |S| has its peak between them.
constexpr double kLowestSwept = 0.03, kHighestSwept = 300;
constexpr double kShortestSwept = 1e-3;  // of L/T: a shorter dead time has no visible effect
constexpr double kMinFilter = 0.01;      // of Td: least filter time of a linear fraction
constexpr double kOpenEndMargin = 1e-9;  // relative distance from an excluded end of the admissible range
constexpr double kFirstStep = 1e-4;      // relative: first step from the sweep's result to a bracket of the exact one

LinearPlant scaled_plant(const Fopdt& model) { return *LinearPlant::make(Fopdt{1, 1, model.L / model.T}); }

}  // namespace

RimcBranch::RimcBranch(const Fopdt& model, const RimcFilter& filter)
    : model_(model), scaled_{1, 1, model.L / model.T}, filter_(filter), plant_(scaled_plant(model)) {
    find_admissible();
    const double highest = kHighestSwept / std::clamp(scaled_.L, kShortestSwept, 1.0),
                 lowest = kLowestSwept / std::max(1.0, scaled_.L);
    const int n = static_cast<int>(kPointsPerDecade * std::log10(highest / lowest));
    for (int i = 0; i <= n; ++i) {
        omega_.push_back(lowest * std::pow(highest / lowest, static_cast<double>(i) / n));
        response_.push_back(plant_.at({0, omega_.back()}));
    }
    find_min_Ms();
    if (scaled_branch_) find_stability_limit();
}

std::optional<RimcBranch::Range> RimcBranch::branch() const {
    if (!scaled_branch_) return std::nullopt;
    return Range{scaled_branch_->low * model_.T, scaled_branch_->high * model_.T};
}

std::optional<double> RimcBranch::stability_limit() const {
    return has_stability_limit_ ? std::optional(scaled_branch_->low * model_.T) : std::nullopt;
}

void RimcBranch::find_admissible() {
    const auto admissible = [&](double x) { return pid(x).has_value(); };
    double low = 1, high = 1;  // lambda = tau is always admissible
    while (low > kMinLambdaRatio && admissible(low * 0.9)) low *= 0.9;
    while (high < kMaxLambdaRatio && admissible(high * 1.05)) high *= 1.05;
    scaled_admissible_.low =
        low > kMinLambdaRatio ? log_bisect({low, low * 0.9}, admissible, kRootTolerance).inside : 0;
    scaled_admissible_.high =
        high < kMaxLambdaRatio ? log_bisect({high, high * 1.05}, admissible, kRootTolerance).inside : high;
}

// Least |1 + L| over a fixed set of frequencies, with a parabola through the lowest three: fast, and accurate enough to
// find the ends of the branch.
double RimcBranch::nearest_approach(const IdealPid& pid) const {
    const double Ki = pid.Kp / pid.Ti, Kd = pid.Kp * pid.Td, Tf = pid.filter.Tf;
    const auto squared = [&](std::size_t i) {
        // C(j omega) is written out because complex divisions would take most of the time.
        const double omega = omega_[i], corner = omega * Tf, lead = Kd * omega / (1 + corner * corner);
        const std::complex<double> C(pid.Kp + lead * corner, lead - Ki / omega);
        return std::norm(1.0 + response_[i] * C);
    };
    std::size_t lowest = 1;
    double value = squared(1);
    for (std::size_t i = 2; i + 1 < omega_.size(); ++i) {
        const double here = squared(i);
        if (here >= value) continue;
        value = here;
        lowest = i;
    }
    const double left = squared(lowest - 1), right = squared(lowest + 1), bend = left + right - 2 * value;
    if (bend > 0) value -= (right - left) * (right - left) / (8 * bend);
    const double q = Tf > 0 ? 0 : Kd;  // |L(infinity)|
    return std::min(std::sqrt(std::max(value, 0.0)), 1 - q);
}

void RimcBranch::find_min_Ms() {
    const double lowest = scaled_admissible_.low, highest = scaled_admissible_.high;
    const double ratio = 1.1;
    double best = 0, farthest = 0;
    for (double x = highest; x > std::max(lowest, 0.02); x /= ratio) {
        const double approach = nearest_approach(*pid(x));
        if (approach <= farthest || !stable_loop(x)) continue;
        farthest = approach;
        best = x;
    }
    if (best == 0) return;
    if (scaled_.L == 0) {
        best = kMaxLambdaWithoutDeadTime;
    } else {
        const double right = std::min(best * ratio, highest), left = std::max(best / ratio, lowest);
        const auto quality = [&](double x) { return nearest_approach(*pid(std::min(x, highest))); };
        const double middle = std::sqrt(left * right);
        const auto peak = log_maximum(quality, left, {middle, quality(middle)}, right);
        if (peak.value > farthest) best = std::min(peak.x, highest);
    }
    scaled_branch_ = Range{best, best};
    min_Ms_ = Ms_of(*loop(best));
}

void RimcBranch::find_stability_limit() {
    double& low = scaled_branch_->low;
    double lowest = std::max(scaled_admissible_.low * (1 + kOpenEndMargin), kMinLambdaRatio);
    // At that end a linear fraction's filter time goes to 0, so its noise gain is unbounded.
    const auto filtered = [&](double x) {
        const auto settings = pid(x);
        return settings && settings->filter.Tf >= kMinFilter * settings->Td;
    };
    if (filter_.linear_fraction && filtered(low) && !filtered(lowest))
        lowest = log_bisect({low, lowest}, filtered, kRootTolerance).inside;
    const auto stable = [&](double x) { return stable_loop(x).has_value(); };
    while (low * kDescentFactor > lowest) {
        if (!stable(low * kDescentFactor)) {
            has_stability_limit_ = true;
            low = log_bisect({low, low * kDescentFactor}, stable, kLimitAccuracy).inside;
            return;
        }
        low *= kDescentFactor;
    }
    low = lowest;
}

std::optional<Loop> RimcBranch::loop(double x) const {
    const auto settings = pid(x);
    if (!settings) return std::nullopt;
    auto made = Loop::make(plant_, to_parallel(*settings));
    return made ? std::optional(*made) : std::nullopt;
}

std::optional<Loop> RimcBranch::stable_loop(double x) const {
    const auto made = loop(x);
    return made && count_unstable_poles(*made).stable() ? made : std::nullopt;
}

double RimcBranch::Ms_of(const Loop& loop) { return find_sensitivity_peak(loop, make_peak_grid(loop)).value; }

double RimcBranch::peak_of(const Loop& loop, double x) const {
    ResponseOptions options;
    options.horizon = 2 + 6 * (x + scaled_.L);
    return extremes_of_y(simulate_linear(plant_, loop.gains(), {0, 1}, options).nodes).max;
}

std::optional<double> RimcBranch::Ms(double lambda) const {
    const auto stable = stable_loop(lambda / model_.T);
    return stable ? std::optional(Ms_of(*stable)) : std::nullopt;
}

std::optional<double> RimcBranch::disturbance_peak(double lambda) const {
    const auto stable = stable_loop(lambda / model_.T);
    return stable ? std::optional(peak_of(*stable, lambda / model_.T) * model_.K) : std::nullopt;
}

std::optional<double> RimcBranch::dead_time_error(double lambda) const {
    const auto stable = stable_loop(lambda / model_.T);
    return stable ? std::optional(small_gain_dead_time(*stable, make_loop_grid(*stable)) * model_.T) : std::nullopt;
}

std::optional<double> RimcBranch::dead_time_mismatch_at(double lambda, double error) const {
    const auto stable = stable_loop(lambda / model_.T);
    if (!stable) return std::nullopt;
    return dead_time_mismatch(*stable, make_loop_grid(*stable), error / model_.T);
}

// Searches downwards from the branch's upper end for the first lambda at which the figure passes the target. `rising`:
// the figure grows in this direction. Every loop of the branch is stable and is not checked again.
RimcBranch::Reach RimcBranch::descend(const Figure& figure, double target, bool rising, double step) const {
    const double sign = rising ? 1 : -1;
    const double lowest = scaled_branch_->low * (1 + 2 * kLimitAccuracy);
    const auto excess = [&](double x) { return sign * (figure(*loop(x), x) - target); };
    double x = scaled_branch_->high, f = excess(x), best = f;
    if (f >= 0) return f == 0 ? Reach{.x = x} : Reach{.best = f / sign + target};
    while (x > lowest) {
        const double next = std::max(x * step, lowest);
        const double f_next = excess(next);
        if (f_next >= 0) return {.x = log_root(excess, next, x, f_next, f, kRootTolerance)};
        best = std::max(best, f_next);
        x = next;
        f = f_next;
    }
    return {.best = best / sign + target};
}

Error RimcBranch::no_branch(const char* option) const {
    return {
        ErrorKind::no_feasible_controller, option,
        "No lambda gives a loop that is stable on the model with L/T = " + text(scaled_.L) +
            " and this filter. Use a smaller Tf_over_Td, the approximation linear_fractional, or the method robust."};
}

Expected<double> RimcBranch::lambda_for_Ms(double Ms) const {
    if (!scaled_branch_) return no_branch("Ms");
    const auto refused = [&](const std::string& range) {
        return Error{ErrorKind::no_feasible_controller, "Ms",
                     "Ms is " + text(Ms) + "; on the model with L/T = " + text(scaled_.L) + " it can be " + range +
                         ". Give a value in that range, or lambda."};
    };
    if (Ms < min_Ms_) return refused(text(min_Ms_) + " (at lambda = " + text(branch()->high) + ") or more");
    const Figure swept = [&](const Loop&, double x) { return 1 / nearest_approach(*pid(x)); };
    const Reach reach = descend(swept, Ms, true, kDescentFactor);
    const auto excess = [&](double x) { return Ms_of(*loop(x)) - Ms; };
    double near =
        reach.x.value_or(Ms > min_Ms_ * 1.01 ? scaled_branch_->low * (1 + 2 * kLimitAccuracy) : scaled_branch_->high);
    // The sweep's result is nearly exact: the search goes outwards from it until the exact Ms lies on both sides of the
    // target.
    double f = excess(near), next = near, f_next = f;
    for (double step = kFirstStep; f != 0 && (f < 0) == (f_next < 0); step *= 4) {
        near = next;
        f = f_next;
        next = std::clamp(f < 0 ? near / (1 + step) : near * (1 + step), scaled_branch_->low, scaled_branch_->high);
        if (next == near) return refused("from " + text(min_Ms_) + " to " + text(f + Ms));
        f_next = excess(next);
    }
    return log_root(excess, near, next, f, f_next, kRootTolerance) * model_.T;
}

Expected<double> RimcBranch::lambda_for_disturbance_peak(double peak) const {
    if (!scaled_branch_) return no_branch("disturbance_peak");
    const double gain = std::abs(model_.K), target = std::abs(peak) / gain;
    const Figure figure = [&](const Loop& loop, double x) { return peak_of(loop, x); };
    const Reach reach = descend(figure, target, false, kDescentFactor);
    if (reach.x) return *reach.x * model_.T;
    const double highest = figure(*loop(scaled_branch_->high), scaled_branch_->high);
    const double lowest = target > highest ? descend(figure, 0, false, kDescentFactor).best : reach.best;
    return Error{ErrorKind::no_feasible_controller, "disturbance_peak",
                 "disturbance_peak is " + text(peak) + " per unit of load; with this PID on the model with L/T = " +
                     text(scaled_.L) + " it can be from " + text(lowest * gain) + " to " + text(highest * gain) +
                     " (no controller has less than " + text(-std::expm1(-scaled_.L) * gain) +
                     "). Give a value in that range, or lambda."};
}

Expected<double> RimcBranch::lambda_for_dead_time_error(double error) const {
    if (!scaled_branch_) return no_branch("dead_time_error");
    const double target = error / model_.T;
    const Figure mismatch = [&](const Loop& loop, double) {
        return dead_time_mismatch(loop, make_loop_grid(loop), target);
    };
    const Loop at_end = *loop(scaled_branch_->high);
    if (mismatch(at_end, 0) >= 1)
        return Error{ErrorKind::no_feasible_controller, "dead_time_error",
                     "dead_time_error is " + text(error) + "; by Eq. 29 on the model with L/T = " + text(scaled_.L) +
                         " it can be up to " + text(small_gain_dead_time(at_end, make_loop_grid(at_end)) * model_.T) +
                         " (at lambda = " + text(branch()->high) + "). Give a smaller one, or lambda."};
    // If Eq. 29 holds down to the other end of the branch, that end is the result.
    return descend(mismatch, 1, true, kFineDescentFactor).x.value_or(scaled_branch_->low) * model_.T;
}

DisturbancePeakCurve RimcBranch::curve(int points) const {
    DisturbancePeakCurve curve;
    if (!scaled_branch_) return curve;
    const double from = std::max(1.1 * scaled_branch_->low, 0.01), to = scaled_admissible_.high;
    for (int i = 0; i < points; ++i) {
        const double x = from * std::pow(to / from, static_cast<double>(i) / (points - 1));
        const auto stable = stable_loop(x);
        if (!stable) continue;
        curve.lambda_over_tau.push_back(x);
        curve.DP_over_kp.push_back(peak_of(*stable, x));
        curve.Ms.push_back(Ms_of(*stable));
    }
    return curve;
}

}  // namespace tunewright
