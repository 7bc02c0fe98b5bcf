#include "engine/request/verdict/cures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/evaluation/evaluate.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/numerics/propagator.h"
#include "engine/simulation/limited/limited_response.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"
#include "engine/simulation/sampled/sampled_response.h"
#include "engine/tuning/registry.h"

namespace tunewright::verdict {
namespace {

constexpr int kDoublings = 10, kHalvings = 6;  // doublings and halvings in the search for a lag
constexpr double kOwnTolerance = 0.01;  // percentage points: tolerance for a response that was simulated another way

/// The implemented loop's response to the set-point step with this weight and lag.
StepResponse response_with(const VerdictInput& c, const LinearPlant& plant, const SetpointCure& cure) {
    const EvaluateOptions& options = c.context.options;
    const double r = options.setpoint_step;
    if (c.on_device() && c.entry.on_device->fitted.law.Ts > 0) {
        SampledPid law = c.entry.on_device->fitted.law;
        law.gains.b = cure.b;
        law.gains.setpoint_lag = cure.lag;
        return simulate_sampled(plant, law, {.output = options.actuator}, {r, 0}, {});
    }
    ParallelPid acting =
        gains(c.on_device() ? device::continuous(c.entry.on_device->fitted.controller) : c.evaluation.controller);
    acting.b = cure.b;
    acting.setpoint_lag = cure.lag;
    return options.actuator
               ? simulate_limited(plant, acting, {r, 0}, {options.actuator->min, options.actuator->max}, {})
               : simulate_linear(plant, acting, {r, 0}, {});
}

/// Its overshoot in percent; infinite if it does not settle.
double overshoot_with(const VerdictInput& c, const LinearPlant& plant, const SetpointCure& cure) {
    const double r = c.context.options.setpoint_step;
    const StepResponse response = response_with(c, plant, cure);
    if (!response.settles) return INFINITY;
    const Extremes y = extremes_of_y(response.nodes);
    return 100 * ((r > 0 ? y.max : y.min) / r - 1);
}

/// The overshoot of a linear loop after a ramp of the set point: its response is the mean of the step response over the
/// ramp's duration.
class RampedStep {
public:
    RampedStep(const StepResponse& step, double target) : horizon_(step.nodes.back().t), sums_{0} {
        const auto trace = sampled(step.nodes, horizon_, kPoints);
        for (std::size_t i = 1; i < trace.size(); ++i)
            sums_.push_back(sums_.back() + 0.5 * (trace[i - 1].first + trace[i].first) / target);
    }

    double overshoot_percent(double duration) const {
        const double spacing = horizon_ / (kPoints - 1), width = duration / spacing;
        double max = 0;
        for (double end = 0; end <= kPoints - 1 + width; ++end)
            max = std::max(max, (sum_to(end) - sum_to(end - width)) / width);
        return 100 * (max - 1);
    }
    double horizon() const { return horizon_; }

private:
    /// The integral of y from 0, in units of target and spacing; after the last point y is at rest.
    double sum_to(double point) const {
        if (point <= 0) return 0;
        const double last = kPoints - 1;
        if (point >= last) return sums_.back() + point - last;
        const auto before = static_cast<std::size_t>(point);
        return std::lerp(sums_[before], sums_[before + 1], point - std::floor(point));
    }

