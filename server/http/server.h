// The event loop: accepts connections, gathers whole requests, hands them to the handler, sends the answers. One
// thread and no blocking call, so idle and slow clients cost a buffer each and nobody else's time. Every wait has an
// absolute end and the bytes that are held for clients have a common budget.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "server/http/connection.h"
#include "server/http/mailbox.h"
#include "server/http/message.h"
#include "server/http/parser.h"

namespace tunewright::server::http {

struct Limits {
    std::size_t max_body = 8 * 1024 * 1024;          ///< bytes of one body
    std::size_t max_batch_body = 256 * 1024 * 1024;  ///< bytes of one body that is read as it arrives
    std::size_t buffered = 128 * 1024 * 1024;        ///< bytes of unfinished requests of all clients together
    std::size_t unsent = 256 * 1024 * 1024;          ///< bytes of answers that clients do not take; the oldest go first
    std::size_t connections = 4000;          ///< beyond it the longest idle one is closed, or the oldest event stream
    std::chrono::milliseconds idle{60'000};  ///< between two requests
    std::chrono::milliseconds head{10'000};  ///< from the first byte of a request to the end of its head
    std::chrono::milliseconds body_time{30'000};
    std::size_t pace_bytes = 16 * 1024;           ///< of a body that is read as it arrives there must come so much
    std::chrono::milliseconds pace_time{10'000};  ///< in each such time in which it is waited for
    std::chrono::milliseconds handling{150'000};  ///< longer than any handler takes; a safeguard
    std::chrono::milliseconds writing{60'000};    ///< and for long bodies what 16 KiB/s take; of streams each step
    std::chrono::milliseconds lingering{5'000};
    std::chrono::milliseconds stopping{2'000};  ///< for answers under way when the loop is asked to stop
    std::chrono::milliseconds farewell{250};    ///< for requests that are on their way to us at that moment
};

/// Makes the answer to what never becomes a request (malformed, too large, too slow): status and sentence.
using Refusal = std::function<Response(int status, const std::string& detail, const std::string& remote_addr)>;

/// True for a request whose body is to be read as it arrives. Asked on the event loop, with the head alone.
using StreamsBody = std::function<bool(const Request&)>;

class Server {
public:
    Server(Limits limits, Handler handler, Refusal refusal, StreamsBody streams = {});
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Opens the port; 0 lets the system choose. Returns the port. Throws std::runtime_error with a sentence.
    int listen(const std::string& host, int port);

    /// Serves until stop(); then takes no more connections, answers what has been sent to it, ends event streams, and
    /// returns when all that is out or `stopping` is over.
    void run();

    /// From any thread.
    void stop();

private:
    using Id = std::uint64_t;

    // The loop (server.cpp).
    void accept_all();
    bool make_room();
    bool somebody_knocks() const;
    void pause_accepting();
    void resume_accepting();
    void on_event(Id id, std::uint32_t events);
    void collect();
    void sweep();
    void shed_unsent();
    void begin_stop();
    void finish();
    bool busy() const;
    void drop(Id id);
    void enter(Connection& connection, Connection::State state, std::chrono::milliseconds limit);

    // One request after the other on a connection (exchange.cpp).
    void pump(Id id);
    bool read_step(Id id, Connection& connection);
    void admit(Connection& connection);
    void dispatch(Id id, Connection& connection);
    void body_step(Id id, Connection& connection);
    void refuse(Id id, Connection& connection, int status, const std::string& detail);
    void answer(Id id, Connection& connection, Response response);
    void flush(Id id, Connection& connection);
    void after_answer(Id id, Connection& connection);

    Limits limits_;
    Handler handler_;
    Refusal refusal_;
    StreamsBody streams_;
    Parser parser_;
    std::shared_ptr<Mailbox> mailbox_;
    int listener_ = -1;
    int epoll_ = -1;
    bool accepting_ = false;
    bool listener_open_ = true;
    std::atomic<bool> stopping_ = false;
    Id next_id_ = 2;
    std::uint64_t next_ticket_ = 1;
    SteadyTime now_{};
    SteadyTime next_sweep_{};
    SteadyTime last_moment_ = SteadyTime::max();
    SteadyTime farewell_end_{};
    std::unordered_map<Id, std::unique_ptr<Connection>> connections_;
    std::vector<Id> ready_;
    std::size_t buffered_ = 0;
};

}  // namespace tunewright::server::http
