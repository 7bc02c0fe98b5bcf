// Times of day and dates as logs write them, in seconds.
#pragma once

#include <optional>
#include <string_view>

namespace tunewright::api {

struct TimeStamp {
    double seconds = 0;  ///< since 1970-01-01T00:00:00Z; without a date, since midnight
    bool has_date = false;
};

/// ISO 8601 "2024-03-01T12:00:00.5Z", "2024-03-01 12:00:00,5 +02:00", "2024-03-01"; or a time of day "12:00:00.5",
/// "12:00".
std::optional<TimeStamp> read_time_stamp(std::string_view text);

/// Seconds of a unit of time as people write it ("s", "sec", "min", "h", "ms", "day", ...); empty for an unknown one.
std::optional<double> seconds_per(std::string_view unit);

}  // namespace tunewright::api
