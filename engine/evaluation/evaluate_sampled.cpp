#include "engine/evaluation/evaluate_sampled.h"

#include <algorithm>
#include <cmath>

#include "engine/evaluation/evaluate_nonlinear.h"
#include "engine/evaluation/evaluation_start.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/evaluation/robustness_figures.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "engine/numerics/extremum.h"
#include "engine/numerics/sign_change.h"
#include "engine/simulation/sampled/sampled_nonlinear.h"
#include "engine/simulation/sampled/sampled_response.h"

namespace tunewright {
namespace {

constexpr double kPeakMoves = 4;      // a sampled loop's peak lies within this factor of the continuous one's
constexpr double kFirstSample = 0.1;  // of 1/omega_Ms: where the search for the longest sample time starts
constexpr double kShortest = 1e-3;    // of 1/omega_Ms
constexpr double kSampleTolerance = 5e-4;
constexpr double kWholeLoop = 1e-3;  // relative: how far the whole loop's Ms may lie above that near the peak

using Simulate = std::function<StepResponse(const ProgramLimits&, const StepInputs&, std::optional<double> horizon)>;

StepResponse respond(const Simulate& simulate, const ProgramLimits& limits, const StepInputs& inputs,
                     const EvaluateOptions& options) {
    std::optional<double> horizon = options.horizon;
    const bool rests = limits.u_resolution == 0 && limits.y_resolution == 0 && limits.dead_band == 0;
    if (rests || horizon) return simulate(limits, inputs, horizon);
    const StepResponse without = simulate({limits.output, 0, 0, 0}, inputs, horizon);
    return simulate(limits, inputs, without.nodes.back().t);
}

void add_performance(BuiltLoop& built, const Simulate& simulate, const ProgramLimits& limits,
                     const EvaluateOptions& options) {
    const StepResponse setpoint = respond(simulate, limits, {options.setpoint_step, 0}, options),
                       load = respond(simulate, limits, {0, options.load_step}, options);
    const bool to_infinity =
        !options.horizon && limits.u_resolution == 0 && limits.y_resolution == 0 && limits.dead_band == 0;
    built.performance.setpoint = setpoint_figures(setpoint, options.setpoint_step, to_infinity);
    built.performance.load = load_figures(load, to_infinity);
    if (options.points < 2) return;
    const double horizon =
        options.horizon ? *options.horizon : options.trace_horizon.value_or(covering_horizon(setpoint, load));
    built.responses = Responses{trace_of(setpoint, horizon, options.points), trace_of(load, horizon, options.points),
                                setpoint.settles && load.settles};
}

Robustness robustness_of(const SampledLoop& loop) {
    const LoopGrid grid = loop.grid();
    return tunewright::robustness_of(loop.peaks(grid), loop.margins(grid));
}

}  // namespace

Expected<BuiltLoop> evaluate_sampled(const Subject& subject, const SampledPid& law, const ProgramLimits& limits,
                                     const EvaluateOptions& options) {
    const LinearPlant* linear = subject.linear();
    if (linear == nullptr)
        return Error{ErrorKind::unsupported, "implement",
                     "A loop as it is built needs a model of the plant: points of a frequency response do not say what "
                     "lies above half the sampling frequency. Identify a model first."};
    BuiltLoop built;
    const SampledLoop loop(*linear, law);
    const StabilityCount count = loop.count_unstable_poles();
    if (!count.stable()) {
        built.robustness = unstable_robustness(count);
        built.performance = no_performance("The loop as built is unstable.");
        return built;
    }
    built.robustness = robustness_of(loop);
    if (auto error = stopped(options)) return *error;
    const NonlinearSystem* system = subject.equations();
    ProgramLimits all = limits;
    const EvaluateOptions limited = system != nullptr ? limited_as(*system, options) : options;
    if (limited.actuator) all.output = limited.actuator;
    const Simulate simulate = [&](const ProgramLimits& program, const StepInputs& inputs,
                                  std::optional<double> horizon) {
        if (system != nullptr) return simulate_sampled(*system, law, program, inputs, {.horizon = horizon});
        return simulate_sampled(*linear, law, program, inputs, {.horizon = horizon});
    };
    add_performance(built, simulate, all, options);
    return built;
}

std::optional<double> longest_sample_time(const LinearPlant& plant, const ParallelPid& gains, double Ms,
                                          double omega_Ms, double factor) {
    const auto law = [&](double Ts) { return SampledPid{.gains = gains, .Ts = Ts}; };
    // |S| near the continuous loop's peak alone: quick, and right unless another peak takes over.
    const auto near_peak = [&](double Ts) {
        const SampledLoop loop(plant, law(Ts));
        const double highest = loop.highest_frequency();
        const auto S = [&](double omega) { return std::abs(loop.at(omega).S); };
        const double from = std::min(omega_Ms / kPeakMoves, 0.25 * highest);
        const double to = std::min(omega_Ms * kPeakMoves, highest);
        Maximum best{from, S(from)};
        constexpr int kLooks = 8;
        const double ratio = std::pow(to / from, 1.0 / kLooks);
        for (int i = 1; i <= kLooks; ++i) {
            const double omega = i < kLooks ? from * std::pow(ratio, i) : to, value = S(omega);
            if (value > best.value) best = {omega, value};
        }
        if (best.x <= from || best.x >= to) return best.value;
        return log_maximum(S, std::max(from, best.x / ratio), best, std::min(to, best.x * ratio)).value;
    };
    const auto whole = [&](double Ts) {
        const SampledLoop loop(plant, law(Ts));
        if (!loop.count_unstable_poles().stable()) return std::numeric_limits<double>::infinity();
        return loop.peaks(loop.grid()).S.value;
    };
    const auto excess = [&](double Ts) { return std::log(near_peak(Ts) / (factor * Ms)); };
    const double shortest = kShortest / omega_Ms;
    double low = shortest, f_low = excess(low);
    if (f_low > 0) return std::nullopt;
    double high = kFirstSample / omega_Ms, f_high = excess(high);
    while (f_high <= 0 && high < 1e3 / omega_Ms) {
        low = high;
        f_low = f_high;
        high *= 2;
        f_high = excess(high);
    }
    if (f_high <= 0) return std::nullopt;
    double found = log_root(excess, low, high, f_low, f_high, kSampleTolerance);
    // Another peak, or a loop that is unstable: shorter until the whole loop says the same.
    while (found > shortest && !(whole(found) <= factor * Ms * (1 + kWholeLoop))) found *= 0.9;
    return found > shortest ? std::optional(found) : std::nullopt;
}

}  // namespace tunewright
