// What other threads have for the event loop. Outlives the loop for as long as somebody holds a Reply, a stream or the
// body of a request.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "server/http/message.h"

namespace tunewright::server::http {

class Mailbox {
public:
    /// The request under way on a connection.
    struct Address {
        std::uint64_t connection = 0;
        std::uint64_t ticket = 0;
    };
    struct Answer {
        Address to;
        Response response;
    };
    struct Mail {
        std::vector<Answer> answers;
        std::vector<Address> nudges;  ///< streams with something to send, bodies that are asked for
        std::vector<std::function<void()>> tasks;
    };

    Mailbox();
    ~Mailbox();
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;

    /// False where the loop has ended: then nothing is kept.
    bool put(Address to, Response response);
    bool nudge(Address to);
    bool run(std::function<void()> task);

    /// The rest is for the loop. What is put by the thread that called open() does not wake it: it looks anyhow.
    void open();
    Mail take();
    bool empty() const;
    void close();
    void wake() const;
    void clear_wake() const;
    int event() const { return event_; }

private:
    template <class Add>
    bool add(const Add& how);

    int event_;
    mutable std::mutex mutex_;
    std::thread::id loop_;
    bool closed_ = false;
    bool empty_ = true;
    Mail mail_;
};

}  // namespace tunewright::server::http
