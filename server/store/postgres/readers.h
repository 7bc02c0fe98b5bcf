// A few connections that only read, handed out to whoever asks.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <type_traits>
#include <vector>

#include "server/store/postgres/session.h"

namespace tunewright::server::postgres {

class Readers {
public:
    Readers(Address address, Watch& watch) : address_(std::move(address)), watch_(watch) {}

    /// What `work` finds. A connection that turns out to be lost is replaced once. Throws StoreError.
    template <class Work>
    std::invoke_result_t<Work, Session&> read(Work work) {
        try {
            bool fresh = false;
            std::unique_ptr<Session> session = take(fresh);
            const Place place(*this);
            try {
                if (!session) session = open();
                auto found = work(*session);
                give_back(std::move(session));
                return found;
            } catch (const Failure& failure) {
                if (failure.kind != Failure::Kind::broken) {
                    if (session) give_back(std::move(session));
                    throw;
                }
                if (fresh) throw;
                forget_all();
                session = open();
                auto found = work(*session);
                give_back(std::move(session));
                return found;
            }
        } catch (const Failure& failure) {
            throw StoreError(failure.fault());
        }
    }

private:
    /// One of the places for connections, held while somebody reads.
    class Place {
    public:
        explicit Place(Readers& readers) : readers_(readers) {}
        ~Place() { readers_.leave(); }
        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;

    private:
        Readers& readers_;
    };

    /// Waits for a place. A connection that is idle, or nothing (then `fresh`: a new one is to be opened).
    std::unique_ptr<Session> take(bool& fresh);
    std::unique_ptr<Session> open();
    void give_back(std::unique_ptr<Session> session);
    void forget_all();
    void leave();

    Address address_;
    Watch& watch_;
    std::mutex mutex_;
    std::condition_variable left_;
    std::size_t busy_ = 0;
    std::vector<std::unique_ptr<Session>> idle_;
    std::chrono::steady_clock::time_point next_try_{};
};

}  // namespace tunewright::server::postgres
