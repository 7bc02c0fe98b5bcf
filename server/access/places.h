// Places for requests that last: waits, event streams, batches on their way. Each holds a thread of the port.
#pragma once

#include <array>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace tunewright::server {

class Places {
public:
    /// So many altogether, and so many for one client.
    explicit Places(std::array<std::size_t, 2> most) : most_(most[0]), of_one_client_(most[1]) {}

    /// Held while the request lasts; may be moved.
    class Place {
    public:
        Place(Places& places, std::string client) : places_(&places), client_(std::move(client)) {}
        Place(Place&& other) noexcept
            : places_(std::exchange(other.places_, nullptr)), client_(std::move(other.client_)) {}
        Place& operator=(Place&& other) noexcept {
            std::swap(places_, other.places_);
            std::swap(client_, other.client_);
            return *this;
        }
        ~Place() {
            if (places_ != nullptr) places_->leave(client_);
        }

    private:
        Places* places_;
        std::string client_;
    };

    /// Nothing where all places, or all that one client may have, are taken.
    std::optional<Place> take(const std::string& client);

private:
    void leave(const std::string& client);

    const std::size_t most_, of_one_client_;
    std::mutex mutex_;
    std::size_t taken_ = 0;
    std::map<std::string, std::size_t> clients_;
};

inline std::optional<Places::Place> Places::take(const std::string& client) {
    const std::lock_guard lock(mutex_);
    if (taken_ >= most_) return std::nullopt;
    std::size_t& own = clients_[client];
    if (own >= of_one_client_) return std::nullopt;
    own++;
    taken_++;
    return std::make_optional<Place>(*this, client);
}

inline void Places::leave(const std::string& client) {
    const std::lock_guard lock(mutex_);
    taken_--;
    const auto found = clients_.find(client);
    if (--found->second == 0) clients_.erase(found);
}

}  // namespace tunewright::server
