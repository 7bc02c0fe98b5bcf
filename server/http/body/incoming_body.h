// The body of a request under way: the handler's BodySource on one side, the event loop on the other. The loop reads
// from the socket only while the handler asks.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "server/http/body/body_decoder.h"
#include "server/http/body/body_source.h"
#include "server/http/mailbox.h"

namespace tunewright::server::http {

class IncomingBody : public BodySource {
public:
    static constexpr std::size_t kPiece = 256 * 1024;

    IncomingBody(BodyDecoder how, std::shared_ptr<Mailbox> mailbox, Mailbox::Address address)
        : decoder(how), mailbox_(std::move(mailbox)), address_(address) {}

    void read(std::function<void(Piece)> take) override;

    // The rest is for the loop.

    /// True while the handler waits for a piece.
    bool asked() const;
    /// Answers the handler's read().
    void give(std::string bytes);
    /// The body is over in this way; whoever waits, or asks later, learns it. Only the first call counts.
    void finish(State how);

    BodyDecoder decoder;

private:
    const std::shared_ptr<Mailbox> mailbox_;
    const Mailbox::Address address_;
    mutable std::mutex mutex_;
    std::function<void(Piece)> take_;
    State over_ = State::more;
};

}  // namespace tunewright::server::http
