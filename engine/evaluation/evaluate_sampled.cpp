#include "engine/evaluation/evaluate_sampled.h"

#include <algorithm>
#include <cmath>

#include "engine/evaluation/course.h"
#include "engine/evaluation/evaluate_nonlinear.h"
#include "engine/evaluation/evaluation_start.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/evaluation/robustness_figures.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "engine/numerics/sign_change.h"
#include "engine/simulation/sampled/sampled_response.h"

namespace tunewright {
namespace {

constexpr double kFirstSample = 0.1;   // of 1/omega_Ms: where the search for the longest sample time starts
constexpr double kShortest = 1e-3;     // of 1/omega_Ms
constexpr double kLongest = 1e3;       // of 1/omega_Ms: where it ends
constexpr double kShorter = 0.6;       // of a sample time: a shorter one that the whole loop must bear too
constexpr double kLightDamping = 0.5;  // of a pole
constexpr double kNext = 1.1;          // from one sample time to the next, where they are looked at one by one
constexpr double kSampleTolerance = 5e-5;
constexpr double kWholeLoop = 1e-3;  // relative: how far the whole loop's Ms may be from that of the guess

using Simulate = std::function<StepResponse(const ProgramLimits&, const StepInputs&, std::optional<double> horizon)>;

/// Resolutions and dead bands keep a loop moving about its rest.
bool rests(const ProgramLimits& limits) {
    return limits.u_resolution == 0 && limits.y_resolution == 0 && limits.dead_band == 0;
}

Run run_of(StepResponse response, const ProgramLimits& limits) {
    Run run = Run::of(std::move(response));
    if (!rests(limits)) run.known_to = run.response.nodes.back().t;
    return run;
}

StepResponse respond(const Simulate& simulate, const ProgramLimits& limits, const StepInputs& inputs,
                     const EvaluateOptions& options) {
    std::optional<double> horizon = options.horizon;
    if (rests(limits) || horizon) return simulate(limits, inputs, horizon);
    const StepResponse without = simulate({limits.output, 0, 0, 0}, inputs, horizon);
    return simulate(limits, inputs, without.nodes.back().t);
}

void add_performance(BuiltLoop& built, const Simulate& simulate, const ProgramLimits& limits,
                     const EvaluateOptions& options) {
    StepResponse setpoint = respond(simulate, limits, {options.setpoint_step, 0}, options),
                 load = respond(simulate, limits, {0, options.load_step}, options);
    const bool to_infinity = !options.horizon && rests(limits);
    built.performance.setpoint = setpoint_figures(setpoint, options.setpoint_step, to_infinity);
    built.performance.load = load_figures(load, to_infinity);
    built.responses = drawn(run_of(std::move(setpoint), limits), run_of(std::move(load), limits), options);
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
        built.performance = no_performance("On the controller as it is built the loop is unstable.");
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

/// A lightly damped mode is sampled well and badly in turns as the sample time grows.
bool resonates(const LinearPlant& plant) {
    return std::ranges::any_of(plant.poles(), [](std::complex<double> pole) {
        return std::abs(pole.real()) < kLightDamping * std::abs(pole);
    });
}

}  // namespace

std::optional<double> longest_sample_time(const LinearPlant& plant, const ParallelPid& gains, double Ms,
                                          double omega_Ms, double factor) {
    const double f_0 = -std::log(factor), shortest = kShortest / omega_Ms, longest = kLongest / omega_Ms;
    const auto whole = [&](double Ts) {
        return std::log(SampledLoop(plant, {.gains = gains, .Ts = Ts}).Ms() / (factor * Ms));
    };
    // Where nothing resonates the continuous loop's own peak decides, nearly: a guess from it alone, which the whole
    // loop confirms.
    TrackedPeak peak(plant, gains, omega_Ms);
    const auto near_peak = [&](double Ts) { return std::log(peak.at(Ts) / (factor * Ms)); };
    double high = kFirstSample / omega_Ms, f_high = near_peak(high), low = shortest, f_low = 0;
    while (f_high <= 0 && high < longest) f_high = near_peak(high *= 2);
    if (f_high > 0 && !resonates(plant)) {
        const double guess = root_between(near_peak, 0, high, f_0, f_high, kSampleTolerance * high);
        low = std::max(kShorter * guess, shortest);
        f_low = whole(low);
        if (f_low <= 0 && std::abs(whole(guess)) <= kWholeLoop) return guess;
        // Another peak of the loop has become the higher one: what is looked for lies not far below.
        while (low > shortest) {
            const double lower = std::max(kShorter * low, shortest), f_lower = whole(lower);
            if (f_low <= 0 && f_lower <= 0) break;
            low = lower;
            f_low = f_lower;
        }
    } else {
        f_low = whole(low);
    }
    // The first sample time, from short ones on, that the whole loop does not bear.
    if (f_low > 0) return std::nullopt;
    for (high = low * kNext; (f_high = whole(high)) <= 0; high *= kNext) {
        if (high > longest) return std::nullopt;
        low = high;
        f_low = f_high;
    }
    return root_between(whole, low, high, f_low, std::min(f_high, 1.0), kSampleTolerance * high);
}

}  // namespace tunewright
