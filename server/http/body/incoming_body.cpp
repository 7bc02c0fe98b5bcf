#include "server/http/body/incoming_body.h"

#include <utility>

namespace tunewright::server::http {

void IncomingBody::read(std::function<void(Piece)> take) {
    State over = State::more;
    {
        const std::lock_guard lock(mutex_);
        over = over_;
        if (over == State::more) take_.swap(take);
    }
    if (over == State::more) {
        if (!mailbox_->nudge(address_)) finish(State::gone);
    } else if (!mailbox_->run([take, over] { take({over, {}}); })) {
        take({over, {}});
    }
}

bool IncomingBody::asked() const {
    const std::lock_guard lock(mutex_);
    return take_ != nullptr;
}

void IncomingBody::give(std::string bytes) {
    std::function<void(Piece)> take;
    {
        const std::lock_guard lock(mutex_);
        take = std::exchange(take_, nullptr);
    }
    if (take) take({State::more, std::move(bytes)});
}

void IncomingBody::finish(State how) {
    std::function<void(Piece)> take;
    {
        const std::lock_guard lock(mutex_);
        if (over_ == State::more) over_ = how;
        how = over_;
        take = std::exchange(take_, nullptr);
    }
    if (take) take({how, {}});
}

}  // namespace tunewright::server::http
