#include "engine/evaluation/measured_response.h"

#include <algorithm>
#include <cmath>

#include "engine/simulation/linear/indices.h"

namespace tunewright {
namespace {

constexpr int kMaxRefinements = 5;
constexpr double kHalvedSteps = 1.0 / 16;  // factor of the tolerance that halves the steps of a method of order 4
constexpr double kMaxTailShare = 1e-6;     // of the integral of t |e|, remaining after the run's end
constexpr std::size_t kMaxNodes = 1000000;
constexpr double kMoreNodes = 1.4;
constexpr int kMaxTightenings = 3;

double relative(double coarse, double fine) {
    const double size = std::max(std::abs(coarse), std::abs(fine));
    return size > 0 ? std::abs(fine - coarse) / size : 0;
}

IndexErrors moved(const Indices& coarse, const Indices& fine) {
    IndexErrors errors;
    errors.TV = relative(coarse.TV, fine.TV);
    if (!coarse.error || !fine.error) return errors;
    errors.IAE = relative(coarse.error->IAE, fine.error->IAE);
    errors.ISE = relative(coarse.error->ISE, fine.error->ISE);
    errors.ITAE = relative(coarse.error->ITAE, fine.error->ITAE);
    return errors;
}

bool within_max_errors(const IndexErrors& errors) {
    return errors.IAE.value_or(0) <= kMaxIaeError && errors.ISE.value_or(0) <= kMaxIseError &&
           errors.ITAE.value_or(0) <= kMaxItaeError && errors.TV.value_or(0) <= kMaxTvError;
}

/// The same instants and those halfway between.
StepSchedule halved(const StepSchedule& schedule) {
    StepSchedule finer{.h0 = schedule.h0 / 2, .level = {}, .to_horizon = 2 * schedule.to_horizon};
    finer.level.reserve(2 * schedule.level.size());
    for (const auto level : schedule.level) finer.level.insert(finer.level.end(), 2, level);
    return finer;
}

/// Repeats the run on the halved schedule. Without a schedule it lowers the tolerance until the run really has more
/// steps, because step lengths in powers of two may meet a lower tolerance unchanged.
StepResponse refined(const Simulate& simulate, ResponseOptions& options, const StepResponse& response) {
    if (response.schedule.level.empty() && response.schedule.to_horizon == 0) {
        StepResponse finer;
        for (int i = 0; i < kMaxTightenings; ++i) {
            options.tolerance *= kHalvedSteps;
            finer = simulate(options);
            if (static_cast<double>(finer.nodes.size()) > kMoreNodes * static_cast<double>(response.nodes.size()))
                break;
        }
        return finer;
    }
    const StepSchedule finer = halved(response.schedule);
    ResponseOptions repeat = options;
    repeat.repeat = &finer;
    return simulate(repeat);
}

}  // namespace

bool is_accurate(const MeasuredResponse& measured) {
    return !measured.response.settles || (measured.errors.TV && within_max_errors(measured.errors));
}

MeasuredResponse measure(const Simulate& simulate, ResponseOptions options, double target) {
    options.tail = kMaxTailShare;
    const bool to_infinity = !options.horizon;
    MeasuredResponse measured{.response = simulate(options), .errors = {}, .indices = {}};
    if (!measured.response.settles) return measured;
    measured.indices = indices_of(measured.response, target, to_infinity);
    for (int i = 0; i < kMaxRefinements && measured.response.nodes.size() < kMaxNodes; ++i) {
        StepResponse finer = refined(simulate, options, measured.response);
        if (!finer.settles) break;
        const Indices now = indices_of(finer, target, to_infinity);
        measured = {.response = std::move(finer), .errors = moved(*measured.indices, now), .indices = now};
        if (within_max_errors(measured.errors)) break;
    }
    return measured;
}

}  // namespace tunewright
