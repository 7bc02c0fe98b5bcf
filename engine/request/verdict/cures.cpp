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

/// Overshoot in percent of the implemented loop with this weight and lag; infinite if it does not settle.
double overshoot_with(const VerdictInput& c, const LinearPlant& plant, const SetpointCure& cure) {
    const EvaluateOptions& options = c.context.options;
    const double r = options.setpoint_step;
    StepResponse response;
    if (c.on_device() && c.entry.on_device->fitted.law.Ts > 0) {
        SampledPid law = c.entry.on_device->fitted.law;
        law.gains.b = cure.b;
        law.gains.setpoint_lag = cure.lag;
        response = simulate_sampled(plant, law, {.output = options.actuator}, {r, 0}, {});
    } else {
        ParallelPid acting =
            gains(c.on_device() ? device::continuous(c.entry.on_device->fitted.controller) : c.evaluation.controller);
        acting.b = cure.b;
        acting.setpoint_lag = cure.lag;
        response = options.actuator
                       ? simulate_limited(plant, acting, {r, 0}, {options.actuator->min, options.actuator->max}, {})
                       : simulate_linear(plant, acting, {r, 0}, {});
    }
    if (!response.settles) return INFINITY;
    const Extremes y = extremes_of_y(response.nodes);
    return 100 * ((r > 0 ? y.max : y.min) / r - 1);
}

const LinearPlant* only_linear(const VerdictInput& c) {
    return c.context.subject.equations() == nullptr ? c.context.subject.linear() : nullptr;
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
    const auto pid =
        c.on_device() ? Expected<IdealPid>(c.entry.on_device->fitted.controller) : to_ideal(c.evaluation.controller);
    if (plant == nullptr || !pid || std::holds_alternative<Npid>(c.evaluation.controller)) return std::nullopt;
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
