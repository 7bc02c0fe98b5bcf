// Slots for long requests: waits, event streams, uploads of batches. Each holds a thread of the server.
#pragma once

#include <array>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace tunewright::server {

class LongRequestSlots {
public:
    /// `max`: slots in total, and slots for one client.
    explicit LongRequestSlots(std::array<std::size_t, 2> max) : max_(max[0]), of_one_client_(max[1]) {}

    /// Held for the duration of the request; can be moved.
    class Slot {
    public:
        Slot(LongRequestSlots& places, std::string client) : places_(&places), client_(std::move(client)) {}
        Slot(Slot&& other) noexcept
            : places_(std::exchange(other.places_, nullptr)), client_(std::move(other.client_)) {}
        Slot& operator=(Slot&& other) noexcept {
            std::swap(places_, other.places_);
            std::swap(client_, other.client_);
            return *this;
        }
        ~Slot() {
            if (places_ != nullptr) places_->leave(client_);
        }

    private:
        LongRequestSlots* places_;
        std::string client_;
    };

    /// Empty if all slots, or all that one client may have, are taken.
    std::optional<Slot> take(const std::string& client);

private:
    void leave(const std::string& client);

    const std::size_t max_, of_one_client_;
    std::mutex mutex_;
    std::size_t taken_ = 0;
    std::map<std::string, std::size_t> clients_;
};

inline std::optional<LongRequestSlots::Slot> LongRequestSlots::take(const std::string& client) {
    const std::lock_guard lock(mutex_);
    if (taken_ >= max_) return std::nullopt;
    std::size_t& own = clients_[client];
    if (own >= of_one_client_) return std::nullopt;
    own++;
    taken_++;
    return std::make_optional<Slot>(*this, client);
}

inline void LongRequestSlots::leave(const std::string& client) {
    const std::lock_guard lock(mutex_);
    taken_--;
    const auto found = clients_.find(client);
    if (--found->second == 0) clients_.erase(found);
}

}  // namespace tunewright::server
