#include "server/http/body_stream.h"

#include <utility>

namespace tunewright::server::http {

bool BodyStream::write(std::string piece) {
    std::function<void()> wake;
    {
        const std::lock_guard lock(mutex_);
        if (gone_) return false;
        if (piece.empty() || ended_) return true;
        if (written_.empty())
            written_ = std::move(piece);
        else
            written_.append(piece);
        if (!std::exchange(woken_, true)) wake = wake_;
    }
    if (wake) wake();
    return true;
}

void BodyStream::end() {
    std::function<void()> wake;
    {
        const std::lock_guard lock(mutex_);
        if (std::exchange(ended_, true) || gone_) return;
        if (!std::exchange(woken_, true)) wake = wake_;
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
    std::function<void()> wake;
    {
        const std::lock_guard lock(mutex_);
        if (gone_ || ended_) return;
        more_ = std::move(more);
        asks_ = true;
        if (!std::exchange(woken_, true)) wake = wake_;
    }
    if (wake) wake();
}

void BodyStream::on_gone(std::function<void()> left) {
    const std::lock_guard lock(mutex_);
    left_ = std::move(left);
}

void BodyStream::attach(std::function<void()> wake) {
    const std::lock_guard lock(mutex_);
    wake_ = std::move(wake);
    woken_ = true;
}

BodyStream::Written BodyStream::take() {
    const std::lock_guard lock(mutex_);
    woken_ = false;
    sending_ = written_.size();
    return {std::exchange(written_, {}), ended_};
}

void BodyStream::taken() {
    const std::lock_guard lock(mutex_);
    if (sending_ > 0) asks_ = true;
    sending_ = 0;
}

void BodyStream::ask() {
    std::function<void()> more;
    {
        const std::lock_guard lock(mutex_);
        if (ended_ || !more_ || !std::exchange(asks_, false)) return;
        more = more_;
    }
    more();
}

void BodyStream::close(bool tell) {
    // The callbacks often hold what holds this stream: let go of them, outside the lock.
    std::function<void()> left;
    std::function<void()> more;
    std::function<void()> wake;
    {
        const std::lock_guard lock(mutex_);
        gone_ = true;
        written_ = {};
        sending_ = 0;
        left.swap(left_);
        more.swap(more_);
        wake.swap(wake_);
    }
    if (tell && left) left();
}

}  // namespace tunewright::server::http
