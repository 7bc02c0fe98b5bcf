// The body of an answer that is made while it is sent: server-sent events, results of a batch. The producer writes from
// any thread; the event loop owns the socket and sends chunks as the client takes them. An open stream costs a buffer,
// never a thread.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace tunewright::server::http {

class GzipStream;

class BodyStream {
public:
    BodyStream();
    ~BodyStream();
    BodyStream(const BodyStream&) = delete;
    BodyStream& operator=(const BodyStream&) = delete;

    /// The producer should write no more than this ahead of the client.
    static constexpr std::size_t kRoom = 256 * 1024;

    /// Takes the next piece; false where the client has gone and nothing is sent any more.
    bool write(std::string piece);
    /// No more comes. What was written before is still sent.
    void end();
    /// No more comes, though more should have: what was written is sent, then the connection is closed without the
    /// end of the body, so that the client knows that something is missing.
    void break_off();
    /// Bytes written that the client has not taken yet.
    std::size_t waiting() const;
    bool gone() const;

    /// `more` runs on the event loop, soon, when nothing is waiting: once at the start and then each time that what was
    /// written has been taken; so also while an earlier call's work, done elsewhere, is still writing. Quick: whatever
    /// takes longer goes elsewhere and writes from there.
    void on_room(std::function<void()> more);
    /// `left` runs once, on the event loop, when the client goes before the end, or never wanted a body (HEAD), or the
    /// service stops. Set before the answer is given. Not called where the service had stopped before the answer.
    void on_gone(std::function<void()> left);

    /// What is written is sent as gzip from now on; before the answer is given, and once. Compressed where it is
    /// written.
    void compress();

private:
    friend class Outgoing;
    struct Written {
        std::string bytes;
        bool ended = false;
        bool broken = false;
    };

    // The side of the event loop.
    void attach(std::function<void()> wake);
    Written take();
    void taken();
    void ask();
    void close(bool notify);

    enum class Last { no, end, broken };
    bool put(std::string piece, Last last);

    std::mutex packing_;  ///< of packer_, which takes longer than the loop may be held up; taken before mutex_
    std::unique_ptr<GzipStream> packer_;
    mutable std::mutex mutex_;
    std::string written_;      ///< not yet taken by the loop
    std::size_t sending_ = 0;  ///< taken by the loop, not yet by the client
    bool ended_ = false;
    bool broken_ = false;
    bool gone_ = false;
    bool asks_ = false;   ///< there was room since `more` was called
    bool woken_ = false;  ///< the loop knows and has not looked yet
    std::function<void()> more_;
    std::function<void()> left_;
    std::function<void()> wake_;  ///< wakes the loop when there is something to do
};

}  // namespace tunewright::server::http
