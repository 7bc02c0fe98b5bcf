#include "server/access/compute_slots.h"

#include <algorithm>

namespace tunewright::server {
namespace {

constexpr std::chrono::milliseconds kPollInterval{100};  // between checks for clients that have disconnected

}  // namespace

ComputeSlots::Wait ComputeSlots::take(const std::string& client, Clock::time_point deadline,
                                      const std::function<bool()>& left) {
    std::unique_lock lock(mutex_);
    // A waiting request that could begin would have begun: if this one may begin, it overtakes none.
    if (may_begin(client)) return begin(client), Wait::granted;
    const auto own = queues_.find(client);
    if (waiting_ >= max_waiting_ || (own != queues_.end() && 2 * own->second.size() >= max_waiting_)) return Wait::full;
    Ticket ticket;
    waiting_++;
    if (own == queues_.end()) order_.push_back(client);
    queues_[client].push_back(&ticket);
    while (!ticket.called.wait_for(lock, kPollInterval, [&] { return ticket.granted; })) {
        const bool gone = left && left();
        if (!gone && Clock::now() < deadline) continue;
        withdraw(client, ticket);
        return gone ? Wait::left : Wait::late;
    }
    return Wait::granted;
}

void ComputeSlots::give_back(const std::string& client) {
    const std::lock_guard lock(mutex_);
    under_way_--;
    const auto held = held_.find(client);
    if (--held->second == 0) held_.erase(held);
    grant();
}

std::size_t ComputeSlots::waiting() const {
    const std::lock_guard lock(mutex_);
    return waiting_;
}

bool ComputeSlots::may_begin(const std::string& client) const {
    return under_way_ < at_once_ || (under_way_ < at_most_ && !held_.contains(client));
}

void ComputeSlots::begin(const std::string& client) {
    under_way_++;
    held_[client]++;
}

/// Gives free slots to the clients whose turn it is.
void ComputeSlots::grant() {
    for (;;) {
        const auto next_client = std::ranges::find_if(order_, [this](const auto& each) { return may_begin(each); });
        if (next_client == order_.end()) return;
        const std::string client = std::move(*next_client);
        order_.erase(next_client);
        const auto queue = queues_.find(client);
        Ticket& next = *queue->second.front();
        queue->second.pop_front();
        if (queue->second.empty())
            queues_.erase(queue);
        else
            order_.push_back(client);
        waiting_--;
        begin(client);
        next.granted = true;
        next.called.notify_one();
    }
}

void ComputeSlots::withdraw(const std::string& client, Ticket& ticket) {
    const auto queue = queues_.find(client);
    std::erase(queue->second, &ticket);
    waiting_--;
    if (!queue->second.empty()) return;
    queues_.erase(queue);
    order_.remove(client);
}

}  // namespace tunewright::server
