#include "server/http/guard/budget.h"

#include <algorithm>

namespace tunewright::server::http {
namespace {

// Parts of the whole: what a small request holds at most, and what is kept for such, whoever fills the rest.
constexpr std::size_t kSmallRequest = 512, kForSmall = 4;

}  // namespace

Budget::Share Budget::open(std::string client, std::function<void()> give_way) {
    const std::lock_guard lock(mutex_);
    return {*this, entries_.insert(entries_.end(), Entry{std::move(client), 0, std::move(give_way)})};
}

std::size_t Budget::taken() const {
    const std::lock_guard lock(mutex_);
    return sum_;
}

bool Budget::grow(Entry& entry, std::size_t bytes, std::chrono::milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    std::unique_lock lock(mutex_);
    const bool arriving = entry.give_way != nullptr;
    bytes = std::min(bytes, most_ / 2 - (arriving ? std::min(most_ / 2, entry.bytes) : 0));
    const std::size_t own = entry.bytes + bytes;
    const std::size_t most = own <= most_ / kSmallRequest ? most_ + most_ / kForSmall : arriving ? most_ / 2 : most_;
    while (sum_ + bytes > most && !entry.leaving) {
        if (Entry* victim = to_give_way(entry.client, own)) {
            victim->leaving = true;
            victim->give_way();
        } else if (freed_.wait_until(lock, end) == std::cv_status::timeout) {
            break;
        }
    }
    if (entry.leaving || sum_ + bytes > most) return false;
    entry.bytes += bytes;
    sum_ += bytes;
    if (bytes > 0) held_[entry.client] += bytes;
    return true;
}

void Budget::keep(Entry& entry) {
    const std::lock_guard lock(mutex_);
    entry.give_way = nullptr;
}

void Budget::close(Place place) {
    {
        const std::lock_guard lock(mutex_);
        sum_ -= place->bytes;
        if (const auto held = held_.find(place->client); held != held_.end() && (held->second -= place->bytes) == 0)
            held_.erase(held);
        entries_.erase(place);
    }
    freed_.notify_all();
}

/// Under the lock: none while one that has been asked is still there. For another request of the same client only one
/// that is more than twice as large goes.
Budget::Entry* Budget::to_give_way(const std::string& client, std::size_t bytes) {
    if (std::ranges::any_of(entries_, &Entry::leaving)) return nullptr;
    const auto most = std::ranges::max_element(held_, {}, [](const auto& item) { return item.second; });
    if (most == held_.end()) return nullptr;
    Entry* largest = nullptr;
    for (Entry& entry : entries_)
        if (entry.client == most->first && entry.give_way && (largest == nullptr || entry.bytes > largest->bytes))
            largest = &entry;
    if (largest != nullptr && most->first == client && largest->bytes <= 2 * bytes) return nullptr;
    return largest;
}

}  // namespace tunewright::server::http
