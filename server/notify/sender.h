// One POST to an address outside: over HTTP or verified TLS, without following redirects, within a time that no
// receiver can stretch.
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/notify/target.h"

namespace tunewright::server {

struct OutgoingNote {
    WebAddress address;
    std::vector<std::pair<std::string, std::string>> headers;
    std::string body;
};

struct Reply {
    int status = 0;           ///< 0: there was none
    std::string fault;        ///< why, as the end of a sentence: "it cannot be reached"
    std::string retry_after;  ///< the field; "" if none
};

class Sender {
public:
    static constexpr std::chrono::seconds kConnect{5}, kReadWrite{10};
    /// Of a try as a whole, from its name's look-up on.
    static constexpr std::chrono::seconds kLongest{20};

    Sender() = default;
    ~Sender();
    Sender(const Sender&) = delete;
    Sender& operator=(const Sender&) = delete;

    /// Returns when there is an answer, or none. To be called once.
    Reply send(const OutgoingNote& note);
    /// From any thread, at any time: send() returns soon after, except out of the look-up of a name.
    void cut();

private:
    void opened(int socket);

    std::mutex mutex_;
    bool cut_ = false;
    std::vector<int> sockets_;  ///< duplicates, so that none of them is closed while it is cut
};

}  // namespace tunewright::server
