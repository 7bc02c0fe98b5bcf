#include "server/jobs/sweeper.h"

#include <algorithm>

namespace tunewright::server {
namespace {

constexpr std::size_t kSlice = 100;
constexpr std::chrono::milliseconds kBetweenSlices{100};
constexpr std::chrono::milliseconds kRest{10'000};

}  // namespace

std::chrono::milliseconds Sweeper::sweep() {
    if (!retention_) return kRest;
    if (more_.exchange(false)) next_ = Clock::now() + kBetweenSlices;
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(next_ - Clock::now());
    // While a slice is under way: soon enough for the next one.
    if (wait.count() > 0 || sweeping_.exchange(true)) return std::max(wait, kBetweenSlices);
    next_ = Clock::now() + std::min<std::chrono::milliseconds>(kRest, *retention_);
    const UnixMs ended_before = now_() - std::chrono::milliseconds(*retention_).count();
    store_.sweep(ended_before, kSlice, [this](const Outcome<std::size_t>& swept) {
        const auto* count = std::get_if<std::size_t>(&swept);
        more_ = count != nullptr && *count >= kSlice;
        sweeping_ = false;
    });
    return kBetweenSlices;
}

}  // namespace tunewright::server
