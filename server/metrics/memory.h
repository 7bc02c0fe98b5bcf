// The memory that the process may take, and the memory that it has.
#pragma once

#include <atomic>
#include <cstddef>

namespace tunewright::server {

/// Bytes that the process may take: `asked`, or where that is 0 the limit of its control group, or 512 MiB where there
/// is none.
std::size_t memory_limit(std::size_t asked);

/// Answers of some 100 KiB come and go on many threads. Returned to the system each time, they cost a fifth of all jobs
/// a second in page faults; what is larger than a MiB is returned. What a thread frees stays in its arena: there are
/// few, or the peaks of many requests would add up.
void keep_small_memory();

class Memory {
public:
    explicit Memory(std::size_t limit) : limit_(limit) { look(); }

    /// Measures what the process has (its resident set); of more than half of the limit, what is free goes back to the
    /// system. To be called once a second or so.
    void look();
    std::size_t limit() const { return limit_; }
    std::size_t taken() const { return taken_; }
    /// Nothing large should begin: more than eight tenths are taken.
    bool tight() const { return taken_ > limit_ / 10 * 8; }

private:
    const std::size_t limit_;
    std::atomic<std::size_t> taken_ = 0;
};

}  // namespace tunewright::server
