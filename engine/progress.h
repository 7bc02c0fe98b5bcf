// How a long computation reports progress, is stopped, and is spread over threads. The engine starts no thread and
// reads no clock: the caller supplies both.
#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

namespace tunewright {

struct BestSoFar;  // evaluation/best_so_far.h

struct Progress {
    double fraction = 0;                         ///< 0 to 1, never decreases within a job
    std::string stage;                           ///< one word for programs: "identify", "tune", "evaluate"
    std::string message;                         ///< one sentence for people
    std::shared_ptr<const BestSoFar> best = {};  ///< the best feasible design so far; null: none yet
};

/// Calls f(0) ... f(n - 1), each once, in any order and perhaps several at once, and returns when all have returned.
using ParallelFor = std::function<void(int n, const std::function<void(int)>& f)>;

struct RunControl {
    std::stop_token stop;                           ///< checked between steps of every search
    std::function<void(const Progress&)> progress;  ///< may be empty; called by one thread at a time
    std::function<double()> now_ms;                 ///< a monotonic clock for `compute_ms`; may be empty (then 0)
    ParallelFor spread = {};                        ///< may be empty: calls run one after another
};

/// Calls f(0) ... f(n - 1) by `spread`. No call may read what another one writes: then the result does not depend on
/// their order.
inline void parallel_for(const ParallelFor& spread, int n, const std::function<void(int)>& f) {
    if (spread && n > 1) return spread(n, f);
    for (int i = 0; i < n; ++i) f(i);
}

}  // namespace tunewright
