#include "engine/check/output_range.h"

#include <algorithm>

namespace tunewright::check {
namespace {

constexpr double kBeyondFull = 0.05;    // of the range: a controller's output may go so far beyond 0 and 100 %
constexpr double kUnknownLimit = 0.05;  // of the output's range as seen

}  // namespace

OutputRange output_range(const LoopQuestion& question, const Samples& samples) {
    if (question.u_range) return {(*question.u_range)[0], (*question.u_range)[1]};
    if (const auto& limits = question.record.u_limits) return {(*limits)[0], (*limits)[1]};
    if (samples.u.empty()) return {};
    const auto [low, high] = std::ranges::minmax(samples.u);
    const double full = high > 1 + kBeyondFull ? 100 : 1;
    if (low >= -kBeyondFull * full && high <= (1 + kBeyondFull) * full) return {0, full};
    const double beyond = high > low ? kUnknownLimit * (high - low) : 1;
    return {low - beyond, high + beyond, false};
}

}  // namespace tunewright::check
