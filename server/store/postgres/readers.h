// The connections to PostgreSQL that only read.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <type_traits>

#include "server/store/pool.h"
#include "server/store/postgres/session.h"

namespace tunewright::server::postgres {

class Readers {
public:
    Readers(Address address, Watch& watch) : address_(std::move(address)), watch_(watch) {}

    /// The result of `work`. A lost connection is replaced once. Throws StoreError.
    template <class Work>
    std::invoke_result_t<Work, Session&> read(Work work) {
        try {
            Pool<Session>::Slot place(pool_, kMaxWait);
            if (!place.is_held()) throw Failure(Failure::Kind::broken, "no connection for reading became free");
            std::unique_ptr<Session> session = place.connection();
            const bool fresh = session == nullptr;
            try {
                if (fresh) session = open();
                auto found = work(*session);
                place.keep(std::move(session));
                return found;
            } catch (const Failure& failure) {
                if (failure.kind != Failure::Kind::broken) {
                    if (session) place.keep(std::move(session));
                    throw;
                }
                if (fresh) throw;
                pool_.forget_idle();
                session = open();
                auto found = work(*session);
                place.keep(std::move(session));
                return found;
            }
        } catch (const Failure& failure) {
            throw StoreError(failure.fault());
        }
    }

private:
    static constexpr std::size_t kMaxConnections = 4;
    static constexpr std::chrono::seconds kMaxWait{5};

    std::unique_ptr<Session> open();

    Address address_;
    Watch& watch_;
    Pool<Session> pool_{kMaxConnections};
    std::mutex mutex_;
    std::chrono::steady_clock::time_point next_try_{};
};

}  // namespace tunewright::server::postgres
