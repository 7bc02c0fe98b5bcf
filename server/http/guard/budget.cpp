#include "server/http/guard/budget.h"

#include <algorithm>
#include <map>
#include <string_view>

namespace tunewright::server::http {
namespace {

// Shares of the total: the largest share of a small request, and the part that is reserved for small requests.
constexpr std::size_t kSmallRequestShare = 512, kSmallShare = 4;
constexpr std::chrono::seconds kLeaveTime{1};  // for a request that was asked to give way, before another one is asked

}  // namespace

Budget::Reservation Budget::open(std::string client, std::function<void()> give_way) {
    const std::lock_guard lock(mutex_);
    return {*this, entries_.insert(entries_.end(), Entry{std::move(client), 0, std::move(give_way)})};
}

std::size_t Budget::taken() const {
    const std::lock_guard lock(mutex_);
    return arriving_.all + answering_.all;
}

bool Budget::is_small(std::size_t bytes) const { return bytes <= max_ / kSmallRequestShare; }

/// True if a request that holds `before` of `sum` may hold `own` bytes. Large requests do not count the reserve that
/// small ones use.
bool Budget::fits(const Sum& sum, std::size_t own, std::size_t before) const {
    const std::size_t kept = max_ / kSmallShare, together = sum.all - before + own;
    return together <= max_ / 2 + (is_small(own) ? kept : std::min(kept, sum.small - (is_small(before) ? before : 0)));
}

bool Budget::grow(Entry& entry, std::size_t bytes, std::chrono::milliseconds patience) {
    const auto end = Clock::now() + patience;
    std::unique_lock lock(mutex_);
    bytes = std::min(bytes, max_ / 2 - std::min(max_ / 2, entry.bytes));
    const std::size_t own = entry.bytes + bytes;
    while (!fits(arriving_, own, entry.bytes) && !entry.leaving) {
        if (Entry* victim = to_give_way(entry.client, own)) {
            victim->leaving = Clock::now();
            victim->give_way();
            freed_.notify_all();  // the request itself may be waiting here
        } else if (freed_.wait_until(lock, std::min(end, Clock::now() + kLeaveTime)) == std::cv_status::timeout &&
                   Clock::now() >= end) {
            break;
        }
    }
    if (entry.leaving || !fits(arriving_, own, entry.bytes)) return false;
    set(entry, own);
    return true;
}

bool Budget::arrived(Entry& entry, std::size_t more, std::chrono::milliseconds patience) {
    {
        std::unique_lock lock(mutex_);
        entry.give_way = nullptr;
        entry.leaving = {};
        const std::size_t own = std::min(entry.bytes + more, max_ / 2);
        if (!freed_.wait_for(lock, patience, [&] { return fits(answering_, own, 0); })) return false;
        set(entry, 0);
        entry.answering = true;
        set(entry, own);
    }
    freed_.notify_all();
    return true;
}

void Budget::keep(Entry& entry, std::size_t bytes) {
    {
        const std::lock_guard lock(mutex_);
        set(entry, std::min(entry.bytes, bytes));
        if (bytes == 0) entry.leaving = {}, entry.give_way = nullptr;  // it has given way
    }
    freed_.notify_all();
}

/// Requires the lock.
void Budget::set(Entry& entry, std::size_t bytes) {
    Sum& sum = entry.answering ? answering_ : arriving_;
    sum.all += bytes - entry.bytes;
    sum.small += (is_small(bytes) ? bytes : 0) - (is_small(entry.bytes) ? entry.bytes : 0);
    entry.bytes = bytes;
}

void Budget::close(EntryIterator place) {
    {
        const std::lock_guard lock(mutex_);
        set(*place, 0);
        entries_.erase(place);
    }
    freed_.notify_all();
}

/// Requires the lock. None while a request that was asked recently is still there. For another request of the same
/// client only a request of more than twice the size gives way.
Budget::Entry* Budget::to_give_way(const std::string& client, std::size_t bytes) {
    const auto now = Clock::now();
    if (std::ranges::any_of(entries_, [&](const Entry& one) { return one.leaving && now - *one.leaving < kLeaveTime; }))
        return nullptr;
    // Clients by the bytes of their requests that can still give way.
    std::map<std::string_view, std::pair<std::size_t, Entry*>> clients;
    for (Entry& entry : entries_) {
        if (!entry.give_way || entry.leaving) continue;
        auto& [sum, largest] = clients[entry.client];
        sum += entry.bytes;
        if (largest == nullptr || entry.bytes > largest->bytes) largest = &entry;
    }
    const auto max = std::ranges::max_element(clients, {}, [](const auto& item) { return item.second.first; });
    if (max == clients.end()) return nullptr;
    Entry* largest = max->second.second;
    return max->first == client && largest->bytes <= 2 * bytes ? nullptr : largest;
}

}  // namespace tunewright::server::http
