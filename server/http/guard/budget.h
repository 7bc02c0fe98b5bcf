// One sum of bytes for all who hold some, and a wait for room in it.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace tunewright::server::http {

class Budget {
public:
    explicit Budget(std::size_t bytes) : left_(bytes), whole_(bytes) {}

    /// Bytes that are held; given back when it goes.
    class Share {
    public:
        Share() = default;
        Share(Share&& other) noexcept { *this = std::move(other); }
        Share& operator=(Share&& other) noexcept {
            std::swap(budget_, other.budget_);
            std::swap(bytes_, other.bytes_);
            return *this;
        }
        ~Share() {
            if (budget_ != nullptr) budget_->give_back(bytes_);
        }

    private:
        friend class Budget;
        Share(Budget& budget, std::size_t bytes) : budget_(&budget), bytes_(bytes) {}
        Budget* budget_ = nullptr;
        std::size_t bytes_ = 0;
    };

    /// False where there was no room within the time. What is more than the whole counts as the whole.
    bool take(std::size_t bytes, std::chrono::milliseconds patience, Share& share) {
        bytes = std::min(bytes, whole_);
        std::unique_lock lock(mutex_);
        if (!freed_.wait_for(lock, patience, [&] { return left_ >= bytes; })) return false;
        left_ -= bytes;
        share = Share(*this, bytes);
        return true;
    }

    std::size_t taken() const {
        const std::lock_guard lock(mutex_);
        return whole_ - left_;
    }

private:
    void give_back(std::size_t bytes) {
        {
            const std::lock_guard lock(mutex_);
            left_ += bytes;
        }
        freed_.notify_all();
    }

    mutable std::mutex mutex_;
    std::condition_variable freed_;
    std::size_t left_;
    const std::size_t whole_;
};

}  // namespace tunewright::server::http
