// Time as the service counts it. What must agree between machines is counted by the store's clock instead
// (JobStore::clock_ahead).
#pragma once

#include <chrono>
#include <cstdint>

namespace tunewright::server {

using UnixMs = std::int64_t;  ///< milliseconds since 1970, UTC

/// This machine's clock, which an operator may set.
inline UnixMs wall_clock() {
    using std::chrono::system_clock;
    return std::chrono::duration_cast<std::chrono::milliseconds>(system_clock::now().time_since_epoch()).count();
}

/// Milliseconds from some moment in the past, which nobody sets: for durations.
inline double monotonic_ms() {
    using std::chrono::steady_clock;
    return std::chrono::duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace tunewright::server
