#include "server/http/body/body_stream.h"

#include <utility>

#include "server/http/body/compression.h"

namespace tunewright::server::http {

BodyStream::BodyStream() = default;
BodyStream::~BodyStream() = default;

bool BodyStream::write(std::string piece) {
    if (piece.empty()) return !gone();
    const std::lock_guard packing(packing_);
    return put(packer_ ? packer_->piece(piece) : std::move(piece), Last::no);
}

void BodyStream::end() {
    const std::lock_guard packing(packing_);
    put(packer_ ? packer_->end() : std::string{}, Last::end);
    packer_.reset();
}

void BodyStream::break_off() {
    const std::lock_guard packing(packing_);
    put({}, Last::broken);
    packer_.reset();
}

void BodyStream::compress() {
    const std::lock_guard packing(packing_);
    packer_ = std::make_unique<GzipStream>();
    const std::lock_guard lock(mutex_);
    if (!written_.empty()) written_ = packer_->piece(written_);
    if (!ended_) return;
    written_ += packer_->end();
    packer_.reset();
}

/// False where the client has gone.
bool BodyStream::put(std::string piece, Last last) {
    std::function<void()> wake;
    {
        const std::lock_guard lock(mutex_);
        if (gone_) return false;
        if (ended_) return true;
        if (written_.empty())
            written_ = std::move(piece);
        else
            written_.append(piece);
        ended_ = last != Last::no;
        broken_ = last == Last::broken;
        if (!std::exchange(woken_, true)) wake = wake_;
    }
    if (wake) wake();
    return true;
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
    return {std::exchange(written_, {}), ended_, broken_};
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

void BodyStream::close(bool notify) {
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
    if (notify && left) left();
}

}  // namespace tunewright::server::http
