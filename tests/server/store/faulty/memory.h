// Memory that runs out when a test says so: operator new of this program, and SQLite's own allocations.
#pragma once

#include <cstdint>

namespace tunewright::server {

/// While it lives, one allocation of the program, on whichever thread, finds no memory; those after it do. One at a
/// time. Of SQLite's allocations it knows those after `take_sqlite_memory()`.
class FailingAllocation {
public:
    explicit FailingAllocation(std::int64_t number);  ///< from 0
    ~FailingAllocation();
    FailingAllocation(const FailingAllocation&) = delete;
    FailingAllocation& operator=(const FailingAllocation&) = delete;

    /// Allocations so far.
    std::int64_t calls() const;
};

/// While it lives, this thread's allocations are not among them: a test's own.
class OwnAllocations {
public:
    OwnAllocations();
    ~OwnAllocations();
    OwnAllocations(const OwnAllocations&) = delete;
    OwnAllocations& operator=(const OwnAllocations&) = delete;

    /// Runs it as if this were not there.
    template <class Work>
    static void except(Work work) {
        struct Pause {
            Pause() { swap(); }
            ~Pause() { swap(); }
        } pause;
        work();
    }

private:
    static void swap();
};

/// Before SQLite's first call.
void take_sqlite_memory();

/// False where a sanitizer has operator new for itself.
bool can_fail_allocations();

}  // namespace tunewright::server
