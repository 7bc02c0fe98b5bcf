#include "api/historian/layouts/tag_clock.h"

#include <cmath>

namespace tunewright::api {
namespace {

constexpr double kMaxTime = 1e30;  // as every number of the contract

}  // namespace

bool TagClock::read_time(std::string_view cell, std::string_view clock, int line, LastStamp& last, double& t) {
    if (!times_.stamps()) return times_.read(cell, clock, line, t);
    if (cell != last.cell || clock != last.clock)
        last = {std::string(cell), std::string(clock), times_.stamp(cell, clock)};
    if (last.stamp) t = times_.time_of(*last.stamp, line);
    return last.stamp.has_value();
}

bool TagClock::read(std::string_view cell, std::string_view clock, int line, FileTimes& file, double& t) {
    if (!read_time(cell, clock, line, file.last, t) || !(std::abs(t) <= kMaxTime)) return false;
    FileStart& start = file.start;
    if (!start.zero) start = {times_.zero(), times_.epoch(), times_.in_utc()};
    t += times_.zero() - *start.zero;
    // Seconds since 1970 have 2.4e-7 s of resolution: without this line 10 s is printed as 10.000000238.
    constexpr double kStepsPerSecond = 1e6;
    if (times_.stamps() && seconds_ > 0) t = std::round(t * seconds_ * kStepsPerSecond) / kStepsPerSecond / seconds_;
    return true;
}

std::variant<TagClock, std::string> open_clock(const TableHead& head, std::size_t column,
                                               std::optional<std::size_t> clock, const LoopsOptions& options) {
    DetectedColumns columns;
    columns.at[kTimeRole] = column;
    columns.clock = clock;
    std::vector<CsvFault> faults;
    const CsvOptions csv = csv_options(options);
    TimeColumn times(head.text, head.layout, columns, head.columns[column], csv, faults);
    if (!faults.empty()) return faults.front().message;
    return TagClock(std::move(times), seconds_per(options.time_unit).value_or(0));
}

}  // namespace tunewright::api
