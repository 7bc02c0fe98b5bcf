// Receives notices of other processes, on a separate connection. Notices are lost while that is lost: afterwards the
// listener reports that anything may have changed.
#pragma once

#include <atomic>
#include <functional>
#include <latch>
#include <mutex>
#include <string>
#include <thread>

#include "server/store/postgres/session.h"
#include "server/store/store.h"

namespace tunewright::server::postgres {

class Listener {
public:
    /// Listens when it returns, if the database is available. Notices with this tag are this process's own and not
    /// passed on.
    Listener(Address address, std::string own_tag);
    ~Listener();
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    void watch(std::function<void(const StoreNotice&)> listener);
    bool connected() const { return connected_; }

private:
    void work();
    void listen();
    /// The first attempt to listen is over, successful or not.
    void tried();
    /// False when it is time to stop.
    bool pause(int milliseconds);
    void pass_on(const StoreNotice& notice);

    Address address_;
    std::string own_tag_;
    int wake_;  ///< an eventfd that ends every wait
    std::atomic<bool> stopping_ = false;
    std::atomic<bool> connected_ = true;
    std::mutex mutex_;
    std::function<void(const StoreNotice&)> listener_;
    std::latch first_try_{1};
    bool tried_ = false;
    std::jthread thread_;
};

}  // namespace tunewright::server::postgres
