#include "engine/evaluation/evaluate_sampled.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "engine/evaluation/evaluate_nonlinear.h"
#include "engine/evaluation/evaluation_start.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/evaluation/robustness_figures.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "engine/numerics/sign_change.h"
#include "engine/simulation/sampled/sampled_nonlinear.h"
#include "engine/simulation/sampled/sampled_response.h"

namespace tunewright {
namespace {

constexpr double kFirstSample = 0.1;  // of 1/omega_Ms: where the search for the longest sample time starts
constexpr double kShortest = 1e-3;    // of 1/omega_Ms
constexpr double kLongest = 1e3;      // of 1/omega_Ms: where it ends
constexpr double kFirstLook = 0.1;    // of 1/omega_Ms: from there on the whole loop is looked at
constexpr double kLookRatio = 1.4;    // of the sample times at which it is
constexpr double kFarBelow = -0.02;   // of ln Ms below its limit: no closer look is worth it there
constexpr int kHalvings = 2;          // of a step between two looks
constexpr double kSampleTolerance = 1e-4;
constexpr double kNearEnough = 3e-4;  // of ln Ms

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
    const LoopGrid grid = loop.grid();
    const StabilityCount count = loop.count_unstable_poles(grid);
    if (!count.stable()) {
        built.robustness = unstable_robustness(count);
        built.performance = no_performance("The loop as built is unstable.");
        return built;
    }
    built.robustness = robustness_of(loop.peaks(grid), loop.margins(grid));
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

namespace {

/// |S| at the top of its hill near where it was last, as the sample time changes: by a parabola through three points in
/// ln omega, good to 1e-4 and quick. Another hill that takes over is not seen.
class TrackedPeak {
public:
    TrackedPeak(const LinearPlant& plant, const ParallelPid& gains, double omega)
        : plant_(plant), gains_(gains), omega_(omega) {}

    double at(double Ts) {
        const SampledLoop loop(plant_, {.gains = gains_, .Ts = Ts});
        const double highest = loop.highest_frequency();
        const auto S = [&](double omega) { return std::abs(loop.at(std::min(omega, highest)).S); };
        omega_ = std::min(omega_, highest / kStep);
        double below = S(omega_ / kStep), here = S(omega_), above = S(omega_ * kStep);
        for (int i = 0; i < kMostSteps && (below > here || above > here); ++i) {
            const bool up = above > below;
            if (up && omega_ * kStep * kStep > highest) break;
            omega_ *= up ? kStep : 1 / kStep;
            (up ? below : above) = here;
            here = up ? above : below;
            (up ? above : below) = S(up ? omega_ * kStep : omega_ / kStep);
        }
        const double bend = below - 2 * here + above, slope = 0.5 * (above - below);
        return bend < 0 ? here - 0.5 * slope * slope / bend : std::max({below, here, above});
    }

private:
    static constexpr double kStep = 1.12;
    static constexpr int kMostSteps = 30;
    const LinearPlant& plant_;
    ParallelPid gains_;
    double omega_;
};

double whole_peak(const LinearPlant& plant, const ParallelPid& gains, double Ts) {
    const SampledLoop loop(plant, {.gains = gains, .Ts = Ts});
    const LoopGrid grid = loop.grid();
    if (!loop.count_unstable_poles(grid).stable()) return std::numeric_limits<double>::infinity();
    return loop.peaks(grid).S.value;
}

}  // namespace

namespace {

struct Look {
    double Ts = 0, excess = 0;
};

/// Two sample times between these between which the excess first rises above 0: looked for where it comes near.
std::optional<std::pair<Look, Look>> excess_between(const std::function<double(double)>& of_loop, const Look& left,
                                                    const Look& right, int halvings) {
    if (halvings == 0 || std::max(left.excess, std::min(right.excess, 0.0)) < kFarBelow) return std::nullopt;
    const double Ts = std::sqrt(left.Ts * right.Ts);
    const Look middle{Ts, of_loop(Ts)};
    if (auto first = excess_between(of_loop, left, middle, halvings - 1)) return first;
    if (middle.excess > 0) return std::pair(left, middle);
    return excess_between(of_loop, middle, right, halvings - 1);
}

}  // namespace

std::optional<double> longest_sample_time(const LinearPlant& plant, const ParallelPid& gains, double Ms,
                                          double omega_Ms, double factor) {
    const double longest = kLongest / omega_Ms;
    // Near the continuous loop's peak alone, to know where to look.
    TrackedPeak peak(plant, gains, omega_Ms);
    const auto of_peak = [&](double Ts) { return std::log(peak.at(Ts) / (factor * Ms)); };
    double low = 0, f_low = -std::log(factor), high = kFirstSample / omega_Ms, f_high = of_peak(high);
    while (f_high <= 0 && high < longest) {
        low = high;
        f_low = f_high;
        high *= 2;
        f_high = of_peak(high);
    }
    const double guess = f_high > 0 ? root_between(of_peak, low, high, f_low, f_high, kSampleTolerance * high) : high;
    // The whole loop: another peak may take over, or come and go, at shorter sample times too.
    const auto of_loop = [&](double Ts) { return std::log(whole_peak(plant, gains, Ts) / (factor * Ms)); };
    const int looks = std::max(0, static_cast<int>(std::log(guess * omega_Ms / kFirstLook) / std::log(kLookRatio)));
    Look left{guess * std::pow(kLookRatio, -looks), 0}, right;
    left.excess = of_loop(left.Ts);
    for (right = left; left.excess > 0; left = {0.5 * left.Ts, of_loop(0.5 * left.Ts)}) {
        if (left.Ts < 2 * kShortest / omega_Ms) return std::nullopt;
        right = left;
    }
    for (int i = looks - 1; right.excess <= 0; --i) {
        if (right.Ts >= longest) return std::nullopt;
        left = right;
        right.Ts = i == 0 ? guess : guess * std::pow(kLookRatio, -i);
        right.excess = of_loop(right.Ts);
        if (const auto between = excess_between(of_loop, left, right, kHalvings)) {
            std::tie(left, right) = *between;
        } else if (i == 0 && std::abs(right.excess) <= kNearEnough) {
            return guess;
        }
    }
    return log_root(of_loop, left.Ts, right.Ts, left.excess, right.excess, kSampleTolerance);
}

}  // namespace tunewright
