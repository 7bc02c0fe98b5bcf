// store_cycles STORE [JOBS]: what a store can do, as jobs a second.
//   accept    64 requests in flight, each answered when it is durable
//   work      two workers that claim eight jobs, end each durably with a result of 10 kB, and go on
//   together  both at the same time, until every job has ended
//   entries   a batch of that many entries in groups of 300
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/store/open_store.h"

namespace {

using namespace tunewright::server;
using Clock = std::chrono::steady_clock;

constexpr int kInFlight = 64;
constexpr int kWorkers = 2;

UnixMs now() {
    using std::chrono::system_clock;
    return std::chrono::duration_cast<std::chrono::milliseconds>(system_clock::now().time_since_epoch()).count();
}

template <class T>
T value(Outcome<T> outcome) {
    if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
        std::fprintf(stderr, "the store failed: %s\n", fault->detail.c_str());
        std::exit(1);
    }
    return std::get<T>(std::move(outcome));
}

/// Lets so many through at a time.
class Gate {
public:
    explicit Gate(int places) : free_(places) {}
    void enter() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return free_ > 0; });
        free_--;
    }
    void leave() {
        const std::lock_guard lock(mutex_);
        free_++;
        changed_.notify_all();
    }
    void wait_for_all(int places) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return free_ == places; });
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int free_;
};

class Bench {
public:
    Bench(JobStore& store, int jobs) : store_(store), jobs_(jobs) {}

    void accept() {
        Gate gate(kInFlight);
        for (int i = 0; i < jobs_; i++) {
            gate.enter();
            NewJob job;
            job.id = "job" + std::to_string(next_id_++) + "-" + std::to_string(now());
            job.request.assign(400, 'x');
            job.request_hash.assign(64, 'h');
            job.flow = "client " + std::to_string(i % 8);
            job.created_at = now();
            store_.accept(std::move(job), [&gate](Outcome<Accepted> outcome) {
                value(std::move(outcome));
                gate.leave();
            });
        }
        gate.wait_for_all(kInFlight);
    }

    void work() {
        std::atomic<int> left = jobs_;
        std::vector<std::jthread> workers;
        for (int i = 0; i < kWorkers; i++)
            workers.emplace_back([&] {
                Gate one(1);
                Gate ends(32);
                while (left > 0) {
                    std::vector<JobRecord> claimed;
                    one.enter();
                    store_.claim({"bench", now(), std::chrono::seconds(60), 8},
                                 [&](Outcome<std::vector<JobRecord>> outcome) {
                                     claimed = value(std::move(outcome));
                                     one.leave();
                                 });
                    one.wait_for_all(1);
                    if (claimed.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                    for (const JobRecord& job : claimed) {
                        ends.enter();
                        JobEnd end{job.seq, job.id, job.attempts, JobStatus::succeeded, std::string(10'000, 'r'),
                                   "",      "1",    now()};
                        store_.finish(std::move(end), [&](Outcome<bool> outcome) {
                            value(std::move(outcome));
                            left--;
                            ends.leave();
                        });
                    }
                }
                ends.wait_for_all(32);
            });
    }

    void entries() {
        const std::string id = "batch" + std::to_string(now());
        Gate gate(2);
        const auto done = [&gate](Outcome<bool> outcome) {
            value(std::move(outcome));
            gate.leave();
        };
        gate.enter();
        store_.open_batch({id, "", "", "", now()}, done);
        for (int first = 0; first < jobs_; first += 300) {
            std::vector<NewEntry> group;
            for (int i = first; i < std::min(first + 300, jobs_); i++)
                group.push_back({i, id + "-" + std::to_string(i), "", 60, std::string(400, 'x'), "hash", ""});
            gate.enter();
            store_.add_entries(id, std::move(group), now(), done);
        }
        gate.wait_for_all(2);
    }

    template <class Work>
    void measure(const char* name, Work part) {
        const auto begin = Clock::now();
        part();
        const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        std::printf("%-9s %8.0f jobs/s\n", name, jobs_ / seconds);
        std::fflush(stdout);
    }

private:
    JobStore& store_;
    int jobs_;
    std::atomic<int> next_id_ = 0;
};

}  // namespace

int main(int count, char** words) {
    if (count < 2) {
        std::fprintf(stderr, "store_cycles STORE [JOBS]\n");
        return 2;
    }
    try {
        const std::unique_ptr<JobStore> store = open_store(words[1]);
        store->recover(now(), 10, "{}");
        Bench bench(*store, count > 2 ? std::atoi(words[2]) : 5000);
        bench.measure("accept", [&] { bench.accept(); });
        bench.measure("work", [&] { bench.work(); });
        bench.measure("together", [&] {
            const std::jthread clients([&] { bench.accept(); });
            bench.work();
        });
        bench.measure("entries", [&] { bench.entries(); });
        bench.measure("work", [&] { bench.work(); });
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
