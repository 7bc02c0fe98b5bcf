// Memory that is exhausted on demand: operator new of this program, and SQLite's own allocations.
#pragma once

#include <cstdint>

namespace tunewright::server {

/// During its lifetime, one allocation of the program, on any thread, fails; later ones succeed. One at a time.
/// SQLite's allocations are included after `take_sqlite_memory()`.
class FailingAllocation {
public:
    explicit FailingAllocation(std::int64_t number);  ///< from 0
    ~FailingAllocation();
    FailingAllocation(const FailingAllocation&) = delete;
    FailingAllocation& operator=(const FailingAllocation&) = delete;

    /// Allocations so far.
    std::int64_t calls() const;
};

/// During its lifetime, this thread's allocations are excluded: those of the test itself.
class OwnAllocations {
public:
    OwnAllocations();
    ~OwnAllocations();
    OwnAllocations(const OwnAllocations&) = delete;
    OwnAllocations& operator=(const OwnAllocations&) = delete;

    /// Runs the work with these allocations included again.
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

/// To be called before SQLite's first call.
void take_sqlite_memory();

/// False if a sanitizer replaces operator new.
bool can_fail_allocations();

}  // namespace tunewright::server
