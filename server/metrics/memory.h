// The memory limit of the process, and its memory use.
#pragma once

#include <atomic>
#include <cstddef>

namespace tunewright::server {

/// The limit in bytes: `asked`, or if that is 0 the limit of its control group, or 512 MiB if there is none.
std::size_t memory_limit(std::size_t asked);

/// Answers of some 100 KiB come and go on many threads. Returned to the system each time, they cost a fifth of all jobs
/// a second in page faults; blocks larger than a MiB are returned. Memory that a thread frees stays in its arena: the
/// number of arenas is small, otherwise the peaks of many requests would add up.
void keep_small_memory();

class Memory {
public:
    explicit Memory(std::size_t limit) : limit_(limit) { look(); }

    /// Measures the memory in use (the resident set); above half of the limit, free memory is returned to the system.
    /// To be called about once a second.
    void look();
    std::size_t limit() const { return limit_; }
    std::size_t taken() const { return taken_; }
    /// True if more than eight tenths are in use: nothing large should begin.
    bool tight() const { return taken_ > limit_ / 10 * 8; }

private:
    const std::size_t limit_;
    std::atomic<std::size_t> taken_ = 0;
};

}  // namespace tunewright::server
