// A thread that writes, on a connection of its own. What is asked for while a transaction is being committed goes into
// the next one together: single jobs' changes of one kind into one statement, and one commit for all.
//
// When the connection is lost: changes that cannot have been committed are tried once more on a new connection; a
// commit whose answer was lost is looked up by its transaction's number, which says nothing after a crash of the
// server: there the number may have become another's. Whatever remains unknown or impossible is answered with
// StoreFault::unavailable, and a new connection is tried for with growing pauses.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/store/postgres/batch_changes.h"
#include "server/store/postgres/job_changes.h"
#include "server/store/postgres/session.h"

namespace tunewright::server::postgres {

/// A question to the writer with its answer, which may be found twice before it is given.
template <class In, class Out>
struct Ask {
    In in;
    Done<Out> done;
    Out out{};
};

/// Any other change.
struct OtherChange {
    std::function<void(Work&)> apply;
    std::function<void(std::optional<StoreFault>)> done;
    std::string requeued = {};  ///< id of the job that it queues again; empty for any other change
};

/// What one transaction takes, in the order in which it is done.
struct Group {
    std::vector<Ask<NewJob, Accepted>> accepts;
    std::vector<Ask<JobEnd, bool>> ends;
    std::vector<Ask<Heartbeat, std::vector<Holding>>> beats;
    std::vector<OtherChange> others;
    std::vector<Ask<Claim, std::vector<JobRecord>>> claims;

    /// Ids of the jobs that it queues again.
    std::vector<std::string> requeued() const;
    std::size_t size() const { return accepts.size() + ends.size() + beats.size() + others.size() + claims.size(); }
    /// Claims and signs of life alone do not wait for the disk: where a crash of the server undoes them, the jobs are
    /// queued again, which is where they belong then. Whoever ends such a job first, ends it.
    bool durable() const { return !(accepts.empty() && ends.empty() && others.empty()); }
};

class Writer {
public:
    /// Connects by itself. `tag` "": other processes are told nothing.
    Writer(Address address, std::string tag, Watch& watch);
    /// Does what was asked for, as far as the database is there, then joins.
    ~Writer();
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    void accept(Ask<NewJob, Accepted> ask);
    void finish(Ask<JobEnd, bool> ask);
    void beat(Ask<Heartbeat, std::vector<Holding>> ask);
    void claim(Ask<Claim, std::vector<JobRecord>> ask);
    void change(OtherChange change);

    bool healthy() const { return healthy_; }
    /// How long the server has owed an answer.
    std::chrono::milliseconds silence() const { return line_->silence(); }

private:
    using Clock = std::chrono::steady_clock;

    template <class T>
    void add(std::vector<T> Group::*place, T item, bool first = false);
    void work();
    /// Empty when it is time to stop, or to look after the connection.
    Group next_group();
    void write(Group& group);
    void write_alone(Group& group);
    /// Nothing when the group has been committed.
    std::optional<Failure> try_write(Group& group);
    std::optional<Failure> try_once(Group& group);
    bool connect();
    /// Of a transaction whose commit was not answered, in that life of the server; nothing where that cannot be found
    /// out.
    std::optional<bool> was_committed(std::int64_t transaction, const std::string& life);
    bool stopping() const;

    Address address_;
    std::string tag_;
    const std::shared_ptr<Line> line_;
    std::unique_ptr<Session> session_;
    std::string life_;  ///< server_life() that the session saw
    Clock::time_point next_try_{};
    std::chrono::milliseconds pause_{0};

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Group waiting_;
    bool quick_went_ = false;  ///< the last group was of claims and signs of life
    bool stopping_ = false;
    std::atomic<bool> healthy_ = true;
    std::jthread thread_;
};

}  // namespace tunewright::server::postgres
