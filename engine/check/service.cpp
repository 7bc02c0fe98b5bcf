#include "engine/check/service.h"

#include <algorithm>
#include <cmath>

#include "engine/check/thresholds.h"
#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

constexpr double kFarLonger = 50;  // than the median run of equal values

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

struct StillShares {
    double all = 0;      ///< of the samples, in long rests of one value while the other one moves
    double longest = 0;  ///< in one rest that is far longer than the usual ones; 0: none is
};

StillShares still_shares(const std::vector<double>& still, const std::vector<double>& moving) {
    std::size_t rows = 0, longest = 0;
    const auto runs = equal_runs(still);
    for (const EqualRun& run : runs) {
        if (run.length < still_rows(still.size())) continue;
        const auto first = moving.begin() + static_cast<std::ptrdiff_t>(run.begin);
        const auto [low, high] = std::minmax_element(first, first + static_cast<std::ptrdiff_t>(run.length));
        if (!(*high > *low)) continue;
        rows += run.length;
        longest = std::max(longest, run.length);
    }
    std::vector<double> lengths;
    for (const EqualRun& run : runs) lengths.push_back(double(run.length));
    const bool unusual = !lengths.empty() && double(longest) > kFarLonger * median(std::move(lengths));
    const auto count = static_cast<double>(std::max<std::size_t>(1, still.size()));
    return {double(rows) / count, unusual ? double(longest) / count : 0};
}

}  // namespace

std::array<double, 2> limit_shares(const Samples& samples, const OutputRange& range) {
    const auto rows = static_cast<double>(std::max<std::size_t>(1, samples.u.size()));
    const auto low = std::ranges::count_if(samples.u, [&](double u) { return range.at_low(u); });
    const auto high = std::ranges::count_if(samples.u, [&](double u) { return range.at_high(u); });
    return {static_cast<double>(low) / rows, static_cast<double>(high) / rows};
}

std::vector<char> held_output(const Samples& samples, const OutputRange& range, double u_step, const LoopLaw& law) {
    std::vector<char> held(samples.size(), 0);
    for (const EqualRun& run : equal_runs(samples.u)) {
        // Rows without an output of their own say nothing about whether it rests.
        const auto first = samples.moved.begin() + static_cast<std::ptrdiff_t>(run.begin);
        const auto recorded =
            static_cast<std::size_t>(std::count(first, first + static_cast<std::ptrdiff_t>(run.length), 1));
        if (recorded < still_rows(samples.size()) || range.at_limit(samples.u[run.begin])) continue;
        if (double(run.length) < kHeldShare * double(samples.size()) &&
            !should_have_moved(samples, run, law.gain, u_step))
            continue;
        std::fill_n(held.begin() + static_cast<std::ptrdiff_t>(run.begin), run.length, 1);
    }
    return held;
}

ServiceShares service_of(const Samples& samples, const OutputRange& range, double u_step, const LoopLaw& law) {
    ServiceShares shares;
    const auto [low, high] = limit_shares(samples, range);
    shares.saturated_low = low;
    shares.saturated_high = high;
    shares.output_still = share(held_output(samples, range, u_step, law));
    const StillShares still = still_shares(samples.y, samples.u);
    shares.measurement_still = still.all;
    shares.longest_still = still.longest;
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
