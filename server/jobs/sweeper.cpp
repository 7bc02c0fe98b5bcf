#include "server/jobs/sweeper.h"

#include <algorithm>
#include <string>
#include <utility>

#include "server/log.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kSlice = 5000;  // which the store parts again, so that others come between
constexpr std::chrono::milliseconds kBetweenSlices{20};
constexpr int kPauseShare = 4;  // of a slice's time: the pause before the next one
constexpr std::chrono::milliseconds kRest{10'000};
constexpr std::chrono::seconds kJump{60};
constexpr std::chrono::hours kPause{1};

/// Nothing where all are kept for ever.
std::optional<std::chrono::milliseconds> shortest(const Retention& retention) {
    std::optional<std::chrono::milliseconds> found;
    for (const auto& [status, age] : retention.by_state())
        if (age && (!found || *age < *found)) found = age;
    return found;
}

}  // namespace

std::chrono::milliseconds Sweeper::sweep() {
    const std::optional<std::chrono::milliseconds> first = shortest(retention_);
    if (!first) return kRest;
    if (!sweeping_ && more_.exchange(false)) next_ = Clock::now() + pause_.load();
    // While a slice is under way: soon enough for the next one.
    if (sweeping_) return kBetweenSlices;
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(next_ - Clock::now());
    if (wait.count() > 0) return wait;
    sweeping_ = true;
    next_ = Clock::now() + std::min(kRest, *first);
    const UnixMs now = now_();
    if (!store_.shared() && clock_jumped(now)) {
        sweeping_ = false;
        return kBetweenSlices;
    }
    const auto begun = Clock::now();
    store_.sweep(now, retention_, kSlice, [this, begun](const Outcome<std::size_t>& swept) {
        pause_ = std::chrono::ceil<std::chrono::milliseconds>((Clock::now() - begun) / kPauseShare);
        const auto* count = std::get_if<std::size_t>(&swept);
        more_ = count != nullptr && *count >= kSlice;
        sweeping_ = false;
    });
    return kBetweenSlices;
}

/// A clock that was set says nothing about how long a job has been there. A shared store has a clock of its own.
bool Sweeper::clock_jumped(UnixMs now) {
    const auto jump =
        std::chrono::duration_cast<std::chrono::seconds>(drift_.since_last(now).value_or(std::chrono::milliseconds(0)));
    if (std::chrono::abs(jump) <= kJump) return false;
    next_ = Clock::now() + kPause;
    log_error("the clock of this machine was set by " + std::to_string(jump.count()) +
              " s; for an hour no ended job is deleted. Stop the service within that time if the clock is wrong");
    return true;
}

}  // namespace tunewright::server
