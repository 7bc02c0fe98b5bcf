#include "tests/server/store/faulty/memory.h"

#include <sqlite3.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <utility>

namespace tunewright::server {
namespace {

std::atomic<std::int64_t> calls_so_far = 0, failing = -1;
std::atomic<bool> counting = false;

thread_local int own = 0, paused = 0;

bool fails() { return own == 0 && counting && calls_so_far.fetch_add(1) == failing; }

sqlite3_mem_methods real;

void* allocate(int size) { return fails() ? nullptr : real.xMalloc(size); }
void* reallocate(void* old, int size) { return fails() ? nullptr : real.xRealloc(old, size); }

}  // namespace

FailingAllocation::FailingAllocation(std::int64_t number) {
    calls_so_far = 0;
    failing = number;
    counting = true;
}

FailingAllocation::~FailingAllocation() { counting = false; }

std::int64_t FailingAllocation::calls() const { return calls_so_far; }

OwnAllocations::OwnAllocations() { ++own; }

OwnAllocations::~OwnAllocations() { --own; }

void OwnAllocations::swap() { std::swap(own, paused); }

void take_sqlite_memory() {
    sqlite3_shutdown();
    sqlite3_config(SQLITE_CONFIG_GETMALLOC, &real);
    sqlite3_mem_methods own = real;
    own.xMalloc = allocate;
    own.xRealloc = reallocate;
    sqlite3_config(SQLITE_CONFIG_MALLOC, &own);
    sqlite3_initialize();
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
bool can_fail_allocations() { return false; }
#else
bool can_fail_allocations() { return true; }

void* allocate_or_fail(std::size_t size) {
    if (!fails())
        if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
    throw std::bad_alloc();
}
#endif

}  // namespace tunewright::server

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
void* operator new(std::size_t size) { return tunewright::server::allocate_or_fail(size); }
void* operator new[](std::size_t size) { return tunewright::server::allocate_or_fail(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
#endif
