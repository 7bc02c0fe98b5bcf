// Time stamps as a continuous time: across midnight, across the full hour, and across changes of summer time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/csv/time_stamp.h"

namespace tunewright::api {

/// Takes stamps in the order of the file. A stamp without a date that falls back by more than half a day is of the next
/// day; one of minutes and seconds that falls back by more than half an hour is of the next hour. Stamps with a date
/// and without a zone come from a wall clock: an hour that it repeats or skips is removed, if it is an hour to within
/// the usual spacing and, if skipped, falls early on a Sunday of a month in which countries change their clocks.
class RunningClock {
public:
    double seconds(const TimeStamp& stamp, int line);
    std::vector<std::string> take_notes() { return std::move(notes_); }

private:
    bool leaves_out_an_hour(const TimeStamp& stamp, double ahead) const;

    double moved_ = 0;  // added to the stamps
    double step_ = 0;   // between the last two stamps
    std::optional<double> last_;
    std::vector<std::string> notes_;
};

}  // namespace tunewright::api
