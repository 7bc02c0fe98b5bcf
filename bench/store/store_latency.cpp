// store_latency STORE claim TIMES JOBS: hands out that many jobs that many times, one claim after the other, and ends
// them; what a claim took, from the question to the answer.
// store_latency STORE sweep JOBS: sweeps all ended jobs away; how many a second.
// Prints one JSON object.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <string>
#include <vector>

#include "server/store/open_store.h"

namespace {

using namespace tunewright::server;
using Clock = std::chrono::steady_clock;

template <class T, class Start>
T completed(Start start) {
    std::promise<Outcome<T>> promise;
    start([&](Outcome<T> outcome) { promise.set_value(std::move(outcome)); });
    Outcome<T> outcome = promise.get_future().get();
    if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
        std::fprintf(stderr, "the store failed: %s\n", fault->detail.c_str());
        std::exit(1);
    }
    return std::get<T>(std::move(outcome));
}

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

int claim(JobStore& store, int times, std::size_t jobs) {
    std::vector<double> took;
    std::size_t handed_out = 0;
    for (int i = 0; i < times; i++) {
        const auto start = Clock::now();
        const Claim wanted{"store_latency", wall_clock(), std::chrono::minutes(10), jobs};
        const auto claimed = completed<std::vector<JobRecord>>([&](auto done) { store.claim(wanted, done); });
        took.push_back(ms_since(start));
        handed_out += claimed.size();
        for (const JobRecord& job : claimed)
            completed<bool>([&](auto done) {
                store.finish({job.seq, job.id, job.attempts, JobStatus::succeeded, "{}", "", "1", wall_clock()}, done);
            });
    }
    std::sort(took.begin(), took.end());
    const auto at = [&](double share) {
        return took[static_cast<std::size_t>(share * static_cast<double>(took.size() - 1))];
    };
    std::printf("{\"jobs\": %zu, \"p50_ms\": %.3f, \"p99_ms\": %.3f, \"longest_ms\": %.3f}\n", handed_out, at(0.5),
                at(0.99), took.back());
    return 0;
}

int sweep(JobStore& store, std::size_t jobs) {
    constexpr std::size_t kAtOnce = 5000;
    const std::chrono::milliseconds none{0};
    const auto start = Clock::now();
    std::size_t gone = 0;
    for (std::size_t slice = 1; slice > 0 && gone < jobs; gone += slice)
        slice = completed<std::size_t>([&](auto done) {
            store.sweep(wall_clock(), {none, none, none}, kAtOnce, done);
        });
    std::printf("{\"rows\": %zu, \"per_second\": %.0f}\n", gone, 1e3 * static_cast<double>(gone) / ms_since(start));
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    try {
        if (words.size() == 4 && words[1] == "claim")
            return claim(*open_store(words[0]), std::stoi(words[2]), std::stoul(words[3]));
        if (words.size() == 3 && words[1] == "sweep") return sweep(*open_store(words[0]), std::stoul(words[2]));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    std::fprintf(stderr, "store_latency STORE claim TIMES JOBS, or store_latency STORE sweep JOBS\n");
    return 2;
}