    static constexpr int kPoints = 2001;
    double horizon_;
    std::vector<double> sums_;
};

const LinearPlant* only_linear(const VerdictInput& c) {
    return c.context.subject.equations() == nullptr ? c.context.subject.linear() : nullptr;
}

/// The law of the loop that runs, in the ideal form; empty: it has no ideal form, or it is nonlinear.
std::optional<IdealPid> running_law(const VerdictInput& c) {
    if (std::holds_alternative<Npid>(c.evaluation.controller)) return std::nullopt;
    if (c.on_device()) return c.entry.on_device->fitted.controller;
    const auto ideal = to_ideal(c.evaluation.controller);
    return ideal ? std::optional(*ideal) : std::nullopt;
}

MethodOptions with_filter_time(const MethodOptions& options, double Tf) {
    MethodOptions changed;
    for (const auto& [path, value] : options.values())
        if (!path.starts_with("filter/")) changed.set(path, value);
    changed.set("filter/Tf", Tf);
    return changed;
}

}  // namespace

std::optional<SetpointCure> overshoot_cure(const VerdictInput& c, double percent) {
    const LinearPlant* plant = only_linear(c);
    const bool product = c.on_device() && c.entry.on_device->fitted.product != nullptr;
    const auto pid = running_law(c);
    if (plant == nullptr || !pid) return std::nullopt;
    // The series form has weights of its own, and the design of a product decides its weights.
    const bool may_weigh = !product && std::holds_alternative<IdealPid>(c.evaluation.controller);
    const auto stopped = [&] { return c.context.control.stop.stop_requested(); };
    const auto kept = [&](const SetpointCure& cure) {
        return !stopped() && overshoot_with(c, *plant, cure) <= percent + kOwnTolerance;
    };
    if (stopped()) return std::nullopt;
    auto cure = cure_overshoot(*plant, percent, *pid, may_weigh);
    if (cure && kept(*cure)) return cure;
    if (cure && cure->lag == 0) cure = cure_overshoot(*plant, percent, *pid, false);
    if (!cure) return std::nullopt;
    double low = 0;
    for (int i = 0; !kept(*cure); ++i, cure->lag *= 2) {
        if (i == kDoublings || stopped()) return std::nullopt;
        low = cure->lag;
    }
    const auto keeps = [&](double lag) { return kept({cure->b, lag}); };
    if (low > 0) cure->lag = bisect({cure->lag, low}, keeps, kHalvings).inside;
    if (stopped()) return std::nullopt;
    return cure;
}

std::optional<double> overshoot_ramp(const VerdictInput& c, double percent) {
    const LinearPlant* plant = only_linear(c);
    const auto pid = running_law(c);
    if (plant == nullptr || !pid || c.context.options.actuator || c.context.control.stop.stop_requested())
        return std::nullopt;
    const StepResponse step = response_with(c, *plant, {pid->b, 0});
    if (!step.settles) return std::nullopt;
    const RampedStep ramped(step, c.context.options.setpoint_step);
    const auto keeps = [&](double duration) { return ramped.overshoot_percent(duration) <= percent; };
    double high = ramped.horizon() / (1 << kDoublings);
    for (int i = 0; !keeps(high); ++i, high *= 2)
        if (i == 2 * kDoublings) return std::nullopt;
    return bisect({high, 0.5 * high}, keeps, 2 * kHalvings).inside;
}

std::optional<double> min_load_IAE(const VerdictInput& c) {
    const LinearPlant* plant = only_linear(c);
    if (plant == nullptr || c.context.options.horizon || !(plant->dead_time() > 0)) return std::nullopt;
    // x' = A x + B, and the integral of h = C x + D as an additional state.
    const Realisation& of = plant->realisation();
    const auto n = static_cast<std::size_t>(of.n), m = n + 1;
    std::vector<double> F(m * m, 0.0), b(m, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        std::copy_n(of.A.begin() + static_cast<std::ptrdiff_t>(i * n), n,
                    F.begin() + static_cast<std::ptrdiff_t>(i * m));
        F[n * m + i] = of.C[i];
        b[i] = of.B[i];
    }
    b[n] = of.D;
    const double L = plant->dead_time();
    const Propagator propagator(static_cast<int>(m), F, std::vector<double>(m, 0.0), b, L);
    const double integral = propagator.step(L).column(m + 4)[n];
    if (!std::isfinite(integral)) return std::nullopt;
    return std::abs(integral * c.context.options.load_step);
}

std::optional<FilteredPeaks> peaks_with_filter(const VerdictInput& c, const Filter& filter) {
    if (c.context.control.stop.stop_requested()) return std::nullopt;
    const LinearPlant* plant = only_linear(c);
    if (plant == nullptr || std::holds_alternative<Npid>(c.evaluation.controller)) return std::nullopt;
    ParallelPid other = gains(c.evaluation.controller);
    other.filter = filter;
    const auto loop = Loop::make(*plant, other);
    if (!loop || !count_unstable_poles(*loop).stable()) return std::nullopt;
    const Peaks peaks = find_peaks(*loop, make_peak_grid(*loop));
    if (!std::isfinite(peaks.S.value) || !std::isfinite(peaks.CS.value)) return std::nullopt;
    return FilteredPeaks{peaks.S.value, peaks.CS.value};
}

bool noise_gain_peaks_beyond(const VerdictInput& c) {
    const LinearPlant* plant = c.context.subject.linear();
    if (plant == nullptr) return true;
    const auto loop = Loop::make(*plant, gains(c.evaluation.controller));
    if (!loop) return true;
    const Peaks peaks = find_peaks(*loop, make_peak_grid(*loop));
    return peaks.CS.omega > peaks.S.omega;
}

std::optional<OtherDesign> designed_with_filter(const VerdictInput& c, double Tf) {
    const TuningProblem* problem = c.context.problem;
    const TuningEntry& entry = c.entry;
    if (problem == nullptr || problem->family || problem->nonlinear != nullptr || entry.over_region || c.on_device() ||
        entry.method != "robust" || entry.options.text("objective") != "load_iae")
        return std::nullopt;
    RunControl control = c.context.control;
    control.progress = {};  // this entry's progress is complete
    const auto design = find_method(entry.method)->tune(*problem, with_filter_time(entry.options, Tf), control);
    if (!design || design->partial) return std::nullopt;
    EvaluateOptions figures = c.context.options;
    figures.stop = control.stop;
    figures.points = 0;
    const auto evaluation = evaluate(c.context.subject, design->controller, figures);
    if (!evaluation || !evaluation->robustness.Mks) return std::nullopt;
    return OtherDesign{evaluation->performance.load.IAE, *evaluation->robustness.Mks};
}

}  // namespace tunewright::verdict
