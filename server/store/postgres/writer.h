// A thread that writes, on a connection of its own. Changes that arrive while a transaction is being committed are
// combined in the next one: single jobs' changes of one kind in one statement, and one commit for all.
//
// When the connection is lost: changes that cannot have been committed are tried once more on a new connection; a
// commit whose answer was lost is looked up by its transaction's number, unless the server has crashed, because the
// number may then belong to another one. Changes that remain unknown or impossible are answered with
// StoreFault::unavailable, and reconnection is attempted with growing pauses.
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

/// A request to the writer with its answer, which may be computed twice before it is delivered.
template <class In, class Out>
struct Ask {
    In in;
    Done<Out> done;
    Out out{};
};

/// A change of another kind.
struct OtherChange {
    std::function<void(Work&)> apply;
    std::function<void(std::optional<StoreFault>)> done;
    std::string requeued = {};  ///< id of the job that it queues again; empty for any other change
};

/// The changes of one transaction, in their order.
struct Group {
    std::vector<Ask<NewJob, Accepted>> accepts;
    std::vector<Ask<JobEnd, bool>> ends;
    std::vector<Ask<Heartbeat, std::vector<Holding>>> beats;
    std::vector<OtherChange> others;
    std::vector<Ask<Claim, std::vector<JobRecord>>> claims;

    /// Ids of the jobs that it queues again.
    std::vector<std::string> requeued() const;
    std::size_t size() const { return accepts.size() + ends.size() + beats.size() + others.size() + claims.size(); }
    /// Claims and heartbeats alone do not wait for the disk: if a crash of the server undoes them, the jobs are queued
    /// again, as they should be. The first process that ends such a job ends it.
    bool durable() const { return !(accepts.empty() && ends.empty() && others.empty()); }
};

class Writer {
public:
    /// Connects automatically. `tag` "": no notices to other processes.
    Writer(Address address, std::string tag, Watch& watch);
    /// Executes the queue, as far as the database is available, then joins.
    ~Writer();
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    void accept(Ask<NewJob, Accepted> ask);
    void finish(Ask<JobEnd, bool> ask);
    void beat(Ask<Heartbeat, std::vector<Holding>> ask);
    void claim(Ask<Claim, std::vector<JobRecord>> ask);
    void change(OtherChange change);

    bool healthy() const { return healthy_; }
    /// Time since a request that the server has not answered.
    std::chrono::milliseconds silence() const { return line_->silence(); }

private:
    using Clock = std::chrono::steady_clock;

    template <class T>
    void add(std::vector<T> Group::*place, T item, bool first = false);
    void work();
    /// Empty when it is time to stop, or to check the connection.
    Group next_group();
    void write(Group& group);
    void write_alone(Group& group);
    /// Empty when the group has been committed.
    std::optional<Failure> try_write(Group& group);
    std::optional<Failure> try_once(Group& group);
    bool connect();
    /// For a transaction whose commit was not answered, in that life of the server; empty if that cannot be determined.
    std::optional<bool> was_committed(std::int64_t transaction, const std::string& life);
    bool stopping() const;

    Address address_;
    std::string tag_;
    const std::shared_ptr<Line> line_;
    std::unique_ptr<Session> session_;
    std::string life_;  ///< server_life() at the time of the session
    Clock::time_point next_try_{};
    std::chrono::milliseconds pause_{0};

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Group waiting_;
    bool quick_went_ = false;  ///< the last group consisted of claims and heartbeats
    bool stopping_ = false;
    std::atomic<bool> healthy_ = true;
    std::jthread thread_;
};

}  // namespace tunewright::server::postgres
