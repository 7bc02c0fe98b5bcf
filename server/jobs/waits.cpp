#include "server/jobs/waits.h"

#include <algorithm>

namespace tunewright::server {

void Waits::add(const std::string& id, std::chrono::duration<double> wait, std::function<void()> ended) {
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
        waiter->ended();
    });
    waiters_.emplace(id, waiter);
}

void Waits::notify(const std::string& id) {
    std::vector<std::shared_ptr<Waiter>> notified;
    {
        const std::lock_guard lock(mutex_);
        const auto [first, last] = waiters_.equal_range(id);
        for (auto it = first; it != last; ++it) notified.push_back(it->second);
        waiters_.erase(first, last);
    }
    for (const auto& waiter : notified) {
        timer_.cancel(waiter->timeout);
        waiter->ended();
    }
}

void Waits::tell_all() {
    std::multimap<std::string, std::shared_ptr<Waiter>> notified;
    {
        const std::lock_guard lock(mutex_);
        notified.swap(waiters_);
    }
    for (const auto& [id, waiter] : notified) {
        timer_.cancel(waiter->timeout);
        waiter->ended();
    }
}

std::vector<std::string> Waits::ids() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> ids;
    for (auto it = waiters_.begin(); it != waiters_.end(); it = waiters_.upper_bound(it->first))
        ids.push_back(it->first);
    return ids;
}

}  // namespace tunewright::server
