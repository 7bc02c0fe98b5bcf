// The body of a request that is read while it arrives, for calls that take more than fits into memory. Nobody waits in
// a thread: the handler asks for the next piece and is called when it is there; what is not asked for stays in the
// client's hands.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace tunewright::server::http {

class BodySource {
public:
    enum class State {
        more,     ///< `bytes` is the next piece, never empty
        end,      ///< the whole body has been given
        refused,  ///< too large, malformed or too slow: the client has its answer already (413, 400, 408)
        gone,     ///< the client has gone before the end
    };
    struct Piece {
        State state = State::gone;
        std::string bytes;
    };

    virtual ~BodySource() = default;
    /// Calls `take` once, on the event loop, with the next piece (at most 256 KiB). Not again before it was called; nor
    /// after a state other than more. A handler that replies before the end need not read the rest.
    virtual void read(std::function<void(Piece)> take) = 0;
};

}  // namespace tunewright::server::http
