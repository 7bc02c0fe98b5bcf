#include "engine/check/output_range.h"

#include <algorithm>

namespace tunewright::check {
namespace {

constexpr double kBeyondFull = 0.05;    // of the range: a controller's output may go so far beyond 0 and 100 %
constexpr double kUnknownLimit = 0.05;  // of the output's range as seen
constexpr int kFewestVisits = 3;

/// True if the output rests at this extreme of it for much of the time, in automatic or on several visits: somebody who
/// holds it by hand leaves it where it is.
bool rests_at(const Samples& samples, double extreme) {
    std::size_t rows = 0, automatic = 0;
    int visits = 0;
    for (const EqualRun& run : equal_runs(samples.u)) {
        if (samples.u[run.begin] != extreme || run.length < kStillRows) continue;
        rows += run.length;
        ++visits;
        for (std::size_t i = run.begin; i < run.begin + run.length && !samples.automatic.empty(); ++i)
            automatic += samples.automatic[i] ? 1 : 0;
    }
    const bool much = double(rows) >= kSaturatedShare * double(samples.u.size());
    return much && (visits >= kFewestVisits || 2 * automatic > rows);
}

/// From 0 to 100 or to 1 by the size of the values; else unknown.
OutputRange usual_range(double low, double high) {
    const double full = high > 1 + kBeyondFull ? 100 : 1;
    if (low >= -kBeyondFull * full && high <= (1 + kBeyondFull) * full) return {0, full};
    const double beyond = high > low ? kUnknownLimit * (high - low) : 1;
    return {low - beyond, high + beyond, false, false, false};
}

}  // namespace

OutputRange output_range(const LoopQuestion& question, const Samples& samples) {
    if (question.u_range) return {(*question.u_range)[0], (*question.u_range)[1]};
    if (const auto& limits = question.record.u_limits) return {(*limits)[0], (*limits)[1]};
    if (samples.u.empty()) return {};
    const auto [low, high] = std::ranges::minmax(samples.u);
    OutputRange range = usual_range(low, high);
    if (!(high > low)) return range;
    const bool at_low = rests_at(samples, low), at_high = rests_at(samples, high);
    if (at_low) range.low = low;
    if (at_high) range.high = high;
    range.known = range.known || (at_low && at_high);
    range.low_known = range.known || at_low;
    range.high_known = range.known || at_high;
    return range;
}

}  // namespace tunewright::check
