#include "server/threads/spare_cores.h"

#include <algorithm>
#include <exception>
#include <mutex>

namespace tunewright::server {

/// The shared computation. Helpers may access it after the call has returned, but not `f`.
struct SpareCores::SharedCall {
    const std::function<void(int)>& f;
    const int n;
    std::atomic<int> next = 0, done = 0;
    std::mutex mutex;
    std::exception_ptr fault;

    /// False if no part is left.
    bool take_one() {
        const int i = next++;
        if (i >= n) return false;
        try {
            f(i);
        } catch (...) {
            const std::lock_guard locked(mutex);
            if (!fault) fault = std::current_exception();
        }
        if (++done == n) done.notify_all();
        return true;
    }
};

// The helpers do not have a lower priority than the computation that waits for them.
SpareCores::SpareCores(std::size_t cores)
    : cores_(static_cast<int>(std::max<std::size_t>(1, cores))), helpers_(static_cast<std::size_t>(cores_) - 1) {}

ParallelFor SpareCores::Computation::spread() {
    return [&cores = cores_](int n, const std::function<void(int)>& f) { cores.spread(n, f); };
}

/// A helper leaves the cores that other computations need.
void SpareCores::help(SharedCall& share) {
    while (busy_ <= cores_ && share.take_one()) {
    }
    --busy_;
}

void SpareCores::spread(int n, const std::function<void(int)>& f) {
    const auto share = std::make_shared<SharedCall>(f, n);
    for (int helpers = std::min(cores_ - busy_, n - 1); helpers > 0; --helpers) {
        ++busy_;
        if (!helpers_.post([this, share] { help(*share); })) --busy_;
    }
    while (share->take_one()) {
    }
    for (int done = share->done; done < n; done = share->done) share->done.wait(done);
    if (share->fault) std::rethrow_exception(share->fault);
}

}  // namespace tunewright::server
