// One answer on its way to a socket: head and body, or head and the chunks of a stream. Belongs to the thread of the
// event loop alone.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "server/http/body/body_stream.h"
#include "server/http/message.h"

namespace tunewright::server::http {

/// What became of a step on a socket.
enum class Io {
    done,   ///< all of it
    more,   ///< a part; the rest may go at once, after others had their turn
    again,  ///< the socket takes or has nothing now
    idle,   ///< a stream: all that was written is out, more will come
    gone,   ///< the client has closed or failed
};

class Outgoing {
public:
    Outgoing() = default;
    ~Outgoing() { abandon(); }
    Outgoing(const Outgoing&) = delete;
    Outgoing& operator=(const Outgoing&) = delete;

    /// `chunks`: the client reads chunked bodies (HTTP/1.1); without it a stream ends with the connection, so
    /// `keep_alive` must then be false. `wake` is called, from any thread, when a stream has something to send.
    void start(Response response, bool keep_alive, bool chunks, const std::function<void()>& wake);

    /// Sends as much as the socket takes, but of a stream only what was written before.
    Io send(int fd);

    bool streams() const { return stream_ != nullptr; }
    /// A stream without an end of its own (server-sent events): nothing is missing where it is closed early.
    bool endless() const { return endless_; }
    /// Ends the stream after the piece that is being sent, as if its producer had ended it; the producer is notified.
    void end_stream();
    /// The client has gone or is not worth waiting for; the producer of a stream is notified.
    void abandon();

    /// The same for an answer that never became one under way.
    static void abandon(const std::shared_ptr<BodyStream>& stream, bool notify);

    /// Bytes that are held for this client: of the answer, and of its stream.
    std::size_t pending() const;

    /// Bytes of this answer that the socket has taken.
    std::size_t progress() const { return progress_; }

private:
    Io send_parts(int fd);
    bool next_piece();

    std::string head_;  ///< of the answer, then of a chunk
    std::string body_;
    const char* tail_ = "";
    std::size_t tail_size_ = 0;
    std::size_t sent_ = 0;
    std::size_t progress_ = 0;
    std::shared_ptr<BodyStream> stream_;
    bool chunks_ = true;
    bool endless_ = false;
    bool last_ = true;     ///< nothing follows what is being sent
    bool broken_ = false;  ///< the producer has broken off: nothing marks the end of the body
};

}  // namespace tunewright::server::http
