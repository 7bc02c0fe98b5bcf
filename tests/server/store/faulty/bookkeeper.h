// A caller of a store that fails: it records the reported results, and checks the store against them.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "server/store/store.h"
#include "tests/long_or_quick.h"
#include "tests/server/store/faulty/memory.h"

namespace tunewright::server {

/// A tenth of the points of a test, spread over them; all of them in a long run.
inline int fault_points(int all) { return long_or_quick(all, all / 10); }

class Bookkeeper {
public:
    explicit Bookkeeper(JobStore& store) : store_(store) {}

    /// An ordinary job: accepted, claimed, ended; every third is deleted.
    void live(int number) {
        const OwnAllocations these;
        const std::string id = "job" + std::to_string(number);
        NewJob job;
        job.id = id;
        job.request.assign(3000 + 500 * static_cast<std::size_t>(number % 7), 'x');
        if (!reported<Accepted>([&](auto done) { store_.accept(job, done); })) {
            if (!in_doubt_) refused_.insert(id);
            return;
        }
        there_[id] = JobStatus::queued;
        const auto claimed = reported<std::vector<JobRecord>>([&](auto done) {
            store_.claim({"worker", 1, std::chrono::minutes(1), 1}, done);
        });
        for (const JobRecord& one : claimed.value_or(std::vector<JobRecord>())) end(one, number % 3 == 0);
    }

    /// The reported jobs, in the reported state or a later one.
    const std::map<std::string, JobStatus>& there() const { return there_; }
    /// The jobs that were refused, not only left in doubt.
    const std::set<std::string>& refused() const { return refused_; }

private:
    void end(const JobRecord& job, bool then_delete) {
        const JobEnd end{job.seq, job.id, job.attempts, JobStatus::succeeded, std::string(4000, 'r'), "", "1", 2};
        if (!reported<bool>([&](auto done) { store_.finish(end, done); }).value_or(false)) return;
        there_[job.id] = JobStatus::succeeded;
        if (!then_delete) return;
        there_.erase(job.id);  // from now on both states are right
        reported<RemoveEffect>([&](auto done) { store_.remove(job.id, done); });
    }

    /// Empty if the store failed, or does not know whether it has succeeded.
    template <class T, class Start>
    std::optional<T> reported(Start start) {
        in_doubt_ = false;
        auto promise = std::make_shared<std::promise<Outcome<T>>>();
        auto future = promise->get_future();
        const auto keep = [promise](Outcome<T> outcome) {
            const OwnAllocations this_one;
            promise->set_value(std::move(outcome));
        };
        try {
            OwnAllocations::except([&] { start(keep); });
        } catch (const std::bad_alloc&) {
            return std::nullopt;
        }
        Outcome<T> outcome = future.get();
        if (auto* value = std::get_if<T>(&outcome)) return std::move(*value);
        in_doubt_ = std::get<StoreFault>(outcome).kind == StoreFault::Kind::unknown;
        return std::nullopt;
    }

    JobStore& store_;
    std::map<std::string, JobStatus> there_;
    std::set<std::string> refused_;
    bool in_doubt_ = false;
};

/// Checks that every reported job exists, in the reported state or a later one.
inline void expect_kept(JobStore& store, const std::map<std::string, JobStatus>& there, const std::string& where) {
    for (const auto& [id, status] : there) {
        const auto found = store.find(id);
        ASSERT_TRUE(found) << id << " is lost " << where;
        if (status == JobStatus::succeeded) {
            EXPECT_EQ(found->result.size(), 4000U) << id << " " << where;
        }
    }
}

}  // namespace tunewright::server
