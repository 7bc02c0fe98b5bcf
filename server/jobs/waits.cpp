#include "server/jobs/waits.h"

#include <algorithm>

namespace tunewright::server {

void Waits::add(const std::string& id, std::chrono::duration<double> wait, WaitEnd ended) {
    auto waiter = std::make_shared<Waiter>();
    waiter->ended = std::move(ended);
    const std::lock_guard lock(mutex_);
    waiter->timeout = timer_.after(wait, [this, id, waiter] {
        {
            const std::lock_guard inner(mutex_);
            const auto [first, last] = waiters_.equal_range(id);
            const auto found = std::find_if(first, last, [&](const auto& item) { return item.second == waiter; });
            if (found == last) return;
            waiters_.erase(found);
        }
        waiter->ended(nullptr);
    });
    waiters_.emplace(id, waiter);
}

Waits::Waiters Waits::take(const std::string& id) {
    Waiters taken;
    const std::lock_guard lock(mutex_);
    const auto [first, last] = waiters_.equal_range(id);
    for (auto it = first; it != last; ++it) taken.push_back(it->second);
    waiters_.erase(first, last);
    return taken;
}

void Waits::tell(const Waiters& waiters, const std::shared_ptr<const JobRecord>& job) {
    for (const auto& waiter : waiters) {
        timer_.cancel(waiter->timeout);
        waiter->ended(job);
    }
}

void Waits::notify(const std::string& id, const std::function<JobRecord()>& job) {
    const Waiters waiters = take(id);
    if (!waiters.empty()) tell(waiters, std::make_shared<const JobRecord>(job()));
}

void Waits::tell_all() {
    std::multimap<std::string, std::shared_ptr<Waiter>> notified;
    {
        const std::lock_guard lock(mutex_);
        notified.swap(waiters_);
    }
    for (const auto& [id, waiter] : notified) tell({waiter}, nullptr);
}

std::vector<std::string> Waits::ids() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> ids;
    for (auto it = waiters_.begin(); it != waiters_.end(); it = waiters_.upper_bound(it->first))
        ids.push_back(it->first);
    return ids;
}

}  // namespace tunewright::server
