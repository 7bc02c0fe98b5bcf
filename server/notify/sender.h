// One POST to an external address: over HTTP or verified TLS, without following redirects, with a time limit that no
// receiver can extend.
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
    int status = 0;           ///< 0: no answer
    std::string fault;        ///< the reason, as the end of a sentence: "it cannot be reached"
    std::string retry_after;  ///< the field; "" if none
};

class Sender {
public:
    static constexpr std::chrono::seconds kConnect{5}, kReadWrite{10};
    /// Time limit of a whole attempt, including the look-up of the name.
    static constexpr std::chrono::seconds kLongest{20};

    Sender() = default;
    ~Sender();
    Sender(const Sender&) = delete;
    Sender& operator=(const Sender&) = delete;

    /// Returns with the answer, or after the failure. To be called once.
    Reply send(const OutgoingNote& note);
    /// From any thread, at any time: send() returns soon after, except during the look-up of a name.
    void cut();

private:
    void opened(int socket);

    std::mutex mutex_;
    bool cut_ = false;
    std::vector<int> sockets_;  ///< duplicates, so that none is closed while it is shut down
};

}  // namespace tunewright::server
