#include "server/jobs/running/claims.h"

#include <algorithm>
#include <utility>

namespace tunewright::server {
namespace {

constexpr double kShortJobSeconds = 0.020;
constexpr double kWorkAheadSeconds = 0.050;  // of work that is claimed ahead for one worker
constexpr std::size_t kMaxAhead = 16;
// One claim in kLowShare takes a job of low priority first, so that batches progress however many single jobs arrive.
constexpr std::uint64_t kLowShare = 8;
constexpr double kPaceForgetting = 0.2;
// If no worker has taken a job for this long, all workers are busy with long jobs, however short the latest ones were.
constexpr std::chrono::milliseconds kMaxTimeSinceTake{25};
constexpr std::chrono::seconds kMaxPoliteWait{
    10};  // waiting time of jobs that must run alone, for a process that is never idle

}  // namespace

Claims::Claims(JobQueue& queue, HeldJobs& held, StoreOutageLog& outage, ClaimSettings settings)
    : queue_(queue), held_(held), outage_(outage), settings_(std::move(settings)) {}

std::shared_ptr<HeldJob> Claims::take(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    idle_++;
    ask(lock);
    // A single job that has just arrived is claimed before an entry of a batch is begun.
    const auto there = [this] { return closed_ || (!ready_.empty() && !(urgent() && asking_for_arrivals_)); };
    const bool found = changed_.wait(lock, stop, there);
    idle_--;
    if (!found || closed_ || ready_.empty()) return nullptr;
    std::shared_ptr<HeldJob> next = std::move(ready_.front());
    ready_.pop_front();
    last_take_ = HeldJob::Clock::now();
    ask(lock);
    return next;
}

void Claims::arrived() {
    std::unique_lock lock(mutex_);
    arrivals_++;
    ask(lock);
}

void Claims::took(double seconds, bool whole) {
    const std::lock_guard lock(mutex_);
    // A stopped job would have taken longer: only a lower bound of its time is known.
    if (whole || seconds > pace_) pace_ = std::max(seconds, (1 - kPaceForgetting) * pace_ + kPaceForgetting * seconds);
    streak_ = pace_ < kShortJobSeconds ? streak_ + 1 : 0;
}

void Claims::unsaved(std::size_t bytes) {
    std::unique_lock lock(mutex_);
    unsaved_ = bytes;
    ask(lock);
}

void Claims::retry() {
    std::unique_lock lock(mutex_);
    failed_ = false;
    ask(lock);
}

void Claims::suspects(std::size_t waiting) {
    std::unique_lock lock(mutex_);
    if (suspects_ == 0) suspects_since_ = HeldJob::Clock::now();
    suspects_ = alone_ ? 0 : waiting;
    if (suspects_ > 0) ask(lock);
}

void Claims::freed() {
    std::unique_lock lock(mutex_);
    if (alone_ || suspects_ > 0) ask(lock);
}

double Claims::pace() const {
    const std::lock_guard lock(mutex_);
    return pace_;
}

bool Claims::urgent() const { return !ready_.empty() && !ready_.front()->goes_first; }

std::size_t Claims::ahead() const {
    if (!more_ || HeldJob::Clock::now() > last_take_ + kMaxTimeSinceTake) return 0;
    return std::min({kMaxAhead, streak_, static_cast<std::size_t>(kWorkAheadSeconds / std::max(pace_, 1e-4))});
}

std::size_t Claims::wanted() const {
    const std::size_t enough = idle_ + ahead();
    // Half of the jobs claimed ahead are used before more are claimed: several at once cost as much as one.
    if (ready_.size() < idle_ || ready_.size() <= enough / 2) return enough - std::min(enough, ready_.size());
    const bool overtaking = arrivals_ != seen_ && urgent();
    return overtaking && enough > 0 ? 1 : 0;
}

bool Claims::suspects_turn(std::size_t held) const { return suspects_ > 0 && held == 0 && idle_ > 0; }

/// True if no job is to be claimed: one runs alone, or one that must run alone has waited long enough.
bool Claims::keeps_clear(std::size_t held) const {
    return held > 0 && (alone_ || (suspects_ > 0 && HeldJob::Clock::now() > suspects_since_ + kMaxPoliteWait));
}

/// Called with the lock and returns with it; releases it while it asks the store.
void Claims::ask(std::unique_lock<std::mutex>& lock) {
    const std::size_t held = held_.size();
    alone_ = alone_ && held > 0;
    const bool suspects = suspects_turn(held);
    if (closed_ || asking_ || failed_ || !(more_ || arrivals_ != seen_ || suspects) || keeps_clear(held)) return;
    if (held >= settings_.max_held || unsaved_ >= settings_.max_unsaved) return;
    std::size_t max = suspects ? 1 : std::min(wanted(), settings_.max_held - held);
    if (max == 0) return;
    // Only one job then, and new arrivals still have to be claimed.
    const bool low_first = !suspects && ++claims_ % kLowShare == 0;
    if (low_first) max = 1;
    asking_ = true;
    asking_for_suspects_ = suspects;
    asking_for_arrivals_ = !suspects && !low_first && arrivals_ != seen_;
    if (!suspects && !low_first) seen_ = arrivals_;
    lock.unlock();
    queue_.claim(
        {settings_.worker, settings_.now(), settings_.lease, max, suspects, low_first},
        [this, max, low_first](Outcome<std::vector<JobRecord>> outcome) { come(std::move(outcome), max, low_first); });
    lock.lock();
}

void Claims::come(Outcome<std::vector<JobRecord>> outcome, std::size_t asked, bool low_first) {
    auto* jobs = std::get_if<std::vector<JobRecord>>(&outcome);
    if (jobs != nullptr) {
        if (!jobs->empty()) {
            outage_.worked();
            settings_.claimed(*jobs);
        }
    } else {
        outage_.failed("no job can be claimed", std::get<StoreFault>(outcome));
    }
    std::vector<std::shared_ptr<HeldJob>> late;
    std::unique_lock lock(mutex_);
    asking_ = asking_for_arrivals_ = false;
    failed_ = jobs == nullptr;
    if (std::exchange(asking_for_suspects_, false)) {
        // Other processes may have taken it; the next count shows that.
        suspects_ = 0;
        alone_ = jobs != nullptr && !jobs->empty();
        arrivals_++;
        asked = jobs != nullptr ? jobs->size() + 1 : asked;
    }
    if (failed_) arrivals_++;  // so that retry() asks again
    if (jobs != nullptr) {
        more_ = jobs->size() >= asked;
        // Jobs of another kind may follow when these are done.
        if (!more_) streak_ /= 2;
        for (JobRecord& job : *jobs) {
            // Registered on the store's thread: a cancellation that the store sees later finds the job here.
            const bool goes_first = low_first || job.batch.empty();
            std::shared_ptr<HeldJob> held = held_.add(std::move(job), goes_first);
            closed_ ? late.push_back(std::move(held)) : put(std::move(held));
        }
    }
    ask(lock);
    lock.unlock();
    changed_.notify_all();
    for (auto& held : late) settings_.late(std::move(held));
}

void Claims::put(std::shared_ptr<HeldJob> held) {
    const auto place = std::find_if(ready_.begin(), ready_.end(),
                                    [&](const auto& other) { return held->goes_first && !other->goes_first; });
    ready_.insert(place, std::move(held));
}

std::vector<std::shared_ptr<HeldJob>> Claims::withdraw(HeldJob::Clock::time_point before) {
    const std::lock_guard lock(mutex_);
    std::vector<std::shared_ptr<HeldJob>> taken;
    std::erase_if(ready_, [&](const auto& held) {
        const bool old = held->claimed_at < before;
        if (old) taken.push_back(held);
        return old;
    });
    return taken;
}

bool Claims::withdraw(const std::shared_ptr<HeldJob>& held) {
    const std::lock_guard lock(mutex_);
    return std::erase(ready_, held) > 0;
}

std::vector<std::shared_ptr<HeldJob>> Claims::close(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    closed_ = true;
    std::vector<std::shared_ptr<HeldJob>> left(ready_.begin(), ready_.end());
    ready_.clear();
    changed_.notify_all();
    changed_.wait_for(lock, patience, [this] { return !asking_; });
    return left;
}

}  // namespace tunewright::server
