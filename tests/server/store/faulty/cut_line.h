// A connection to a database that the test can cut.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tunewright::server {

/// Listens on the loopback and forwards bytes to and from `port`. A message is a piece of data sent by a client.
class CutLine {
public:
    enum class When {
        before,  ///< the message does not arrive
        after,   ///< it arrives, and its answer does not
    };

    explicit CutLine(int port);
    ~CutLine();
    CutLine(const CutLine&) = delete;
    CutLine& operator=(const CutLine&) = delete;

    int port() const { return port_; }
    /// From now on: the connection of message `number` (from 0) is cut; those that are opened later work.
    void cut(std::int64_t number, When when);
    /// Messages since cut().
    std::int64_t messages() const { return messages_; }

private:
    void serve();
    void carry(int client);

    int server_port_, port_ = 0, listening_ = -1;
    std::atomic<std::int64_t> messages_ = 0, cut_at_ = -1;
    std::atomic<When> when_ = When::before;
    std::atomic<bool> ending_ = false;
    std::mutex mutex_;
    std::vector<std::thread> lines_;
    std::thread accepting_;
};

}  // namespace tunewright::server
