// A few connections for reading, shared by the threads.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tunewright::server {

template <class Connection>
class Pool {
public:
    explicit Pool(std::size_t places) : places_(places) { idle_.reserve(places); }

    /// One of the connections, held during a read.
    class Slot {
    public:
        explicit Slot(Pool& pool) : pool_(pool) {
            std::unique_lock lock(pool.mutex_);
            pool.left_.wait(lock, [&] { return pool.busy_ < pool.places_; });
            enter();
        }
        /// Waits at most `patience`; connection() and keep() only if it `is_held`.
        template <class Duration>
        Slot(Pool& pool, Duration patience) : pool_(pool) {
            std::unique_lock lock(pool.mutex_);
            if (pool.left_.wait_for(lock, patience, [&] { return pool.busy_ < pool.places_; })) enter();
        }
        ~Slot() {
            if (!held_) return;
            {
                const std::lock_guard lock(pool_.mutex_);
                pool_.busy_--;
            }
            pool_.left_.notify_one();
        }
        Slot(const Slot&) = delete;
        Slot& operator=(const Slot&) = delete;

        bool is_held() const { return held_; }
        /// The idle connection of the slot; null if there is none.
        std::unique_ptr<Connection> connection() { return std::move(connection_); }
        /// The connection is idle again.
        void keep(std::unique_ptr<Connection> connection) {
            const std::lock_guard lock(pool_.mutex_);
            pool_.idle_.push_back(std::move(connection));
        }

    private:
        void enter() {
            held_ = true;
            pool_.busy_++;
            if (pool_.idle_.empty()) return;
            connection_ = std::move(pool_.idle_.back());
            pool_.idle_.pop_back();
        }

        Pool& pool_;
        bool held_ = false;
        std::unique_ptr<Connection> connection_;
    };

    /// Closes the idle connections.
    void forget_idle() {
        const std::lock_guard lock(mutex_);
        idle_.clear();
    }

private:
    const std::size_t places_;
    std::mutex mutex_;
    std::condition_variable left_;
    std::size_t busy_ = 0;
    std::vector<std::unique_ptr<Connection>> idle_;
};

}  // namespace tunewright::server
