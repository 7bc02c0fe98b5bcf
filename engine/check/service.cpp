#include "engine/check/service.h"

#include <algorithm>
#include <cmath>

#include "engine/check/thresholds.h"

namespace tunewright::check {
namespace {

constexpr double kUnknownLimit = 0.05;  // of the output's range as seen

double share(const std::vector<char>& marks) {
    return marks.empty() ? 0 : static_cast<double>(std::ranges::count(marks, 1)) / static_cast<double>(marks.size());
}

std::size_t still_rows(std::size_t rows) {
    return std::max(kStillRows, static_cast<std::size_t>(kStillShare * static_cast<double>(rows)));
}

/// True if the proportional part alone would have moved the output by some of its steps: an output that rests while the
/// measurement rests too is only rounded.
bool should_have_moved(const Samples& samples, const EqualRun& run, double gain, double step) {
    const auto y = std::span(samples.y).subspan(run.begin, run.length);
    const auto [low, high] = std::ranges::minmax(y);
    return std::abs(gain) * (high - low) >= kHeldSteps * step;
}

double limit_share(const Samples& samples, double limit, double near) {
    const auto at = std::ranges::count_if(samples.u, [&](double u) { return std::abs(u - limit) <= near; });
    return static_cast<double>(at) / static_cast<double>(std::max<std::size_t>(1, samples.u.size()));
}

/// The share of samples in long rests of one value while the other one moves.
double still_share(const std::vector<double>& still, const std::vector<double>& moving) {
    std::size_t rows = 0;
    for (const EqualRun& run : equal_runs(still)) {
        if (run.length < still_rows(still.size())) continue;
        const auto first = moving.begin() + static_cast<std::ptrdiff_t>(run.begin);
        const auto [low, high] = std::minmax_element(first, first + static_cast<std::ptrdiff_t>(run.length));
        if (*high > *low) rows += run.length;
    }
    return static_cast<double>(rows) / static_cast<double>(std::max<std::size_t>(1, still.size()));
}

}  // namespace

std::array<double, 2> output_range(const LoopQuestion& question, const Samples& samples) {
    if (question.u_range) return *question.u_range;
    if (samples.u.empty()) return {0, 100};
    const auto [low, high] = std::ranges::minmax(samples.u);
    const double full = high > 1 ? 100 : 1;
    if (low >= 0 && high <= full) return {0, full};
    // In another unit the limits are unknown: a little beyond what was seen, so that nothing counts as at a limit.
    const double beyond = kUnknownLimit * (high - low);
    return {low - beyond, high + beyond};
}

std::array<double, 2> limit_shares(const Samples& samples, const std::array<double, 2>& u_range) {
    const double near = kAtLimit * (u_range[1] - u_range[0]);
    return {limit_share(samples, u_range[0], near), limit_share(samples, u_range[1], near)};
}

std::vector<char> held_output(const Samples& samples, const std::array<double, 2>& u_range, double u_step,
                              const LoopLaw& law) {
    std::vector<char> held(samples.size(), 0);
    const double near = kAtLimit * (u_range[1] - u_range[0]);
    for (const EqualRun& run : equal_runs(samples.u)) {
        const double u = samples.u[run.begin];
        if (run.length < still_rows(samples.size()) || u <= u_range[0] + near || u >= u_range[1] - near) continue;
        if (double(run.length) < kHeldShare * double(samples.size()) &&
            !should_have_moved(samples, run, law.gain, u_step))
            continue;
        std::fill_n(held.begin() + static_cast<std::ptrdiff_t>(run.begin), run.length, 1);
    }
    return held;
}

ServiceShares service_of(const Samples& samples, const std::array<double, 2>& u_range, double u_step,
                         const LoopLaw& law) {
    ServiceShares shares;
    const auto [low, high] = limit_shares(samples, u_range);
    shares.saturated_low = low;
    shares.saturated_high = high;
    shares.output_still = share(held_output(samples, u_range, u_step, law));
    shares.measurement_still = still_share(samples.y, samples.u);
    if (samples.automatic.empty()) {
        shares.automatic = no_figure("The record has no column of the mode.");
        shares.manual = no_figure("The record has no column of the mode.");
    } else {
        shares.automatic = share(samples.automatic);
        shares.manual = 1 - *shares.automatic;
    }
    return shares;
}

}  // namespace tunewright::check
