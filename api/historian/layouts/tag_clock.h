// The times of a tag, counted from the first time of its file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/csv/time_column.h"
#include "api/historian/layouts/loop_table.h"
#include "api/historian/layouts/table_head.h"

namespace tunewright::api {

/// The first time that was read in a file, from which the times of all its tags count.
struct FileStart {
    std::optional<double> zero;   ///< the file's own time, in the unit of the answer; empty: no time was read yet
    std::optional<double> epoch;  ///< seconds since 1970; empty: the times have no date
    bool utc = false;             ///< they are in UTC
};

/// The last time stamp of a file: tags in neighbouring lines have equal ones.
struct LastStamp {
    std::string cell, clock;
    std::optional<TimeStamp> stamp;
};

/// What the clocks of a file share.
struct FileTimes {
    FileStart start;
    LastStamp last;
};

/// Reads the times of one tag in the order of its values. Each tag has its own, because a file may hold the tags one
/// after the other: the times then begin again, which is neither midnight nor the end of summer time.
class TagClock {
public:
    /// `seconds_per_unit`: of the unit of the answer; 0 if it is not known.
    TagClock(TimeColumn times, double seconds_per_unit) : times_(std::move(times)), seconds_(seconds_per_unit) {}

    /// False if the cell is not a time. `clock` is the cell of the time of day, if it is apart from the date.
    bool read(std::string_view cell, std::string_view clock, int line, FileTimes& file, double& t);

    std::vector<std::string> take_notes() { return times_.take_notes(); }

private:
    bool read_time(std::string_view cell, std::string_view clock, int line, LastStamp& last, double& t);

    TimeColumn times_;
    double seconds_;
};

/// The clock for times in this column, `clock` with the time of day; or the reason why there is none.
std::variant<TagClock, std::string> open_clock(const TableHead& head, std::size_t column,
                                               std::optional<std::size_t> clock, const LoopsOptions& options);

}  // namespace tunewright::api
