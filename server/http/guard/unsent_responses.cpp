#include "server/http/guard/unsent_responses.h"

namespace tunewright::server::http {
namespace {

using Clock = Connection::Clock;

constexpr std::size_t kMaxUncountedBytes = 16 * 1024;  // sent at once, or held in the system's buffers
constexpr std::chrono::milliseconds kStalledTime{500};
constexpr std::chrono::milliseconds kMaxPatience{2000};  // with clients that read, but too slowly
constexpr std::chrono::milliseconds kPollInterval{50};

}  // namespace

UnsentResponses::Reservation UnsentResponses::hold(Connection& connection, std::size_t bytes) {
    if (bytes <= kMaxUncountedBytes) return {};
    std::unique_lock lock(mutex_);
    const EntryIterator place = entries_.insert(entries_.end(), Entry{&connection, bytes});
    sum_ += bytes;
    make_room(lock, *place);
    place->sending = true;
    connection.moved = Clock::now();
    return {*this, place};
}

std::size_t UnsentResponses::bytes() const {
    const std::lock_guard lock(mutex_);
    return sum_;
}

void UnsentResponses::give_back(EntryIterator place) {
    {
        const std::lock_guard lock(mutex_);
        sum_ -= place->bytes;
        if (place->leaving) leaving_ -= place->bytes;
        entries_.erase(place);
    }
    freed_.notify_all();
}

/// Requires the lock, which is released during the wait. The threads of connections that are cut off release their
/// bytes.
void UnsentResponses::make_room(std::unique_lock<std::mutex>& lock, const Entry& own) {
    const auto start = Clock::now();
    while (sum_ > max_ && sum_ > own.bytes && Clock::now() < start + 2 * kMaxPatience) {
        const bool patient = Clock::now() < start + kMaxPatience;
        Entry* victim =
            sum_ - leaving_ > max_ ? oldest(Clock::now() - (patient ? kStalledTime : -kMaxPatience)) : nullptr;
        if (victim != nullptr) {
            victim->leaving = true;
            leaving_ += victim->bytes;
            victim->connection->cut_off();
        } else {
            freed_.wait_for(lock, kPollInterval);
        }
    }
}

/// The oldest of those that are being sent and whose clients have read nothing since then.
UnsentResponses::Entry* UnsentResponses::oldest(Clock::time_point moved_before) {
    Entry* found = nullptr;
    for (Entry& entry : entries_)
        if (entry.sending && !entry.leaving && entry.connection->moved.load() <= moved_before &&
            (found == nullptr || entry.connection->since.load() < found->connection->since.load()))
            found = &entry;
    return found;
}

}  // namespace tunewright::server::http
