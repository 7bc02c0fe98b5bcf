// The library's server with the guard on its sockets: each connection has a thread of a pool that grows on demand, and
// is read and written by a Connection. The total resources of clients are limited.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>

#include "server/http/guard/budget.h"
#include "server/http/guard/connection.h"
#include "server/http/guard/server.h"
#include "server/http/guard/thread_pool.h"
#include "server/http/guard/unsent_responses.h"

namespace tunewright::server::http {

class Server::Guard : public httplib::Server {
public:
    Guard(const ServerLimits& limits, Application application);
    ~Guard() override;

    int open(const std::string& host, int port);
    void serve();
    void close();
    Occupancy occupancy() const;
    bool idle_within(std::chrono::milliseconds patience) { return crew_.stop_within(patience); }

private:
    using Neighbours = std::set<Connection*>;

    void expect_one(int socket);
    void attend(int socket);
    void thin_out();
    bool enter(Connection& connection);
    void leave(Connection& connection);
    bool make_room(const Neighbours& among);
    bool converse(Connection& connection);
    void finish_under_way();
    template <class Which>
    bool any(const Which& which) const;

    const ServerLimits limits_;
    const Application application_;
    Budget bodies_;
    UnsentResponses answers_;
    std::atomic<bool> stopping_ = false;                         ///< answers announce the end of the connection
    std::atomic<bool> closed_ = false;                           ///< no further connections are accepted
    int listener_ = -1;                                          ///< the listening socket
    mutable std::mutex mutex_;                                   ///< protects the members below
    std::map<std::string, Neighbours, std::less<>> neighbours_;  ///< by network; none is empty
    bool over_ = false;                                          ///< new connections are not served
    std::size_t connections_ = 0;                                ///< accepted, with or without a thread
    std::size_t served_ = 0;                                     ///< of these, connections that have a thread
    std::size_t leaving_ = 0;                                    ///< of these, connections that give way but have not
                                                                 ///< ended yet
    bool starved_ = false;                                       ///< the system had no thread for the last connection
    ThreadPool crew_;                                            ///< last: its threads use all of the above
};

}  // namespace tunewright::server::http
