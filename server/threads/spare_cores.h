// Lets a parallel computation use cores that no other computation needs.
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "engine/progress.h"
#include "server/threads/executor.h"

namespace tunewright::server {

class SpareCores {
public:
    /// Allows `cores` computations at once, including helpers.
    explicit SpareCores(std::size_t cores);

    /// A computation in progress: it has a core during its lifetime.
    class Computation {
    public:
        explicit Computation(SpareCores& cores) : cores_(cores) { ++cores_.busy_; }
        ~Computation() { --cores_.busy_; }
        Computation(const Computation&) = delete;
        Computation& operator=(const Computation&) = delete;

        /// For its RunControl; this object must outlive its use. Exceptions of f are rethrown once the other threads
        /// have returned.
        ParallelFor spread();

    private:
        SpareCores& cores_;
    };

private:
    struct SharedCall;

    void spread(int n, const std::function<void(int)>& f);
    void help(SharedCall& share);

    const int cores_;
    std::atomic<int> busy_ = 0;
    Executor helpers_;
};

}  // namespace tunewright::server
