#include "server/jobs/sweeper.h"

#include <algorithm>
#include <string>
#include <utility>

#include "server/log.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kSweepSlice = 5000;  // the store divides it into smaller slices, so that other writes run in
                                           // between
constexpr std::chrono::milliseconds kBetweenSlices{20};
constexpr int kPauseShare = 4;  // of a slice's time: the pause before the next one
constexpr std::chrono::milliseconds kMaxRest{10'000};
constexpr std::chrono::seconds kMaxClockJump{60};
constexpr std::chrono::hours kPauseAfterJump{1};

/// Empty if all are kept forever.
std::optional<std::chrono::milliseconds> shortest(const Retention& retention) {
    std::optional<std::chrono::milliseconds> found;
    for (const auto& [status, age] : retention.by_state())
        if (age && (!found || *age < *found)) found = age;
    return found;
}

}  // namespace

std::chrono::milliseconds Sweeper::sweep() {
    const std::optional<std::chrono::milliseconds> first = shortest(retention_);
    if (!first) return kMaxRest;
    if (!sweeping_ && more_.exchange(false)) next_ = Clock::now() + pause_.load();
    // While a slice is in progress: soon enough for the next one.
    if (sweeping_) return kBetweenSlices;
    if (!next_) next_ = Clock::now() + before_first();
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(*next_ - Clock::now());
    if (wait.count() > 0) return wait;
    sweeping_ = true;
    next_ = Clock::now() + std::min(kMaxRest, *first);
    const UnixMs now = now_();
    if (!store_.shared() && clock_jumped(now)) {
        sweeping_ = false;
        return kBetweenSlices;
    }
    const auto begun = Clock::now();
    store_.sweep(now, retention_, kSweepSlice, [this, begun](const Outcome<std::size_t>& outcome) {
        pause_ = std::chrono::ceil<std::chrono::milliseconds>((Clock::now() - begun) / kPauseShare);
        const auto* count = std::get_if<std::size_t>(&outcome);
        more_ = count != nullptr && *count >= kSweepSlice;
        if (count != nullptr) swept(*count);
        sweeping_ = false;
    });
    return kBetweenSlices;
}

/// A machine that has just been started may have a wrong clock, which is set soon after, and a new process has not seen
/// a jump of the clock: the first deletion waits as long as after a jump.
std::chrono::milliseconds Sweeper::before_first() const {
    if (store_.shared()) return std::chrono::milliseconds(0);
    return std::min<std::chrono::milliseconds>(kPauseAfterJump, *shortest(retention_));
}

/// The log reports what the first sweep deleted: after a long absence of the process, or a jump of its clock, that is
/// much at once.
void Sweeper::swept(std::size_t count) {
    if (!first_) return;
    *first_ += count;
    if (more_) return;
    if (*first_ > 0)
        log_info("the first sweep since the start has deleted " + std::to_string(*first_) +
                 " ended jobs whose --retention was over");
    first_.reset();
}

/// A clock that was set gives no information about the age of a job. A shared store has a clock of its own.
bool Sweeper::clock_jumped(UnixMs now) {
    const auto jump =
        std::chrono::duration_cast<std::chrono::seconds>(drift_.since_last(now).value_or(std::chrono::milliseconds(0)));
    if (std::chrono::abs(jump) <= kMaxClockJump) return false;
    next_ = Clock::now() + kPauseAfterJump;
    log_error("the clock of this machine was set by " + std::to_string(jump.count()) +
              " s; for an hour no ended job is deleted. Stop the service within that time if the clock is wrong");
    return true;
}

}  // namespace tunewright::server
