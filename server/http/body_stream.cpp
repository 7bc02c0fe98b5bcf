#include "server/http/body_stream.h"

namespace tunewright::server::http {

bool BodyStream::write(std::string piece) {
    std::function<void()> wake;
    {
        const std::lock_guard lock(mutex_);
        if (gone_) return false;
        written_.append(piece);
        wake = wake_;
    }
    if (wake) wake();
    return true;
}

void BodyStream::end() {
    std::function<void()> wake;
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
        wake = wake_;
    }
    if (wake) wake();
}

std::size_t BodyStream::waiting() const {
    const std::lock_guard lock(mutex_);
    return written_.size() + sending_;
}

bool BodyStream::gone() const {
    const std::lock_guard lock(mutex_);
    return gone_;
}

void BodyStream::on_room(std::function<void()> more) {
    const std::lock_guard lock(mutex_);
    more_ = std::move(more);
}

void BodyStream::on_gone(std::function<void()> left) {
    const std::lock_guard lock(mutex_);
    left_ = std::move(left);
}

}  // namespace tunewright::server::http
