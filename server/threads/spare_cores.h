// Cores that no computation uses help one that can be spread.
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "engine/progress.h"
#include "server/threads/executor.h"

namespace tunewright::server {

class SpareCores {
public:
    /// For up to `cores` computations at once, helpers among them.
    explicit SpareCores(std::size_t cores);

    /// A computation that is on its way: it has a core as long as this lives.
    class Computation {
    public:
        explicit Computation(SpareCores& cores) : cores_(cores) { ++cores_.busy_; }
        ~Computation() { --cores_.busy_; }
        Computation(const Computation&) = delete;
        Computation& operator=(const Computation&) = delete;

        /// For its RunControl; it must outlive its use. What f throws is thrown on, once the others have returned.
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
