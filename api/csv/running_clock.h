// Time stamps as a time that runs on: past midnight, past the full hour, over the changes of summer time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/csv/time_stamp.h"

namespace tunewright::api {

/// Takes stamps in the order of the file. A stamp without a date that falls back by more than half a day is of the next
/// day; one of minutes and seconds that falls back by more than half an hour is of the next hour. Stamps with a date
/// and without a zone are those of a wall clock: an hour that it repeats or leaves out, to the usual spacing and (left
/// out) on a Sunday early in the day of a month in which countries change, is none.
class RunningClock {
public:
    double seconds(const TimeStamp& stamp, int line);
    std::vector<std::string> take_notes() { return std::move(notes_); }

private:
    bool leaves_out_an_hour(const TimeStamp& stamp, double ahead) const;

    double moved_ = 0;  // added to the stamps
    double step_ = 0;   // from the last but one to the last
    std::optional<double> last_;
    std::vector<std::string> notes_;
};

}  // namespace tunewright::api
