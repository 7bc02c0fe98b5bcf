// Time as the service counts it. What must agree between machines is counted by the store's clock instead
// (JobStore::clock_ahead).
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

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

/// How far the wall clock has run away from one that nobody sets: the machine slept, or its clock was set.
class WallDrift {
public:
    /// Since the last call; nothing at the first.
    std::optional<std::chrono::milliseconds> since_last(UnixMs wall) {
        const auto steady = std::chrono::steady_clock::now();
        const std::chrono::milliseconds by_wall(wall - std::exchange(wall_, wall));
        const auto by_steady = steady - std::exchange(steady_, steady);
        if (!std::exchange(begun_, true)) return std::nullopt;
        return by_wall - std::chrono::duration_cast<std::chrono::milliseconds>(by_steady);
    }

private:
    bool begun_ = false;
    UnixMs wall_ = 0;
    std::chrono::steady_clock::time_point steady_{};
};

}  // namespace tunewright::server
