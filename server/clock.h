// Clocks of the service. Times that must agree between machines come from the store's clock instead
// (JobStore::clock_ahead).
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace tunewright::server {

using UnixMs = std::int64_t;  ///< milliseconds since 1970, UTC

/// The clock of this machine, which an operator may set.
inline UnixMs wall_clock() {
    using std::chrono::system_clock;
    return std::chrono::duration_cast<std::chrono::milliseconds>(system_clock::now().time_since_epoch()).count();
}

/// Milliseconds of a clock that cannot be set, from an arbitrary start: for durations.
inline double monotonic_ms() {
    using std::chrono::steady_clock;
    return std::chrono::duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

/// Deviation of the wall clock from the monotonic clock: the machine slept, or its clock was set.
class WallDrift {
public:
    /// The deviation since the last call; empty at the first.
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
