// Times of day and dates in the formats of logs, in seconds.
#pragma once

#include <optional>
#include <string_view>

namespace tunewright::api {

constexpr double kDay = 86400, kHour = 3600;  ///< s

/// For dates in numbers that do not begin with the year.
enum class DateOrder { day_first, month_first };

struct TimeStamp {
    double seconds = 0;  ///< since 1970-01-01T00:00:00Z; without a date, since midnight
    bool has_date = false;
    bool has_clock = false;
    bool has_zone = false;
    bool order_matters = false;  ///< 03/04/2026: another order would be another date
    bool minutes = false;        ///< 07:20.5: minutes and seconds, without the hour
};

/// ISO 8601 "2024-03-01T12:00:00.5Z", "2024-03-01 12:00:00,5 +02:00", "2024-03-01", "20240301T120000Z",
/// "20240301120000"; "1.3.2024 12:00:00", "3/1/2024 2:05:06.5 PM", "01-Mar-24 12:00:00", "Mar 1, 2024 2:05 PM" (months
/// also in German, French, Spanish, Italian, Dutch); or a time of day "12:00:00.5", "12:00", "2:05 PM"; or minutes and
/// seconds "07:20.5". The first number of "75:20" is read as hours, as in "12:00"; up to 99. With points the day comes
/// first; with slashes and dashes `order` decides, unless only one order gives a valid date. Two-digit years are 2000
/// to 2079 and 1980 to 1999.
std::optional<TimeStamp> read_time_stamp(std::string_view text, DateOrder order = DateOrder::day_first);

/// True if fourteen digits alone are a date of 1970 to 2099 and a time of day, 20240301120000.
bool is_compact_stamp(std::string_view text);

/// Seconds of a unit of time in its usual spellings ("s", "sec", "min", "h", "ms", "day", ..., "100 ms" of a counter of
/// scans); empty for an unknown one.
std::optional<double> seconds_per(std::string_view unit);

}  // namespace tunewright::api
